"""Messages of plots made scans: what is left out of them is counted."""

import numpy as np

from marine_tracker.parameters import TrackerParameters
from marine_tracker.tracking import own_ship
from marine_tracker.tracking.radars import radars_of
from marine_tracker.tracking.scan_input import PART_UNKNOWN, Came, ScanInput
from marine_tracker.types import PolarPlots


def test_messages_that_wait_for_the_rotation_to_be_known_are_counted():
    """Faster than the stated period, and too few plots to tell how the antenna turns."""
    counts = []
    (radar,) = radars_of(TrackerParameters(scan_period_s=3.1))
    heard = ScanInput(radar, 0, lambda *one: counts.append(one))
    log, taken = own_ship.empty_log(), 0
    for k in range(9):
        start = 0.7 * k
        one = np.array([0.0])
        plots = PolarPlots(one, one + 640.0 + 3 * k, one + 0.3, one + 20.0)
        came = Came(start + 5.0, 0, round((start + 100) * 1e9), lambda ns: ns * 1e-9)
        found = heard.scan_of(plots, came, log, [], np.full(2, np.nan), np.nan)
        taken += found is not None
    left_out = [count for reason, count, _ in counts if reason == PART_UNKNOWN]
    assert taken == heard.taken and sum(left_out) == 9 - taken > 0
