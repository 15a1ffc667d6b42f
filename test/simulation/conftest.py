import json

import pytest

from marine_tracker.simulation import scenario


@pytest.fixture
def make_scenario(tmp_path):
    """Write the keys given as a scenario file and load it; without targets, one at 5 NM."""

    def make(**values):
        values.setdefault('duration_s', 600)
        if 'ais' not in values:
            values.setdefault(
                'targets',
                [{'start': {'range_nm': 5, 'bearing_deg': 40}, 'course_deg': 200, 'speed_kn': 12}],
            )
        file = tmp_path / 'made.yaml'
        file.write_text(json.dumps(values))
        return scenario.load(file)

    return make
