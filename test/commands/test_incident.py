"""`incident`: what the picture was at a moment, and which manoeuvre would have cleared it."""

import re

import numpy as np
import pytest

from marine_tracker import cli
from marine_tracker.evaluation import incident
from marine_tracker.geometry import NAUTICAL_MILE, own_ship_at
from marine_tracker.parameters import ArpaParameters, TrackerParameters, from_mapping
from marine_tracker.service import Service
from marine_tracker.simulation import radar, scenario

CROSSING = """
duration_s: 1250
own_ship: {course_deg: 20, speed_kn: 13}
radar: {max_range_nm: 12, range_sigma_m: 15, bearing_sigma_deg: 0.4}
targets:
- name: ferry
  start: {range_nm: 5.6, bearing_deg: 65}
  course_deg: 290
  speed_kn: 12.5
"""


@pytest.fixture(scope='module')
def recorded(tmp_path_factory):
    """A ferry crosses close ahead; as a folder, and its scenario."""
    work = tmp_path_factory.mktemp('incident')
    file = work / 'crossing.yaml'
    file.write_text(CROSSING)
    assert cli.main(['scenario', 'write', str(file), str(work / 'crossing')]) == 0
    return work / 'crossing', scenario.load(file)


def test_alarms_and_remedies_are_told_for_a_moment(recorded, tmp_path, capsys):
    folder, _ = recorded
    picture = tmp_path / 'incident.png'
    words = ['incident', str(folder), '--at', '960', '--picture', str(picture)]
    assert cli.main(words) == 0
    said = capsys.readouterr().out
    assert re.search(r'TT01 +\d\.\d\d +\d{3} +2[89]\d +12\.\d', said)
    assert said.count('TT01 dangerous') == 1 and said.index('alarms before it') > 0
    assert re.search(r'10\.0 min before: \d+ deg to starboard', said)
    assert picture.read_bytes().startswith(b'\x89PNG')


def test_a_remedy_is_one_against_the_truth(recorded):
    """Own ship sails the way that is told; the ferry goes where the scenario has it."""
    _, chosen = recorded
    parameters = from_mapping(TrackerParameters, chosen.tracker_parameters())
    service = Service(parameters, ArpaParameters())
    scans = [scan for scan, _ in radar.simulate(chosen, 5)]
    found = incident.find(service, scans, 960.0, 900.0, 290.0)
    early = [one for one in found.remedies if one.before > 400]
    assert {one.kind for one in early} >= {incident.STARBOARD}
    for one in early:
        times = [p.time for p in found.pictures if p.time >= found.time - one.before - 1e-6]
        ferry = np.array([chosen.truth_at(time).position[0] for time in times])
        away = np.hypot(*(ferry - one.way[: len(ferry)]).T).min()
        assert away > 0.47 * NAUTICAL_MILE  # the limit is half a mile
        assert one.really == pytest.approx(away, abs=60.0)
    own = np.array([own_ship_at(s.own_ship, s.end)[0] for s in scans])
    ferry = np.array([chosen.truth_at(s.end).position[0] for s in scans])
    assert np.hypot(*(own - ferry).T).min() < 0.4 * NAUTICAL_MILE


@pytest.mark.parametrize(
    ('at', 'said'),
    [('5000', 'the recording goes from 0.0 s to'), ('noon', 'it must be seconds, or UTC')],
)
def test_a_moment_that_is_none_is_refused_in_one_line(recorded, capsys, at, said):
    assert cli.main(['incident', str(recorded[0]), '--at', at]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
