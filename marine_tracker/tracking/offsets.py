"""What is wrong with a radar's plots, as things that are known show: offsets and a time lag.

A plot of a thing at range r and bearing b, stamped t, tells r + range offset and b + bearing
offset of the time t - lag. To first order

    told - expected at t  =  range offset - lag dr/dt        dr/dt, db/dt: of the expected ones
    told - expected at t  =  bearing offset - lag db/dt

so they come out of a weighted least-squares fit over many plots. A reference says what is expected:
an AIS report, or a mark with a known position. A place where plots always are (places.py) does so
too, but its position is fitted along with the rest. Then much cannot be known: seen from a ship at
rest, nothing; from a ship on a steady course the lag looks like another position. What the plots do
not tell has a large deviation, and is not told.

A wrong compass is a bearing offset, too.
"""

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from .. import yaml_file
from ..files import shown
from ..geometry import own_ship_at, to_range_bearing, wrap_angle
from ..parameters import TrackerParameters
from ..types import Array, BoolArray, IntArray, Scan, append, row_of, take
from .places import WANDER, Places, nearest

MEMORY = 600  # revolutions
PRIOR = np.array([300.0, np.radians(30.0), 30.0])  # m, rad, s: deviations before any plot
KNOWN = np.array([2.5, np.radians(0.04), 0.05])  # m, rad, s: deviations from which on it is told
LEAST_PLOTS = 20
NEAR = 150.0  # m; so far a place may seem to lie from its known position
NOT_KNOWN = 'not known'
NAMES = ('range offset_m', 'bearing offset_deg', 'plot lag_s')


class Compared(NamedTuple):
    """K plots and what was expected of them.

    off         [K, 2]     m and rad, told less expected range and bearing
    rate        [K, 2]     m/s and rad/s, of the expected ones. Where the radar counts bearings from
                           the bow, the bearing's is that from the bow
    covariance  [K, 2, 2]  m and rad, of both together
    """

    off: Array
    rate: Array
    covariance: Array


class Marks(NamedTuple):
    """J places whose positions are fitted along: their parts of the normal equations.

    number    [J]        of the place, ascending
    position  [J, 2]     m, where it was first thought to be; the shift from there is fitted
    own       [J, 2, 2]  of the shift
    cross     [J, 3, 2]  of the offsets with the shift
    right     [J, 2]
    """

    number: IntArray
    position: Array
    own: Array
    cross: Array
    right: Array


class Offsets(NamedTuple):
    """The memory: normal equations of [range offset m, bearing offset rad, lag s].

    normal [3, 3], right [3], squares (weighted, of what is told less expected), values (number of)
    marks    those that are fitted along
    applied  [3] what is taken off the plots before they are tracked
    """

    normal: Array
    right: Array
    squares: float
    values: float
    marks: Marks
    applied: Array


class Estimate(NamedTuple):
    """value [3] m, rad, s; sigma [3] their deviations; known [3] whether that is small enough."""

    value: Array
    sigma: Array
    known: BoolArray


def marks_of(text: str) -> Array:
    """Known positions [Q, 2] m, east and north, of the parameter `known_marks`: a YAML list of
    [north, east]. ValueError names what is no such list."""
    items = yaml_file.parse(text, 'parameter known_marks') or []
    try:
        found = np.array(items, dtype=float).reshape(len(items), 2)
    except (TypeError, ValueError):
        found = np.full((1, 2), np.nan)
    if not np.isfinite(found).all():
        raise ValueError(
            f'parameter known_marks is {shown(items)}; it must be a list of [north_m, east_m]'
        )
    return found[:, ::-1]


def begin() -> Offsets:
    """Nothing is known."""
    none = np.zeros((0, 2))
    marks = Marks(
        np.zeros(0, np.int64), none, np.zeros((0, 2, 2)), np.zeros((0, 3, 2)), none.copy()
    )
    return Offsets(np.zeros((3, 3)), np.zeros(3), 0.0, 0.0, marks, np.zeros(3))


def refer(before: Offsets, seen: Compared) -> Offsets:
    """With K plots of which it is known what was to be expected, as from AIS reports."""
    weight, design = np.linalg.inv(seen.covariance), _design(seen.rate)
    turned = design.transpose(0, 2, 1) @ weight
    return before._replace(
        normal=before.normal + (turned @ design).sum(0),
        right=before.right + (turned @ seen.off[..., None]).sum((0, 2)),
        squares=before.squares + float(np.einsum('ki,kij,kj', seen.off, weight, seen.off)),
        values=before.values + 2.0 * len(seen.off),
    )


def refer_to_places(
    before: Offsets, seen: Compared, position: Array, origin: Array, number: IntArray
) -> Offsets:
    """With K plots of places whose positions are not known.

    seen    as if they were at `position` [K, 2] m, where the marks have them; of a new mark where
            it is thought to be
    origin  [K, 2] m, of the antenna
    number  [K] of the place
    """
    marks, (new, first) = before.marks, np.unique(number, return_index=True)
    fresh = ~np.isin(new, marks.number)
    zero = np.zeros((int(fresh.sum()), 3, 2))
    marks = append(marks, Marks(new[fresh], position[first[fresh]], zero[:, :2], zero, zero[:, 0]))
    marks = take(marks, marks.number.argsort())
    design, shift = _design(seen.rate), _shift(position - origin)
    turned = shift.transpose(0, 2, 1) @ np.linalg.inv(seen.covariance)
    row = row_of(marks.number, number)
    np.add.at(marks.own, row, turned @ shift)
    np.add.at(marks.cross, row, (turned @ design).transpose(0, 2, 1))
    np.add.at(marks.right, row, (turned @ seen.off[..., None])[..., 0])
    return refer(before, seen)._replace(marks=marks)


def estimate(known: Offsets) -> Estimate:
    """What the plots tell. The scatter about the fit counts where it is wider than was thought."""
    normal, right, squares, values = _without_marks(known)
    covariance = np.linalg.inv(normal + np.diag(PRIOR**-2.0))
    value = covariance @ right
    free = values - 3
    wider = max(1.0, (squares - float(right @ value)) / free) if free > 0 else 1.0
    sigma = np.sqrt(wider * np.diag(covariance))
    return Estimate(value, sigma, (sigma <= KNOWN) & (free >= 2 * LEAST_PLOTS))


def rates(scan: Scan, time: Array, radar: TrackerParameters) -> Array:
    """Velocity of the antenna, m/s east and north, and turn, rad/s, of where bearings count from
    [K, 3], at the times [K] s. North does not turn; nor does a bow of which no heading is known."""
    own = scan.measured_from
    found = np.zeros((len(time), 3))
    found[:, :2] = own_ship_at(own, time)[1]
    if radar.bearings == 'bow' and own.heading is not None and len(own.time) > 1:
        turn = np.diff(np.unwrap(own.heading)) / np.maximum(np.diff(own.time), 1e-3)
        among = np.clip(own.time.searchsorted(time) - 1, 0, len(turn) - 1)
        found[:, 2] = np.nan_to_num(turn[among])
    return found


def learn(
    before: Offsets,
    there: Places,
    position: Array,
    variance: Array,
    told: tuple[Array, ...],
    radar: TrackerParameters,
    marks: Array,
) -> Offsets:
    """The memory after a revolution.

    there     all places; those with a number count
    position  [M, 2] m, variance [M] m^2, of the plots that no moving track took
    told      of those: range m, bearing rad, origin [M, 2] m, `rates` [M, 3]; after `applied`
    marks     [Q, 2] m, east and north, known positions: the place nearest to each lies there
    """
    named = (there.number > 0).nonzero()[0]
    numbers, places = there.number[named], there.position[named]
    sure = np.full(len(named), -1)
    if len(marks) and len(sure):
        apart, place = cKDTree(places).query(marks)
        near = (apart < NEAR).nonzero()[0]
        sure[place[near]] = near
    row = nearest(places, position, variance)
    at = (row >= 0).nonzero()[0]
    row = row[at]
    if len(at):
        columns = tuple(column[at] for column in told)
        number, fitted = numbers[row], before.marks
        known, mark = row_of(fitted.number, number), sure[row]
        place = places[row]
        place = _instead(_instead(place, fitted.position, known), marks, mark)
        plots = _compared(before.applied, place, columns, radar)
        before = refer(before, take(plots, mark >= 0))
        others, origin = mark < 0, columns[2]
        before = refer_to_places(
            before, take(plots, others), place[others], origin[others], number[others]
        )
        numbers = numbers[sure < 0]
    return _later(before, numbers, radar.correct_plots)


def _instead(position: Array, others: Array, row: IntArray) -> Array:
    """position [K, 2], or the row [K] of the others [., 2] where it is not -1."""
    return np.where((row >= 0)[:, None], np.append(others, [[0, 0]], 0)[row], position)


def _compared(
    applied: Array, position: Array, told: tuple[Array, ...], radar: TrackerParameters
) -> Compared:
    """K plots, told as for `learn`, and what is expected of things that rest at `position` m."""
    range_, bearing, origin, rate = told
    away = position - origin
    distance, expected = to_range_bearing(away)
    distance = np.maximum(distance, 1.0)
    along = away / distance[:, None]
    across = np.stack([along[:, 1], -along[:, 0]], 1)
    drop, turn = -(rate[:, :2] * along).sum(1), -(rate[:, :2] * across).sum(1) / distance
    rates = np.stack([drop, turn - rate[:, 2]], 1)
    off = np.stack([range_ - distance, wrap_angle(bearing - expected)], 1)
    off += _design(rates) @ applied  # as the radar told them
    covariance = np.zeros((len(distance), 2, 2))
    covariance[:, 0, 0] = radar.range_sigma_m**2 + WANDER**2
    covariance[:, 1, 1] = np.radians(radar.bearing_sigma_deg) ** 2 + (WANDER / distance) ** 2
    return Compared(off, rates, covariance)


def _later(before: Offsets, numbers: IntArray, apply: bool) -> Offsets:
    """Older plots count less; of marks that are no place any more (numbers [.] of those that are)
    only what they told is kept.

    apply  whether what is known is to be taken off the plots. It changes in steps, when it differs
           by more than its deviation.
    """
    marks, (normal, right, squares, values) = before.marks, before[:4]
    if len(marks.number):
        gone = ~np.isin(marks.number, numbers)
        normal, right, squares, values = _without_marks(before._replace(marks=take(marks, gone)))
        marks = take(marks, ~gone)
    keeps = 1 - 1 / MEMORY
    after = Offsets(
        keeps * normal,
        keeps * right,
        keeps * squares,
        keeps * values,
        marks._replace(own=keeps * marks.own, cross=keeps * marks.cross, right=keeps * marks.right),
        before.applied,
    )
    if not apply:
        return after._replace(applied=np.zeros(3)) if before.applied.any() else after
    found = estimate(after)
    moved = found.known & (np.abs(found.value - before.applied) > found.sigma)
    return after._replace(applied=np.where(moved, found.value, before.applied))


def corrected(scan: Scan, applied: Array) -> Scan:
    """The scan without the offsets and the lag `applied` [3] m, rad, s."""
    if not applied.any():
        return scan
    range_offset, bearing_offset, lag = (float(one) for one in applied)
    plots = scan.plots._replace(
        time=scan.plots.time - lag,
        range=np.maximum(scan.plots.range - range_offset, 0.0),
        bearing=np.mod(scan.plots.bearing - bearing_offset, 2 * np.pi),
    )
    sector = scan.sector
    if sector is not None:
        sector = sector._replace(bearing=sector.bearing - bearing_offset)
    return scan._replace(start=scan.start - lag, end=scan.end - lag, plots=plots, sector=sector)


def in_words(known: Offsets) -> dict[str, str]:
    """The estimates with their deviations, by name; 'not known' where the plots do not tell."""
    found = estimate(known)
    units = np.array([1.0, np.degrees(1.0), 1.0])
    rows = zip(NAMES, units * found.value, units * found.sigma, found.known, (1, 2, 2), strict=True)
    return {
        name: f'{value:+.{digits}f} +- {sigma:.{digits}f}' if sure else NOT_KNOWN
        for name, value, sigma, sure, digits in rows
    }


def _design(rate: Array) -> Array:
    """[K, 2, 3]: what the offsets and the lag do to range and bearing."""
    design = np.zeros((len(rate), 2, 3))
    design[:, [0, 1], [0, 1]] = 1.0
    design[:, :, 2] = -rate
    return design


def _shift(away: Array) -> Array:
    """[K, 2, 2]: what a shift of a mark, m east and north, does to range and bearing."""
    distance = np.maximum(np.hypot(*away.T), 1.0)[:, None]
    along = away / distance
    across = np.stack([along[:, 1], -along[:, 0]], 1) / distance
    return np.stack([along, across], 1)


def _without_marks(known: Offsets) -> tuple[Array, Array, float, float]:
    """The normal equations once the marks' shifts are fitted."""
    marks = known.marks
    if not len(marks.number):
        return known.normal, known.right, known.squares, known.values
    # A mark seen from one direction with little noise across: the prior keeps it solvable.
    own = marks.own + 1e-6 * np.eye(2)
    turned = marks.cross @ np.linalg.inv(own)
    normal = known.normal - (turned @ marks.cross.transpose(0, 2, 1)).sum(0)
    right = known.right - (turned @ marks.right[..., None]).sum((0, 2))
    fitted = np.einsum('ji,jik,jk', marks.right, np.linalg.inv(own), marks.right)
    return normal, right, known.squares - float(fitted), known.values - 2.0 * len(marks.number)
