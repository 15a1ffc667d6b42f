"""How far radar and AIS stand off each other as a whole: the radar's range and bearing, and GPS.

Bearing and range of a radar are wrong by a little, for all targets alike; own ship's GPS moves all
ships of AIS alike. All four are estimated together by least squares over the ships that are joined,
with forgetting. One that stands much farther off than expected hardly counts: her AIS may be wrong.

At first nobody knows which track is which ship, and a bearing that is wrong by 1 degree puts each
ship of a lane on her neighbour's track. So `search` first asks under which errors of range and
bearing most ships have a track. Only if one answer is clearly the best it is taken.
"""

from typing import NamedTuple

import numpy as np

from ..geometry import to_range_bearing, unit_vector, wrap_angle
from ..types import Array, BoolArray, IntArray

MEMORY, INDEPENDENT = 180.0, 30.0  # s; errors of a pair are the same for so long
RANGE, BEARING, OFFSET = 60.0, np.radians(1.2), 6.0  # m, rad, m: what is expected, deviations
PAIR = 12.0  # m; a ship's own GPS error, and her echo off her middle
DOUBTED = 3.0  # deviations at which a pair counts a quarter
BEARINGS = np.radians(np.arange(-4.0, 4.01, 0.25))
RANGES = np.arange(-150.0, 151.0, 30.0)
SEARCH_MEMORY = 20.0  # s
CLEARLY = 8.0  # log-likelihood of the best answer over all that are not beside it
MOST_PAIRS = 300
VARIANCES = np.array([RANGE**2, BEARING**2, OFFSET**2, OFFSET**2])
FREE = np.array([16.0, 16.0, 1.0, 1.0])  # times as much, once the search has an answer


class Registration(NamedTuple):
    """What radar says less what AIS says, and the memory of it.

    value        [4]     range m, bearing rad; east, north m of GPS
    covariance   [4, 4]
    information  [4, 4], vector [4]  of the pairs, with forgetting, about `centre`
    centre       [4]     that the search found, from which least squares go on
    score        [B, R]  of the search: log-likelihood of each pair of errors; looked: s of it
    settled      whether the search has an answer
    pairs        number of ships in the last estimate
    """

    value: Array
    covariance: Array
    information: Array
    vector: Array
    centre: Array
    score: Array
    looked: float
    settled: bool
    pairs: int


def begin() -> Registration:
    """Nothing is known but what radars are like."""
    nothing = np.zeros(4)
    return Registration(
        nothing,
        np.diag(VARIANCES),
        np.zeros((4, 4)),
        nothing,
        nothing,
        np.zeros((len(BEARINGS), len(RANGES))),
        0.0,
        False,
        0,
    )


def jacobian(offset: Array) -> Array:
    """[P, 2, 4] m by the four errors of places at `offset` [P, 2] m from own ship."""
    range_, bearing = to_range_bearing(offset)
    along = unit_vector(bearing)
    found = np.zeros((len(offset), 2, 4))
    found[:, :, 0] = along
    found[:, :, 1] = range_[:, None] * np.stack([along[:, 1], -along[:, 0]], -1)
    found[:, 0, 2] = found[:, 1, 3] = 1.0
    return found


def corrected(registration: Registration, offset: Array) -> Array:
    """Places [N, 2] m from own ship that radar sees, without the errors, as AIS would tell them."""
    range_error, bearing_error, *gps = registration.value
    range_, bearing = to_range_bearing(offset)
    found: Array = (range_ - range_error)[:, None] * unit_vector(bearing - bearing_error)
    return found - np.array(gps)


def as_seen(registration: Registration, offset: Array) -> Array:
    """Places [N, 2] m from own ship that AIS tells, with the errors, as radar would see them."""
    range_error, bearing_error, *gps = registration.value
    range_, bearing = to_range_bearing(offset + np.array(gps))
    found: Array = (range_ + range_error)[:, None] * unit_vector(bearing + bearing_error)
    return found


def turned(registration: Registration, velocity: Array, back: bool = False) -> Array:
    """Velocities [N, 2] m/s that radar sees, without the error of bearing; back: with it again."""
    angle = -registration.value[1] if back else registration.value[1]
    cosine, sine = np.cos(angle), np.sin(angle)
    east, north = velocity.T
    return np.stack([east * cosine - north * sine, north * cosine + east * sine], -1)


def learn(
    before: Registration, seen: Array, told: Array, variance: Array, step: float
) -> Registration:
    """With the pairs that are joined, after `step` s.

    seen, told  [P, 2]  m from own ship, by radar as it is, and by AIS
    variance    [P]     m^2, of their difference, each axis
    """
    keep = np.exp(-step / MEMORY)
    information, vector = keep * before.information, keep * before.vector
    if len(seen):
        h = jacobian(told)
        start = Registration(*before)._replace(value=before.centre)
        rest = corrected(start, seen) - told
        off = np.hypot(*(corrected(before, seen) - told).T)
        sigma = np.sqrt(variance + PAIR**2)
        weight = 1 / (sigma * (1 + (off / (DOUBTED * sigma)) ** 2)) ** 2
        weight *= min(step / INDEPENDENT, 1.0)
        information = information + np.einsum('p,pij,pik->jk', weight, h, h)
        vector = vector + np.einsum('p,pij,pi->j', weight, h, rest)
    expected = VARIANCES * (FREE if before.settled else 1.0)
    covariance = np.linalg.inv(information + np.diag(1 / expected))
    # What is expected is 0 of all, not of what is left beside the centre.
    value = before.centre + covariance @ (vector - before.centre / expected)
    return before._replace(
        value=value, covariance=covariance, information=information, vector=vector, pairs=len(seen)
    )


def search(
    before: Registration,
    ship: IntArray,
    seen: Array,
    told: Array,
    variance: Array,
    worth: Array,
    step: float,
) -> Registration:
    """A look at all pairs [P] that may be, which `step` s have passed before.

    ship      [P]     which one each is of
    seen, told  [P, 2]  m from own ship, by radar and AIS
    variance  [P]     m^2, of the difference of places, each axis
    worth     [P]     log-likelihood ratio of their velocities, and of one place against any
    """
    if not len(ship):
        return before
    if len(ship) > MOST_PAIRS:  # the sharpest
        chosen = np.argsort(variance, kind='stable')[:MOST_PAIRS]
        ship, seen, told = ship[chosen], seen[chosen], told[chosen]
        variance, worth = variance[chosen], worth[chosen]
    range_, bearing = to_range_bearing(told)
    seen_range, seen_bearing = to_range_bearing(seen)
    along = (seen_range - range_)[:, None] - RANGES  # [P, R]
    across = range_[:, None] * wrap_angle((seen_bearing - bearing)[:, None] - BEARINGS)  # [P, B]
    of_along = variance + PAIR**2 + np.diff(RANGES[:2]) ** 2 / 12
    of_across = variance + PAIR**2 + (range_ * np.diff(BEARINGS[:2])) ** 2 / 12
    fit = (
        (worth - 0.5 * np.log(of_along * of_across))[:, None, None]
        - 0.5 * (across**2 / of_across[:, None])[:, :, None]
        - 0.5 * (along**2 / of_along[:, None])[:, None, :]
    )
    _, which = np.unique(ship, return_inverse=True)
    likelihood = np.ones((which.max() + 1, *fit.shape[1:]))
    np.add.at(likelihood, which, np.exp(np.minimum(fit, 50.0)))
    keep = np.exp(-step / SEARCH_MEMORY)
    gain = 1.0 - keep if before.score.any() else 1.0
    score = before.score + gain * (np.log(likelihood).sum(0) - before.score)
    looked = before.looked + step
    found = before._replace(score=score, looked=looked)
    best = _clear(score)
    if best is None:
        return found
    centre = np.array([RANGES[best[1]], BEARINGS[best[0]], 0.0, 0.0])
    # About as sure as the steps of the search are fine.
    fine = np.diag([1 / 40.0**2, 1 / np.radians(0.3) ** 2, 0.0, 0.0])
    return found._replace(
        centre=centre, value=centre, information=fine, vector=np.zeros(4), settled=True
    )


def _clear(score: Array) -> tuple[int, int] | None:
    """Where the best score is; None where another one, not beside it, is nearly as good."""
    row, column = np.unravel_index(int(score.argmax()), score.shape)
    apart: BoolArray = (np.abs(np.arange(score.shape[0]) - row) > 2)[:, None] | (
        np.abs(np.arange(score.shape[1]) - column) > 2
    )
    if score[row, column] - score[apart].max() < CLEARLY:
        return None
    return int(row), int(column)
