"""Runs a scene through tracker and ARPA, with an operator who acknowledges the alarms.

The truth is computed beside it: when each ship was a danger, from the true motion of all ships.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arpa import alarms
from ...arpa.alarms import DANGER
from ...arpa.alerts import ACTIVE, ACTIVE_UNACKNOWLEDGED
from ...arpa.cpa import cpa_of
from ...parameters import ArpaParameters, TrackerParameters, from_mapping
from ...service import Service
from ...simulation import radar
from ...simulation.scenario import Scenario
from ...types import Array

REACTION = 20.0  # s from an alarm to its acknowledgement
ITS_OWN = 300.0  # m; a target at most this far from a ship is that ship
NOBODY = -1


class Watch(NamedTuple):
    """T ships over K scans, and the A danger alarms that sounded.

    time       [K]     s, ends of the scans
    dangerous  [K, T]  the true CPA and TCPA were below the limits
    cpa        [K, T]  m, true; nan while the ship does not exist
    alarmed    [K, T]  an alarm was active for the ship, acknowledged or not
    sounded    [A]     s, when an alarm became unacknowledged
    ship       [A]     index of the ship; NOBODY: the target is not a ship
    """

    time: Array
    dangerous: NDArray[np.bool_]
    cpa: Array
    alarmed: NDArray[np.bool_]
    sounded: Array
    ship: NDArray[np.int64]


def keep(scenario: Scenario, seed: int, swing: float = 0.0, **parameters: Any) -> Watch:
    """Runs the scenario from beginning to end.

    swing  s, period of own ship's yaw: her true velocity is the mean over one period; 0: the
    velocity at the moment
    parameters  of the ARPA
    """
    settings = from_mapping(TrackerParameters, scenario.tracker_parameters())
    service = Service(settings, ArpaParameters(**parameters))
    memory = service.start()
    limits = service.arpa.limits
    ships = scenario.fleet.paths.ships - 1
    shape = (scenario.scans, ships)
    time, dangerous, alarmed = np.zeros(shape[0]), np.zeros(shape, bool), np.zeros(shape, bool)
    cpa = np.full(shape, np.nan)
    sounded: list[float] = []
    whose: list[int] = []
    heard: dict[int, float] = {}  # track number -> s, when its alarm sounded; not acknowledged yet
    for k, (scan, _) in enumerate(radar.simulate(scenario, seed)):
        now = time[k] = scan.end
        truth, own = scenario.truth_at(now), _own_ship(scenario, now, swing)
        row = truth.target - 1
        cpa[k, row], tcpa = cpa_of(truth.position - own[0], truth.velocity - own[1])
        dangerous[k, row] = (cpa[k, row] < limits.cpa) & (tcpa >= 0) & (tcpa < limits.tcpa)
        for track in [track for track, since in heard.items() if now >= since + REACTION]:
            del heard[track]
            alerts = memory.arpa.alerts
            of = (alerts.id == track) & (alerts.kind == DANGER) & (alerts.state > 0)
            if of.any():
                number = int(alerts.number[of][0])
                alerts, _ = alarms.acknowledge(alerts, now, DANGER, number)
                memory = memory._replace(arpa=memory.arpa._replace(alerts=alerts))
        memory, output = service.step(memory, scan)
        picture = output.picture
        away = np.linalg.norm(picture.motion.position[:, None] - truth.position, axis=2)
        nearest = away.argmin(1) if len(row) else np.zeros(len(away), np.int64)
        its = {
            track: int(row[at]) if len(row) and off[at] <= ITS_OWN else NOBODY
            for track, at, off in zip(picture.targets.id.tolist(), nearest.tolist(), away)
        }
        changed = picture.changed
        new = (changed.kind == DANGER) & (changed.state == ACTIVE_UNACKNOWLEDGED)
        for track in changed.id[new].tolist():
            heard[track] = now
            sounded.append(now)
            whose.append(its.get(track, NOBODY))
        alerts = picture.alerts
        active = (alerts.kind == DANGER) & np.isin(alerts.state, ACTIVE)
        told = {its.get(track, NOBODY) for track in alerts.id[active].tolist()} - {NOBODY}
        alarmed[k, list(told)] = True
    return Watch(time, dangerous, cpa, alarmed, np.array(sounded), np.array(whose, np.int64))


def _own_ship(scenario: Scenario, time: float, swing: float) -> tuple[Array, Array]:
    """Own ship's true position [2] m and velocity [2] m/s; the velocity is the mean over one swing
    if she yaws.
    """
    if not swing:
        own = scenario.own_ship_at(time)
        return own.position[0], own.velocity[0]
    around = scenario.own_ship_at([time, max(time - swing / 2, 0.0), time + swing / 2])
    made = (around.position[2] - around.position[1]) / (around.time[2] - around.time[1])
    return around.position[0], made
