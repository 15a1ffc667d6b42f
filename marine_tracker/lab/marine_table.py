"""The classical filters on a marine radar: position and velocity errors on three tracks.

The radar turns at 22 rpm; plots have deviations of 15 m and 0.5 deg. Targets start at 5 km: a
straight run at 8 m/s; the same with two turns of 90 deg at 1.5 deg/s; a fast boat at 15 m/s with
turns of 90 deg at 3 deg/s. Errors are RMS per axis, after the first 40 scans. The limits for
`cs_kalman` come from a prototype of the same filter on the same tracks.
"""

from typing import NamedTuple

import numpy as np

from ..estimators import cs_kalman, imm
from ..estimators.contract import Estimator
from ..evaluation import report
from ..evaluation.result import Progress, Result, silent
from ..geometry import polar_to_position, to_range_bearing, unit_vector
from ..types import Array, Plots, take

HELP = 'CV, IMM and CS-Kalman on a straight run, in turns and on a fast boat'
RUNS = 100
PERIOD = 60 / 22  # s
RANGE_SIGMA = 15.0  # m
BEARING_SIGMA = float(np.radians(0.5))
SCANS, SETTLED = 400, 40
FIRST_TURN, SECOND_TURN = 80, 200  # scan
START, COURSE = np.array([-4000.0, 3000.0]), np.radians(80)  # m east and north; rad


class Leg(NamedTuple):
    """speed m/s; turn_rate rad/s of two opposite turns, each of `turning` scans."""

    speed: float
    turn_rate: float
    turning: int


TRACKS = {
    'straight': Leg(8.0, 0.0, 0),
    'turns': Leg(8.0, float(np.radians(1.5)), 22),
    'fast boat': Leg(15.0, float(np.radians(3.0)), 11),
}


def cv(noise: float) -> Estimator:
    """Constant velocity with white acceleration; its density is in m^2/s^3."""
    return imm.imm(imm.Modes((noise,), (0.0,), (1.0,), PERIOD), 30.0)


def filters() -> dict[str, Estimator]:
    """The rows of the table."""
    two_cv = imm.Modes((0.0005, 0.5), (0.0, 0.0), (0.98, 0.9), PERIOD)
    rows = {
        'CV q .001': cv(0.001),
        'CV q .05': cv(0.05),
        'IMM CV/CV q (.0005, .5)': imm.imm(two_cv, 30.0),
    }
    for limit in (0.3, 1.0):
        rows[f'CS a_max {limit:g}'] = cs_kalman.cs_kalman(cs_kalman.Manoeuvre(limit, 1 / 60), 30.0)
    rows['imm, as shipped for ships'] = imm.imm(imm.PRESETS['ship'], 30.0)
    return rows


def truth(leg: Leg) -> tuple[Array, Array]:
    """Position [SCANS, 2] m and velocity [SCANS, 2] m/s, exact on straights and arcs."""
    rate = np.zeros(SCANS)
    rate[FIRST_TURN : FIRST_TURN + leg.turning] = leg.turn_rate
    rate[SECOND_TURN : SECOND_TURN + leg.turning] = -leg.turn_rate
    course = COURSE + np.concatenate([[0], np.cumsum(rate[:-1] * PERIOD)])
    half = 0.5 * rate * PERIOD  # a chord's direction is ahead by half the turn of its step
    step = leg.speed * PERIOD * np.sinc(half / np.pi)[:, None] * unit_vector(course + half)
    position = START + np.concatenate([np.zeros((1, 2)), np.cumsum(step[:-1], 0)])
    return position, leg.speed * unit_vector(course)


def errors(
    estimator: Estimator, leg: Leg, runs: int, seed: int, detection: float = 1.0
) -> tuple[float, float]:
    """RMS position error m and velocity error m/s per axis. Every run is one track of a batch.

    detection  probability of each plot after the first
    """
    rng = np.random.default_rng(seed)
    position, velocity = truth(leg)
    distance, bearing = to_range_bearing(position)
    every = np.arange(runs)
    state, off = None, []
    for k in range(SCANS):
        r = distance[k] + rng.normal(0, RANGE_SIGMA, runs)
        b = bearing[k] + rng.normal(0, BEARING_SIGMA, runs)
        z, covariance = polar_to_position(r, b, RANGE_SIGMA, BEARING_SIGMA)
        time = np.full(runs, k * PERIOD)
        plots = Plots(time, r, b, np.zeros(runs), np.zeros((runs, 2)), z, covariance)
        seen = every if detection == 1 else np.flatnonzero(rng.random(runs) < detection)
        state = (
            estimator.init(plots)
            if state is None
            else estimator.update(state, take(plots, seen), seen)
        )
        if k >= SETTLED:
            now = estimator.extrapolate(state, time)
            off.append((now.position - position[k], now.velocity - velocity[k]))
    found = [float(np.sqrt(np.mean(np.square([pair[i] for pair in off])))) for i in (0, 1)]
    return found[0], found[1]


def run(runs: int, seed: int, progress: Progress = silent) -> Result:
    """Every filter on every track, then the figures of `cs_kalman` that have limits."""
    figures: list[report.Figure] = []
    found = {}
    for done, (name, estimator) in enumerate(filters().items()):
        progress(done, len(filters()))
        for track, leg in TRACKS.items():
            found[name, track] = errors(estimator, leg, runs, seed)
            for what, unit, value in zip(
                ('position', 'velocity'), ('m', 'm/s'), found[name, track], strict=True
            ):
                figures.append(report.Figure(f'{name}, {track}: {what}', value, unit))
    demanded = {'straight': (16.5, 1.15), 'turns': (12.0, 1.1)}
    for track, limits in demanded.items():
        for what, unit, value, limit in zip(
            ('position', 'velocity'),
            ('m', 'm/s'),
            found['CS a_max 0.3', track],
            limits,
            strict=True,
        ):
            figures.append(
                report.at_most(f'cs_kalman, {track}: {what}', value, limit, unit, 'prototype')
            )
    leg = TRACKS['fast boat']
    half = cs_kalman.Manoeuvre(0.5 * leg.speed * leg.turn_rate, 1 / 60)
    position, _ = errors(cs_kalman.cs_kalman(half, 30.0), leg, runs, seed)
    figures.append(
        report.at_most(
            'cs_kalman, a_max half the truth: position',
            position,
            50.0,
            'm',
            'prototype; 5,388 m without the variance floor',
        )
    )
    progress(len(filters()), len(filters()))
    return Result(figures)
