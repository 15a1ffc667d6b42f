"""Straight-line fits from every likely beginning of the target's present leg, with weights.

Course, speed and CPA come from them (`arpa.motion`), and they are experts of the estimator `gwnn`.
Such a filter must remember for minutes while a ship keeps its course, and must forget at once what
was before a turn. If the end of the last turn were known, a straight-line fit to the plots since
then would be optimal. It is not known. So several such fits run in parallel, with different
beginnings, and with one filter for a target that manoeuvres. Their weights are their probabilities
given the plots.

The model: a target keeps course and speed for `hold` s on average, then manoeuvres (white
acceleration) for `manoeuvre` s on average. Within a hypothesis about the last change, all is linear
and Gaussian (Adams and MacKay 2007, "Bayesian online changepoint detection"). To keep the number of
hypotheses constant, the two legs whose merging loses least are merged (Runnalls, IEEE T-AES 43(3),
2007). What changes into a manoeuvre is merged into that filter (as in Blom and Bar-Shalom's IMM).
An IMM alone also merges straight legs, so it never settles: the few per cent weight of its
manoeuvre mode disturb the steady mode at every scan.

Arrays are columns as in `gaussian.linear_modes`: [14, 1 + LEGS, N], the manoeuvre first.
"""

from typing import NamedTuple

import numpy as np

from ..types import Array
from . import linear_modes

LEGS = 4
STRAIGHT = 1e-6  # m^2/s^3, density of acceleration on a straight leg: almost none
AT_FIRST = 0.8  # probability that a new target is on a straight leg
LEAST_SHOWN = 0.05  # less likely hypotheses are not shown
START = np.array([1 - AT_FIRST, AT_FIRST] + [0.0] * (LEGS - 1))  # probabilities after one plot
ONE, OTHER = np.triu_indices(LEGS + 1, 1)


class Habits(NamedTuple):
    """How targets move.

    hold       s, how long they keep a course and speed, on average
    manoeuvre  s, how long a manoeuvre lasts, on average
    noise      m^2/s^3, density of the white acceleration of each axis in a manoeuvre
    """

    hold: float
    manoeuvre: float
    noise: float


class Legs(NamedTuple):
    """The hypotheses about N tracks, one row a track.

    rows    [N, 1 + LEGS, 14]  mean and covariance, packed as in `linear_modes`: the manoeuvre's,
                               then those of the legs
    weight  [N, 1 + LEGS]      their probabilities
    begun   [N, LEGS]          s, when the leg began
    """

    rows: Array
    weight: Array
    begun: Array


def begin(position: Array, covariance: Array, time: Array, speed_sigma: float) -> Legs:
    """Hypotheses from one plot each: position [N, 2] m, covariance [N, 2, 2] m^2, time [N] s.

    speed_sigma  m/s, deviation of each component of the velocity before anything is known
    """
    count = len(position)
    rows = np.zeros((count, 1 + LEGS, 14))
    rows[..., :2] = position[:, None]
    rows[..., [4, 5, 8]] = linear_modes.packed_noise(covariance).T[:, None]
    rows[..., [11, 13]] = speed_sigma**2
    return Legs(rows, np.tile(START, (count, 1)), np.tile(time[:, None], LEGS))


def update(
    legs: Legs,
    time: Array,
    step: Array,
    position: Array,
    covariance: Array,
    stretch: Array | None,
    certainty: float | Array,
    habits: Habits,
) -> tuple[Legs, Array]:
    """Takes one plot for each of N tracks at `time` [N] s, `step` [N] s after the last one.

    position    [N, 2]     m
    covariance  [N, 2, 2]  m^2
    stretch     [N, 2, 2]  correction for the wrong deviations of all earlier plots: see
                           `arpa.plot_noise`; None: they were right
    certainty   [N]        degrees of freedom of `covariance`: number of plots that it is based on
    Returns the hypotheses, and the mean and covariance [N, 14] of the likely ones.
    """
    columns = linear_modes.columns_of(legs.rows)
    if stretch is not None:
        _stretch(columns, stretch)
    columns, weight, begun = _change(
        columns, legs.weight.T, legs.begun.T, time - step, np.abs(step), habits
    )
    density = np.full((1 + LEGS, 1), STRAIGHT)
    density[0] = habits.noise
    columns = linear_modes.move(linear_modes.straight(density), columns, step)
    noise = linear_modes.packed_noise(covariance)
    _, distance, (_, _, _, determinant) = linear_modes.innovate(columns, position.T, noise)
    columns, _ = linear_modes.correct(columns, position.T, noise)
    # The covariance is an estimate itself, so the likelihood is Student's. It also tolerates one
    # wrong plot.
    score = -0.5 * (np.log(determinant) + (certainty + 2) * np.log1p(distance / certainty))
    weight = linear_modes.reweigh(weight, score)
    return (
        Legs(
            linear_modes.rows_of(columns),
            np.ascontiguousarray(weight.T),
            np.ascontiguousarray(begun.T),
        ),
        linear_modes.combine(columns, likely_weight(weight)).T,
    )


def likely_weight(weight: Array) -> Array:
    """Probabilities [1 + LEGS, N] without the unlikely hypotheses."""
    likely = np.where(weight > LEAST_SHOWN, weight, 0.0)
    found: Array = likely / likely.sum(0)
    return found


def _change(
    columns: Array, weight: Array, begun: Array, now: Array, step: Array, habits: Habits
) -> tuple[Array, Array, Array]:
    """Possible changes during the steps [N] s from the times `now` [N] s on.

    Every leg may have changed into a manoeuvre, and the manoeuvre into a new leg.
    """
    turn, settle = -np.expm1(-step / habits.hold), -np.expm1(-step / habits.manoeuvre)
    into = np.concatenate([(1 - settle) * weight[:1], turn * weight[1:]])
    total = into.sum(0)
    manoeuvre = linear_modes.combine(columns, into / total)
    legs = np.concatenate([columns[:, 1:], columns[:, :1]], 1)
    chance = np.concatenate([(1 - turn) * weight[1:], settle * weight[:1]])
    legs, chance, begun = _merge(legs, chance, np.concatenate([begun, now[None]]))
    return (
        np.concatenate([manoeuvre[:, None], legs], 1),
        np.concatenate([total[None], chance]),
        begun,
    )


def _merge(legs: Array, weight: Array, begun: Array) -> tuple[Array, Array, Array]:
    """LEGS legs out of LEGS + 1, the last one new: merges the two that cost least to merge.

    Only velocities count, because all legs agree on the position.
    """
    mean, spread = legs[2:4], legs[11:14]
    size = weight * np.log(spread[0] * spread[2] - spread[1] * spread[1])
    both = weight[ONE] + weight[OTHER] + 1e-300
    share = weight[ONE] / both
    rest = 1 - share
    (de, dn), product = mean[:, ONE] - mean[:, OTHER], share * rest
    ee, en, nn = share * spread[:, ONE] + rest * spread[:, OTHER]
    ee, en, nn = ee + product * de * de, en + product * de * dn, nn + product * dn * dn
    cost = both * np.log(ee * nn - en * en) - size[ONE] - size[OTHER]

    track = np.arange(weight.shape[1])
    pair = cost.argmin(0)
    one, other = ONE[pair], OTHER[pair]
    share = share[pair, track]
    shares = np.stack([share, 1 - share])
    legs[:, one, track] = linear_modes.combine(
        np.stack([legs[:, one, track], legs[:, other, track]], 1), shares
    )
    begun[one, track] = share * begun[one, track] + (1 - share) * begun[other, track]
    weight[one, track] = both[pair, track]
    for values in (legs, weight, begun):  # the last one moves to the free place
        values[..., other, track] = values[..., LEGS, track]
    return legs[:, :LEGS], weight[:LEGS], begun[:LEGS]


def _stretch(columns: Array, stretch: Array) -> None:
    """Corrects covariances of columns [14, J, N] by [N, 2, 2], in place, for misjudged plot errors.

    Straight-line fits scale with the errors of their plots, position and velocity alike.
    """
    (a, b), (c, d) = stretch.transpose(1, 2, 0)
    for ee, en, ne, nn in ((4, 5, 5, 8), (6, 7, 9, 10), (11, 12, 12, 13)):
        pee, pen, pne, pnn = columns[ee], columns[en], columns[ne], columns[nn]
        fe, fn, ge, gn = a * pee + b * pne, a * pen + b * pnn, c * pee + d * pne, c * pen + d * pnn
        columns[ee], columns[en] = fe * a + fn * b, fe * c + fn * d
        columns[ne], columns[nn] = ge * a + gn * b, ge * c + gn * d
