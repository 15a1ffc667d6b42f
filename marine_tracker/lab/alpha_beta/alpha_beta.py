"""Tests the adaptive alpha-beta filters of paper 002 on its HF radar and on a marine radar.

HF radar: 60 scans of one minute; five ships at 60 to 140 km; plot deviations 0.8 km, 0.5 km/h and
1 deg; detection probability 0.85; 150 false plots a scan (the scenario `hf_radar`). Errors are
those of the fifth ship, which crosses at 110 km: RMS after the first ten scans, while its track
lives. Every filter gets the same plots by the same association (hf_trials.py). The paper's table
of ships is lost. The share of lost tracks depends on the speed of the fifth ship, so that ship is
also tried at 40 km/h.

Marine radar: the tracks of `marine_table` with a Doppler deviation of 0.5 m/s. Each plot is given
to its own track. 200 runs take about 12 s of CPU time.
"""

from typing import NamedTuple

import numpy as np

from ...estimators import imm
from ...estimators.alpha_beta import NOISE, alpha_beta
from ...estimators.alpha_beta_gains import GAINS
from ...estimators.contract import Estimator
from ...evaluation import report
from ...evaluation.result import Progress, Result, silent
from ...geometry import polar_to_position, to_range_bearing, unit_vector, wrap_angle
from ...types import Plots
from .. import marine_table
from . import hf_trials
from .claims import claims
from .hf_trials import CROSSING, Outcome, Scene
from .pictures import pictures
from .polar_kalman import polar_kalman

HELP = "adaptive alpha-beta with Doppler: paper 002's HF radar, and a marine one"
RUNS = 200
KALMAN, IMM = 'polar Kalman', 'imm, no Doppler'
NO_DOPPLER = np.array([hf_trials.GATE[0], np.inf, hf_trials.GATE[2]])
SETTLED = 10  # first scans, left out of the errors
UNITS = (('R', 'km', 1e3), ('v', 'km/h', 1 / 3.6), ('theta', 'deg', float(np.radians(1))))
DOPPLER_SIGMA = 0.5  # m/s, Doppler deviation of the marine radar
FASTER = 40 / 3.6  # m/s: a faster crossing ship, which is harder
PROTOTYPE = 'prototype'


class Summary(NamedTuple):
    """Results of a filter in the HF scene.

    Share of crossing ships lost; RMS errors [3] of those not lost in m, m/s, rad; share lost of all
    five ships; roughness of the crossing track in m, see `summary`.
    """

    lost: float
    error: np.ndarray
    all_lost: float
    roughness: float


def filters(on: Scene) -> dict[str, Estimator]:
    """The four modes, and the filters to compare them with."""
    sigma = on.sigma.tolist()
    rows = {
        mode: alpha_beta(mode, on.max_speed, sigma[1], NOISE['ship'])
        for mode in ('method2', 'method1', 'hf', 'hf_soft')
    }
    assert set(rows) == set(GAINS)
    return {
        **rows,
        KALMAN: polar_kalman(on.max_speed, *sigma),
        IMM: imm.imm(imm.PRESETS['ship'], on.max_speed),
    }


def summary(outcome: Outcome) -> Summary:
    """The figures of one filter. Roughness: RMS of the second difference of the position error from
    scan to scan.
    """
    error = outcome.error[SETTLED:, :, CROSSING]
    off = error[..., [0, 2]] * [1.0, 110e3]  # m along and across
    rough = np.diff(off, 2, axis=0)
    return Summary(
        float(outcome.lost[-1, :, CROSSING].mean()),
        np.sqrt(_mean(error**2)),
        float(outcome.lost[-1].mean()),
        float(np.sqrt(_mean(rough**2).sum())),
    )


def _mean(values):
    """RMS over scans and runs, [3 or 2]; nan where every track is lost."""
    known = np.isfinite(values)
    count = known.sum((0, 1))
    return np.where(
        count > 0, np.where(known, values, 0.0).sum((0, 1)) / np.maximum(count, 1), np.nan
    )


def marine(leg: marine_table.Leg, runs: int, seed: int, doppler: bool) -> tuple[float, float]:
    """RMS position error (m an axis) and course error (deg) of `hf_soft` on a marine track."""
    rng = np.random.default_rng(seed)
    position, velocity = marine_table.truth(leg)
    distance, bearing = to_range_bearing(position)
    leaving = (velocity * unit_vector(bearing)).sum(1)
    filter_ = alpha_beta('hf_soft', 30.0, DOPPLER_SIGMA, NOISE['ship'])
    every, state, off, turned = np.arange(runs), None, [], []
    for k in range(marine_table.SCANS):
        r = distance[k] + rng.normal(0, marine_table.RANGE_SIGMA, runs)
        b = bearing[k] + rng.normal(0, marine_table.BEARING_SIGMA, runs)
        v = leaving[k] + rng.normal(0, DOPPLER_SIGMA, runs)
        z, covariance = polar_to_position(
            r, b, marine_table.RANGE_SIGMA, marine_table.BEARING_SIGMA
        )
        time = np.full(runs, k * marine_table.PERIOD)
        plots = Plots(
            time, r, b, np.zeros(runs), np.zeros((runs, 2)), z, covariance, v if doppler else None
        )
        state = filter_.init(plots) if state is None else filter_.update(state, plots, every)
        if k >= marine_table.SETTLED:
            now = filter_.extrapolate(state, time)
            off.append(now.position - position[k])
            turned.append(wrap_angle(np.arctan2(*now.velocity.T) - np.arctan2(*velocity[k])))
    return (
        float(np.sqrt(np.mean(np.square(off)))),
        float(np.degrees(np.sqrt(np.mean(np.square(turned))))),
    )


def run(runs: int, seed: int, progress: Progress = silent) -> Result:
    """Every filter on the HF radar, and `hf_soft` at sea: figures, claims and pictures."""
    on = hf_trials.scene()
    rows = filters(on)
    outcomes: dict[str, Outcome] = {}
    for done, (name, estimator) in enumerate(rows.items()):
        progress(done, len(rows) + 2)
        gate = NO_DOPPLER if name == IMM else hf_trials.GATE
        outcomes[name] = hf_trials.run(estimator, on, runs, seed, gate)
    found = {name: summary(outcome) for name, outcome in outcomes.items()}
    faster = hf_trials.scene(FASTER)
    lost = {
        name: summary(hf_trials.run(estimator, faster, runs, seed)).lost
        for name, estimator in rows.items()
        if name != IMM
    }
    figures = hf_figures(found) + [
        report.Figure(f'{name}: lost at {3.6 * FASTER:.0f} km/h', 100 * share, '%')
        for name, share in lost.items()
    ]
    for done, (track, leg) in enumerate(list(marine_table.TRACKS.items())[:2]):
        progress(len(rows) + done, len(rows) + 2)
        figures += marine_figures(track, leg, runs, seed)
    progress(len(rows) + 2, len(rows) + 2)
    return Result(figures, claims(found, lost), pictures(on, outcomes))


def hf_figures(found: dict[str, Summary]) -> list[report.Figure]:
    """The limits for each filter in the HF scene, and the figures without a limit beside them."""
    most_lost = {'hf': 6.0, 'hf_soft': 2.0, KALMAN: 1.0}
    limits = {'R': 0.60, 'v': 0.40, 'theta': 0.75}
    figures = []
    for name, row in found.items():
        lost, title = 100 * row.lost, f'{name}: crossing ship lost'
        if name == 'method2':
            figures.append(report.at_least(title, lost, 60.0, '%', PROTOTYPE))
        elif name in most_lost:
            figures.append(report.at_most(title, lost, most_lost[name], '%', PROTOTYPE))
        else:
            figures.append(report.Figure(title, lost, '%'))
        figures.append(report.Figure(f'{name}: any of the five lost', 100 * row.all_lost, '%'))
        for (what, unit, size), value in zip(UNITS, row.error, strict=True):
            title, value = f'{name}: {what}', value / size
            figures.append(
                report.at_most(title, value, limits[what], unit, PROTOTYPE)
                if name == 'hf_soft'
                else report.Figure(title, value, unit)
            )
    return figures


def marine_figures(track: str, leg: marine_table.Leg, runs: int, seed: int) -> list[report.Figure]:
    """`hf_soft` on one track of the marine table, with Doppler and without it."""
    figures = []
    for doppler in (True, False):
        how = 'with Doppler' if doppler else 'without'
        position, course = marine(leg, runs, seed, doppler)
        for what, value, limit, unit in (
            ('position', position, 16.0, 'm'),
            ('course', course, 5.5, 'deg'),
        ):
            name = f'marine, {track}, hf_soft {how}: {what}'
            figures.append(
                report.at_most(name, value, limit, unit, PROTOTYPE)
                if doppler and track == 'straight'
                else report.Figure(name, value, unit)
            )
    return figures
