"""Fuse two radars of one ship, and compare with what each of them tracks alone.

    python examples/05_two_radars.py

No ROS: scans of both radars go to one tracker, each when its revolution ends. In the last run
the second radar is silent for three minutes; the tracks live on.
"""

import numpy as np

from marine_tracker import service_for
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking.radars import fused, merged

x, s = scenario.load('two_radars_x'), scenario.load('two_radars_s')
scans_x = [scan for scan, _ in radar.simulate(x, seed=1)]
scans_s = [scan for scan, _ in radar.simulate(s, seed=2)]
fails = [scan for scan in scans_s if not 300 < scan.end < 480]
together = fused([x.tracker_parameters(), s.tracker_parameters()], ['radar_x', 'radar_s'])


def track(parameters, scans):
    """RMS distance, m, of the ships from their tracks, and the numbers of these tracks."""
    service = service_for(parameters)
    memory = service.start()
    errors, numbers = [], set()
    for scan in scans:
        memory, _ = service.track(memory, scan)  # without targets and alarms
        if scan.end < 120:  # all have been found by then
            continue
        tracks = memory.tracker.tracks
        held = tracks.number > 0
        now = service.tracker.extrapolate(tracks, scan.end).position[held]
        apart = np.linalg.norm(x.truth_at(scan.end).position[:6, None] - now, axis=-1)
        errors.append(apart.min(1))
        numbers.update(tracks.number[held][apart.argmin(1)].tolist())
    return np.sqrt(np.mean(np.square(errors))), numbers


for name, parameters, scans in (
    ('X band', x.tracker_parameters(), scans_x),
    ('S band', s.tracker_parameters(), scans_s),
    ('both', together, merged(scans_x, scans_s)),
    ('S fails', together, merged(scans_x, fails)),
):
    error, numbers = track(parameters, scans)
    print(f'{name:7s} six ships followed by {len(numbers)} tracks, off by {error:5.1f} m')
