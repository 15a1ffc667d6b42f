"""Figures of the outline filters in the scenario of paper 004, with their limits."""

import time

import numpy as np

from ...evaluation.report import Figure, at_least, at_most
from ...extent import gaussian_process
from ...extent.gaussian_process import Model
from ...extent.input_noise import VARIANTS
from ...geometry import unit_vector
from .trials import (
    NOISE,
    PRIOR,
    RANDOM_MATRIX,
    SHAPES,
    SIGMA,
    START,
    START_VARIANCE,
    TURN_NOISE,
    Case,
    ExtendedTrial,
)

SPARSE, DENSE = 'complex, .8 a frame', 'complex, .8 a metre'
CASES = {
    DENSE: Case('complex', 0.8, per_metre=True),
    SPARSE: Case('complex', 0.8),
    'cross, .8 a frame': Case('cross', 0.8),
    'diamond, .8 a frame': Case('diamond', 0.8),
}
# SPARSE with one change each: the last two arguments of `gaussian_process_trial`, full and drawn.
OTHERWISE = {'noise of the cells only': (False, False), 'start drawn from P0': (True, True)}
OTHER_VARIANTS = ('gp', 'gp_ts', 'gp_q15')
SAMPLED = ('gp_mc', 'gp_q15')
CELLS = 30  # plots of the scan whose cost is measured
REPEATS = 20
STEP = 1e-6  # m and rad, steps of finite differences

Findings = dict[tuple[str, str], ExtendedTrial]  # by case (or by change) and filter


def figures(found: Findings) -> list[Figure]:
    """All measured figures, then those with limits."""
    table = []
    for (case, name), trial in found.items():
        if name != RANDOM_MATRIX:
            table += [
                Figure(f'{case}, {name}: RMSE', trial.rmse, 'm'),
                Figure(f'{case}, {name}: Mahalanobis distance', trial.mahalanobis),
                Figure(f'{case}, {name}: 3-sigma coverage', trial.coverage),
                Figure(f'{case}, {name}: PCRLB', trial.bound, 'm'),
            ]
        table += [
            Figure(f'{case}, {name}: off the true outline', trial.shape, 'm'),
            Figure(f'{case}, {name}: off the true centre', trial.place, 'm'),
        ]
    return table + demands(found)


def demands(found: Findings) -> list[Figure]:
    """The limits that the filters must meet."""
    sparse, dense = ({name: found[case, name] for name in VARIANTS} for case in (SPARSE, DENSE))
    against = 'prototype'
    made = []
    for name in SAMPLED:
        one, many = sparse[name], dense[name]
        made += [
            at_most(f'{SPARSE}, {name}: RMSE, demanded', one.rmse, 1.25, 'm', against),
            at_most(f'{SPARSE}, {name}: distance, demanded', one.mahalanobis, 5.0, '', against),
            at_least(f'{SPARSE}, {name}: coverage, demanded', one.coverage, 0.97, '', against),
            at_most(f'{DENSE}, {name}: RMSE, demanded', many.rmse, 0.90, 'm', against),
            at_least(f'{DENSE}, {name}: coverage, demanded', many.coverage, 0.95, '', against),
        ]
    made.append(
        at_least(
            f'{SPARSE}: distance of gp over that of gp_mc',
            sparse['gp'].mahalanobis / sparse['gp_mc'].mahalanobis,
            2.0,
            '',
            against,
        )
    )
    made.append(
        _above(
            f'{SPARSE}: coverage of gp_ts less that of gp',
            sparse['gp_ts'].coverage - sparse['gp'].coverage,
        )
    )
    for case, those in ((SPARSE, sparse), (DENSE, dense)):
        made.append(
            at_most(
                f'{case}: RMSE, gp_q15 apart from gp_mc',
                abs(those['gp_q15'].rmse - those['gp_mc'].rmse),
                0.1,
                'm',
                against,
            )
        )
    for case in CASES:
        bounds = [found[case, name].bound for name in ('gp', 'gp_ts', 'gp_ss', 'gp_mc')]
        made.append(
            _above(
                f'{case}: PCRLB, least step from gp to gp_ts, gp_ss, gp_mc',
                float(np.diff(bounds).min()),
                'm',
            )
        )
    return made


def jacobian() -> Figure:
    """The plain filter's Jacobian against central differences, at the start of 200 runs."""
    state, cells, noise, model = _start(200, 'gp')
    found = gaussian_process.measure(state, cells[:, 0], noise, model).jacobian
    worst = 0.0
    for i in range(found.shape[1]):
        shift = STEP * np.eye(found.shape[1])[i]
        ahead, behind = (
            gaussian_process.measure(
                state._replace(mean=state.mean + s), cells[:, 0], noise, model
            ).innovation
            for s in (shift, -shift)
        )
        worst = max(worst, float(np.abs((behind - ahead) / (2 * STEP) - found[:, i]).max()))
    return at_most('jacobian off finite differences', worst, 1e-2)


def costs() -> list[Figure]:
    """Processor time for one target's scan of 30 cells, with no other target in the batch."""
    made = []
    for variant in VARIANTS:
        state, cells, noise, model = _start(1, variant)
        taken = []
        for k in range(REPEATS):
            rng, begun = np.random.default_rng(k), time.process_time()
            moved = gaussian_process.predict(state, state.time + 1, model)
            gaussian_process.update(
                moved, np.zeros(1, int), cells, np.array([CELLS]), noise, model, rng
            )
            taken.append(time.process_time() - begun)
        made.append(
            at_most(f'cost of {CELLS} plots, {variant}', 1e3 * float(np.median(taken)), 10.0, 'ms')
        )
    return made


def _start(runs: int, variant: str):
    """Filters at the start, cells [runs, CELLS, 2] m of one scan, their noise, the model."""
    rng = np.random.default_rng(runs)
    angle = rng.uniform(0, 2 * np.pi, (runs, CELLS))
    cells = START[:2] + SHAPES['complex'](angle)[..., None] * unit_vector(angle + START[4])
    cells += SIGMA * rng.standard_normal(cells.shape)
    model = Model(PRIOR, variant, NOISE, TURN_NOISE)
    state = gaussian_process.start(
        model,
        np.zeros(runs),
        np.tile(START, (runs, 1)),
        np.diag(START_VARIANCE),
        np.full((runs, len(PRIOR.angle)), 4.0),
        np.ones((runs, 2)),
    )
    return state, cells, np.tile(SIGMA**2 * np.eye(2), (runs, 1, 1)), model


def _above(name: str, value: float, unit: str = '') -> Figure:
    return Figure(name, value, unit, '> 0', value > 0, 'paper 004')
