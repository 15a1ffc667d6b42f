"""Simulate a radar, track what it plots, and compare with where the targets really are.

    python examples/01_track_simulated_radar.py [SCENARIO]

No ROS: the simulator and the tracker are called as functions, scan by scan.
"""

import sys

import numpy as np

from marine_tracker import service_for
from marine_tracker.geometry import KNOT, NAUTICAL_MILE, own_ship_at, to_range_bearing
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking.lifecycle import COASTING, CONFIRMED, STATUS_NAMES

chosen = scenario.load(sys.argv[1] if len(sys.argv) > 1 else 'encounters')
print(f'{chosen.name}: {chosen.description}')

# What belongs to the radar (noise, range, rotation) comes from the scenario; the rest are defaults.
service = service_for(chosen.tracker_parameters())
memory = service.start()
for scan, truth in radar.simulate(chosen, seed=1):  # noqa: B007, the last one is used below
    memory, output = service.step(memory, scan)

# After the last scan: every track on display, and how far the nearest target really is from it.
report, estimate = output.report, output.estimate
print('track        range  bearing   course    speed   off by')
for row in np.flatnonzero(np.isin(report.tracks.status, (CONFIRMED, COASTING))):
    own_position, _ = own_ship_at(scan.own_ship, report.time[row])
    range_, bearing = to_range_bearing(estimate.position[row] - own_position)
    speed, course = to_range_bearing(estimate.velocity[row])
    really = truth.position + (report.time[row] - truth.time)[:, None] * truth.velocity
    error = np.linalg.norm(really - estimate.position[row], axis=1).min(initial=np.inf)
    print(
        f'{report.tracks.number[row]:2d} {STATUS_NAMES[report.tracks.status[row]]:9s}'
        f'{range_ / NAUTICAL_MILE:5.2f} NM  {np.degrees(bearing):5.1f}°   '
        f'{np.degrees(course):5.1f}°  {speed / KNOT:4.1f} kn  {error:5.0f} m'
    )
