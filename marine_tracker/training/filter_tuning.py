"""Searches for the best settings of a filter, to give `gwnn` the strongest possible rivals.

The tracks are drawn as for the training of `gwnn`, with a different seed. Only the first sort of
radars is used (for ships: none at close range), because the comparison has no other sort. Tuning
for other sorts as well would make the rival weaker. All candidates see the same plots (common
random numbers), one scan ahead, with the gate of the comparison. The score is the geometric mean of
the RMS position error, in the plots' true deviations. Each kind of motion and each phase counts
alike.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import optimize

from ..evaluation.report import Figure
from ..types import Array, Numbers, take
from . import gwnn_samples, track_trials, training_tracks
from .filter_families import IMM, Family, Settings, filter_of

# Weight of a cell where ships keep course and speed, by the target of the tuning.
STRAIGHT_WEIGHT = {'training': 1.0, 'manoeuvre': 0.0}
LEAST_TRACKS = 10 * max(len(waters.names) for waters in training_tracks.WATERS.values())
DRAWN = 2  # times as many tracks are drawn: close ones are left out
GLOBAL_SHARE = 2 / 3  # of the evaluations, all over the bounds; the rest go downhill
POPULATION = 4  # times the number of settings searched, rounded up to 2^n
SIMPLEX = 0.12  # of the bounds' width, first step of the way down; then smaller

Progress = Callable[[int, int], None]


class Course(NamedTuple):
    """Tracks to judge on, and which scans count for which cell.

    trial; cells: names; counts [C, B, K]: a cell's scans; kind [B] number of each track's kind;
    straight [C].
    """

    trial: track_trials.TrackTrial
    cells: tuple[str, ...]
    counts: NDArray[np.bool_]
    kind: NDArray[np.int64]
    straight: NDArray[np.bool_]


class TuningResult(NamedTuple):
    """Result of a search: the settings, their loss, and the best loss after each evaluation."""

    settings: Settings
    loss: float
    best: list[float]


def course(tracks: int, rng: np.random.Generator, vessel_class: str = 'ship') -> Course:
    """About `tracks` tracks, the same number of each kind."""
    waters = training_tracks.WATERS[vessel_class]
    names = waters.names
    each = tracks // len(names)
    drawn = training_tracks.draw(
        waters._replace(radars=waters.radars[:1]),
        np.repeat(np.arange(len(names)), DRAWN * each),
        gwnn_samples.SCANS,
        rng,
    )
    keep = np.concatenate([np.flatnonzero(drawn.kind == i)[:each] for i in range(len(names))])
    on = track_trials.trial(take(drawn.ships, keep), take(drawn.radar, keep), rng, drawn.hull[keep])
    kind, cells, counts, straight = drawn.kind[keep], [], [], []
    for i, name in enumerate(names):
        for phase, within in (('straight', ~on.phase), ('manoeuvre', on.phase)):
            chosen = on.counts & within & (kind == i)[:, None]
            if chosen.any():
                cells.append(f'{name}, {phase}')
                counts.append(chosen)
                straight.append(phase == 'straight')
    return Course(on, tuple(cells), np.stack(counts), kind, np.array(straight))


def errors(settings: Settings, on: Course) -> Array:
    """Squared errors [C, B] of a filter summed over the scans of each cell, in true deviations."""
    found = track_trials.run(filter_of(settings), on.trial, gated=True).position
    found = found / np.square(on.trial.radar.truly)[:, None]
    return np.einsum('bk,cbk->cb', found, on.counts)


def loss(error: Array, on: Course, target: str) -> float:
    """Mean log RMS, over the cells that count for the target, of errors [C, B]."""
    return float(_weights(on, target) @ _levels(error.sum(1), on.counts.sum((1, 2))))


def _levels(square, count):
    """Log RMS per axis from sums of squares."""
    return 0.5 * np.log(square / count / 2)


def _weights(on: Course, target: str):
    weight = np.where(on.straight, STRAIGHT_WEIGHT[target], 1.0)
    return weight / weight.sum()


def cell_ratios(error: Array, against: Array, on: Course) -> dict[str, float]:
    """Ratio of the RMS of errors [C, B] to that of other errors, by cell."""
    return dict(zip(on.cells, np.sqrt(error.sum(1) / against.sum(1)).tolist()))


def compare(
    error: Array,
    against: Array,
    on: Course,
    target: str,
    rng: np.random.Generator,
    resamples: int = 1000,
) -> track_trials.Ratio:
    """Geometric mean of the cells' ratios. Its interval resamples tracks within each kind."""
    weight = _weights(on, target)
    pick = np.concatenate(
        [
            rows[rng.integers(0, len(rows), (resamples, len(rows)))]
            for rows in (np.flatnonzero(on.kind == i) for i in np.unique(on.kind))
        ],
        1,
    )
    times = np.stack([np.bincount(one, minlength=len(on.kind)) for one in pick])
    # A resample may leave a small cell without any scan. It is then ignored.
    one, other = error @ times.T, against @ times.T
    known = (one > 0) & (other > 0)
    level = 0.5 * np.log(np.where(known, one, 1.0) / np.where(known, other, 1.0))
    low, high = np.exp(np.percentile(weight @ level / (weight @ known), [2.5, 97.5]))
    value = np.exp(weight @ (0.5 * np.log(error.sum(1) / against.sum(1))))
    return track_trials.Ratio(float(value), float(low), float(high))


def search(
    judge: Callable[[Settings], float],
    evaluations: int,
    seed: int,
    start: Numbers | None = None,
    progress: Progress = lambda done, whole: None,
    family: Family = IMM,
) -> TuningResult:
    """The settings with the least loss found in a number of evaluations. Repeatable.

    Two thirds of the evaluations are differential evolution over the bounds, because there are
    several minima. The others are bounded Nelder-Mead from the best point. It restarts with a
    smaller simplex when it stops.

    judge  returns the loss
    start  [.] within 0 to 1, where the search begins; by default the middle of the bounds
    family of the filters searched
    Raises FloatingPointError if a loss is not a finite number.
    """
    count = len(family.searched)
    tried: list[tuple[float, tuple[float, ...]]] = []
    best: list[float] = []

    def at(point):
        if len(tried) == limit:
            raise _SpentError
        settings = family.at(point)
        value = judge(settings)
        if not np.isfinite(value):
            raise FloatingPointError(f'the error of {settings} is {value}')
        tried.append((value, tuple(point)))
        best.append(min(tried)[0])
        progress(len(tried), evaluations)
        return value

    limit = max(1, int(GLOBAL_SHARE * evaluations))
    bounds = [(0.0, 1.0)] * count
    try:
        optimize.differential_evolution(
            at,
            bounds,
            x0=np.full(count, 0.5) if start is None else start,
            init='sobol',
            popsize=POPULATION,
            maxiter=evaluations,
            tol=0,
            polish=False,
            seed=np.random.default_rng([seed, 11]),
        )
    except _SpentError:
        pass
    limit = evaluations
    try:
        size = SIMPLEX
        while True:
            origin = np.array(min(tried)[1])
            corners = np.tile(origin, (count + 1, 1))
            corners[1:] += np.diag(np.where(origin < 0.5, size, -size))  # into the bounds
            optimize.minimize(
                at,
                origin,
                method='Nelder-Mead',
                bounds=bounds,
                options={
                    'initial_simplex': corners,
                    'adaptive': True,
                    'xatol': size / 20,
                    'fatol': 1e-5,
                },
            )
            size /= 2
    except _SpentError:
        pass
    least, point = min(tried)
    return TuningResult(family.at(point), least, best)


class _SpentError(Exception):
    """No evaluations are left."""


def tune(
    target: str,
    tracks: int,
    evaluations: int,
    seed: int,
    progress: Progress = lambda done, whole: None,
    vessel_class: str = 'ship',
    family: Family = IMM,
) -> tuple[TuningResult, Course]:
    """The settings found for a target of STRAIGHT_WEIGHT, and the tracks of the search."""
    on = course(tracks, _tracks_rng(seed, 0), vessel_class)
    return search(
        lambda settings: loss(errors(settings, on), on, target),
        evaluations,
        seed,
        progress=progress,
        family=family,
    ), on


def fresh(tracks: int, seed: int, vessel_class: str = 'ship') -> Course:
    """Tracks that `tune` with this seed does not see."""
    return course(tracks, _tracks_rng(seed, 1), vessel_class)


def _tracks_rng(seed: int, part: int):
    """Differs from every seed of a training and of the comparison."""
    return np.random.default_rng([seed, 11, 11, part])


class Verdict(NamedTuple):
    """The figures of settings beside those of others; ratio: to one of them, on new tracks."""

    figures: list[Figure]
    ratio: track_trials.Ratio


def judge(
    settings: Settings,
    shipped: dict[str, Settings],
    rival: str,
    target: str,
    seen: Course,
    unseen: Course,
    seed: int,
) -> Verdict:
    """Compares settings with the shipped ones, on the tracks of the search and on new ones.

    rival  the one of `shipped` that is for the same target
    """
    rng = np.random.default_rng([seed, 11, 12])
    figures = []
    for place, on in (('tracks of the search', seen), ('fresh tracks', unseen)):
        found = errors(settings, on)
        others = {name: errors(one, on) for name, one in shipped.items()}
        for name, error in [('found', found), *others.items()]:
            figures.append(
                Figure(f'{place}: {name}', float(np.exp(loss(error, on, target))), 'sigma')
            )
        for name, error in others.items():
            ratio = compare(found, error, on, target, rng)
            figures.append(
                Figure(
                    f'{place}: found over {name}',
                    ratio.value,
                    '',
                    None,
                    None,
                    f'[{ratio.low:.4f} {ratio.high:.4f}]',
                )
            )
            if name == rival:
                to_rival, cells = ratio, cell_ratios(found, error, on)
    figures += [
        Figure(f'fresh tracks, {cell}: found over {rival}', value) for cell, value in cells.items()
    ]
    return Verdict(figures, to_rival)
