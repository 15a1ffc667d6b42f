"""True tracks that no weights were trained on: autopilots, the turn of paper 000, real ships.

Every function returns `ship_tracks.Ships` for time steps [B, K] s.
"""

import csv
from pathlib import Path

import numpy as np
from scipy.interpolate import make_smoothing_spline

from ...geodesy import LocalFrame
from ...geometry import unit_vector
from ...simulation import ais, ais_file, motion
from ...training.ship_tracks import Ships
from ...types import Array

TURN_SCAN, TURN_RADIUS, TURN_ANGLE = 100, 200.0, float(np.radians(50))  # paper 000, 5.2
TURNING = 0.04  # m/s^2, acceleration that counts as a manoeuvre
WARM_UP = 20  # first scans, left out
TRIES = 40
FASTEST = 2.5  # m/s^2; no ship accelerates more, so larger values come from late reports
LONGEST_GAP = 60.0  # s between two AIS reports
HOUR = 3600.0  # s, the length of an AIS file that is used


def _clock(steps):
    return np.cumsum(steps, 1) - steps[:, :1]


def nomoto(steps: Array, rng: np.random.Generator) -> Ships:
    """Ships under autopilot with first-order Nomoto steering, ordered to new courses and speeds.

    A steady current, of about 1 m/s at most, moves them over the ground.
    """
    count, scans = len(steps), steps.shape[1]
    position = rng.uniform(1500, 15000, count)[:, None] * unit_vector(
        rng.uniform(0, 2 * np.pi, count)
    )
    course, speed = rng.uniform(0, 2 * np.pi, count), rng.uniform(2, 16, count)
    ordered_course, ordered_speed, rate = course.copy(), speed.copy(), np.zeros(count)
    lag = rng.uniform(3, 20, count)
    most = np.minimum(np.radians(rng.uniform(0.5, 5, count)), 1 / speed)
    speed_lag = rng.uniform(20, 100, count)
    stream = rng.normal(0, 0.3, (count, 2))
    positions, velocities = np.empty((2, count, scans, 2))
    manoeuvre = np.empty((count, scans), bool)
    parts = 8
    for k in range(scans):
        new = rng.random(count) < 1 / 70
        side = np.where(rng.random(count) < 0.5, -1, 1)
        ordered_course = np.where(
            new, course + side * np.radians(rng.uniform(10, 120, count)), ordered_course
        )
        new = rng.random(count) < 1 / 200
        ordered_speed = np.where(new, rng.uniform(2, 16, count), ordered_speed)
        positions[:, k] = position
        velocities[:, k] = speed[:, None] * unit_vector(course) + stream
        manoeuvre[:, k] = (np.abs(rate) * speed > TURNING) | (
            np.abs(ordered_speed - speed) / speed_lag > 0.03
        )
        dt = steps[:, min(k + 1, scans - 1)] / parts
        for _ in range(parts):
            wanted = np.clip((ordered_course - course) / (2 * lag), -most, most)
            rate = (
                rate
                + dt * 2 * (wanted - rate) / lag
                + rng.normal(0, np.radians(0.02), count) * np.sqrt(dt)
            )
            course = course + dt * rate
            speed = speed + dt * (ordered_speed - speed) / speed_lag
            position = position + dt[:, None] * (speed[:, None] * unit_vector(course) + stream)
    return Ships(_clock(steps), positions, velocities, manoeuvre)


def paper_turn(steps: Array, rng: np.random.Generator) -> Ships:
    """The sharp turn of paper 000: radius 200 m through 50 deg, the same for every run."""
    count, scans = steps.shape
    position = np.tile(4600 * unit_vector(np.radians(30)), (count, 1))
    course, time, left = np.full(count, np.radians(70)), np.zeros(count), np.full(count, TURN_ANGLE)
    positions, velocities = np.empty((2, count, scans, 2))
    manoeuvre = np.zeros((count, scans), bool)
    parts = 20

    def speed():
        return 9.26 + 1.03 * np.sin(2 * np.pi * time / 1000)

    for k in range(scans):
        positions[:, k], velocities[:, k] = position, speed()[:, None] * unit_vector(course)
        manoeuvre[:, k] = (k >= TURN_SCAN) & (left > 0)
        dt = steps[:, min(k + 1, scans - 1)] / parts
        for _ in range(parts):
            turned = np.where((k >= TURN_SCAN) & (left > 0), speed() / TURN_RADIUS * dt, 0.0)
            course, left = course + turned, left - turned
            position = position + (dt * speed())[:, None] * unit_vector(course)
            time = time + dt
    return Ships(_clock(steps), positions, velocities, manoeuvre)


def real_ships(file: Path, steps: Array, rng: np.random.Generator) -> Ships:
    """Stretches of AIS tracks. Every vessel is used equally often; half of the stretches have a
    manoeuvre if possible.

    Each is turned, mirrored and moved at random. Raises ValueError if no vessel reports long enough
    without a gap.
    """
    vessels = ais_file.read(file, 0.0, HOUR, LONGEST_GAP).vessels
    first = next(iter(vessels.values()))
    frame = LocalFrame(first.latitude[0], first.longitude[0])
    ways = [ais.way(reports, frame) for reports in vessels.values()]
    paths = motion.table(ways, HOUR)
    need = steps.sum(1).max() + 20
    stretches = []
    for ship, way in enumerate(ways):
        ends = [p.start for p in way if not p.exists and p.start > 0] + [HOUR]
        starts = [max(a.start, 0.0) for a, b in zip(way[1:], way[:-1]) if a.exists and not b.exists]
        for begin in starts:
            end = min(end for end in ends if end > begin)
            where, _ = motion.locate_ships(paths, np.full(2, ship), np.array([begin, end - 1]))
            if end - begin > need and np.hypot(*(where[1] - where[0])) > end - begin:
                stretches.append((ship, begin, end))
    if not stretches:
        raise ValueError(f'AIS file {file} has no vessel under way for {need:.0f} s without a gap')
    by_ship: dict[int, list] = {}
    for stretch in stretches:
        by_ship.setdefault(stretch[0], []).append(stretch)
    ships = list(by_ship)

    def draw(run, time):
        for _ in range(TRIES):
            choice = by_ship[ships[rng.integers(len(ships))]]
            ship, begin, end = choice[rng.integers(len(choice))]
            at = begin + 5 + rng.random() * (end - begin - time[-1] - 10) + time
            found = motion.locate_ships(paths, np.full(len(at), ship), at)
            size = _acceleration(found[1], time)
            if (size[WARM_UP:] > TURNING).any() == (run % 2 == 0) and size.max() < FASTEST:
                break
        return found

    return _place(draw, steps, rng)


def recorded_boats(file: Path, steps: Array, rng: np.random.Generator) -> Ships:
    """Stretches of the true tracks of a recording: smoothed, turned and moved at random."""
    rows: dict[str, list[tuple[float, float, float]]] = {}
    with open(file, newline='') as table:
        for row in csv.DictReader(table):
            rows.setdefault(row['target'], []).append(
                (float(row['time_s']), float(row['east_m']), float(row['north_m']))
            )
    splines = []
    for track in rows.values():
        time, east, north = np.unique(np.array(track), axis=0).T
        splines.append(
            (time[0], time[-1], [make_smoothing_spline(time, x, lam=1.0) for x in (east, north)])
        )

    def draw(run, time):
        begin, end, axes = splines[run % len(splines)]
        at = np.minimum(begin + rng.random() * max(end - begin - time[-1], 0.0) + time, end)
        return tuple(np.stack([axis(at, order) for axis in axes], -1) for order in (0, 1))

    return _place(draw, steps, rng)


def _acceleration(velocity, time):
    """Acceleration [K] m/s^2."""
    return np.hypot(*np.gradient(velocity, time, axis=0).T)


def _place(draw, steps, rng) -> Ships:
    """Tracks that draw(run, time [K]) returns, each turned, mirrored and moved at random."""
    time = _clock(steps)
    count, scans = steps.shape
    positions, velocities = np.empty((2, count, scans, 2))
    manoeuvre = np.empty((count, scans), bool)
    for run in range(count):
        position, velocity = draw(run, time[run])
        angle = rng.uniform(0, 2 * np.pi)
        sin, cos = np.sin(angle), np.cos(angle)
        turn = np.array([[cos, sin], [-sin, cos]]) @ np.diag([1, rng.choice([-1, 1])])
        centre = np.exp(rng.uniform(np.log(2500), np.log(15000))) * unit_vector(
            rng.uniform(0, 2 * np.pi)
        )
        positions[run] = (position - position[scans // 2]) @ turn.T + centre
        velocities[run] = velocity @ turn.T
        manoeuvre[run] = _acceleration(velocity, time[run]) > TURNING
    return Ships(time, positions, velocities, manoeuvre)
