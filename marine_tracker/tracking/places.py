"""Places where plots always are: a slowly learnt map, fixed to the ground.

A quay, a mark, a moored craft gives a plot in many revolutions, always at the same place. Each such
place is a row of the map: the mean of its plots, the share of revolutions with one, and a straight
line through them in time. It is established when it had plots often enough, for long enough, and
the line says that it surely does not move. So a slow ship far away, whose plots scatter widely,
needs longer than a quay close by, and never becomes a place.

Clutter gives plots everywhere. So the same count is kept of eight neighbours of each place, as
wide as its gate: that is what chance gives there. A place must have plots so much more often that
of the hundreds of thousands of tries in an hour none does by chance. Among dense clutter it takes
longer, and what shows no more often than the clutter around it never becomes a place.

Plots of tracks that have moved are not learnt from, so a ship under way leaves nothing behind.
"""

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree
from scipy.special import rel_entr

from ..types import Array, BoolArray, IntArray, append, put, some, take

GATE = 9.0  # squared deviations within which a plot belongs to a place
WANDER = 4.0  # m, each axis: a thing on the ground echoes here and there
MEMORY, SHORT = 60, 15  # revolutions
LEAST_LOOKS, LEAST_PLOTS = 15, 8
BECOMES, ENDS = 0.3, 0.1  # share of revolutions with a plot
AT_REST = 0.8  # m/s; a place surely moves less
TRIAL = 6  # revolutions without a plot after which a place that is not established is forgotten
MOST = 20_000  # rows
SURE = 16.0  # log-likelihood ratio against chance: exceeded once in some 100 million tries
TRIED = 4  # plots of a place whose neighbours are counted, half of them in each revolution
SOON = 20.0  # times AT_REST: with so uncertain a motion a place is not established before long
APART = 2.2  # times the gate's radius, from a place to its neighbours
_ANGLES = np.arange(8) * (np.pi / 4)
_AROUND = APART * np.stack([np.cos(_ANGLES), np.sin(_ANGLES)], 1).reshape(4, 2, 2).swapaxes(0, 1)
UNNAMED = -1
NEAR, CROWD = 1000.0, 4  # m; so many places within it, itself among them, are a crowd


class Places(NamedTuple):
    """P places, or what may become one.

    position  [P, 2]  m, east and north, the mean
    variance  [P]     m^2, of a plot there, the larger axis
    share     [P]     of the last MEMORY revolutions with a plot
    lately    [P]     the same of the last SHORT: a slow ship that has gone on is no place
    looks     [P]     revolutions
    chance    [P]     mean share of its neighbours, over the last MEMORY revolutions, and
    tried     [P]     revolutions in which they were counted
    idle      [P]     revolutions since the last plot
    plots     [P]     number of plots, older ones count less
    time      [P]     s, mean of their times; spread [P] s^2, sum of the squares about it
    slope     [P, 2]  m s, sum of the products of time and position about their means
    number    [P]     target number of an established place; 0 before, UNNAMED at first
    crowded   [P]     others are established near by, as along a quay
    """

    position: Array
    variance: Array
    share: Array
    lately: Array
    looks: IntArray
    chance: Array
    tried: IntArray
    idle: IntArray
    plots: Array
    time: Array
    spread: Array
    slope: Array
    number: IntArray
    crowded: BoolArray

    @property
    def established(self) -> BoolArray:
        """Mask [P] of the places that are sure."""
        found: BoolArray = self.number != 0
        return found


class _Means(NamedTuple):
    """What of the places is a mean, or a sum, over their plots."""

    position: Array
    variance: Array
    plots: Array
    time: Array
    spread: Array
    slope: Array


def empty() -> Places:
    """Nothing is known."""
    none, count = np.zeros(0), np.zeros(0, np.int64)
    pairs = np.zeros((0, 2))
    return Places(
        *(pairs, none, none, none, count, none, count, count),
        *(none, none, none, pairs, count, count > 0),
    )


def nearest(places: Array, position: Array, variance: Array) -> IntArray:
    """Row [M] of the nearest of the places [P, 2] m of each position [M, 2] m, of variance [M] m^2
    each axis; -1 where none is near enough."""
    if not len(places) or not len(position):
        return np.full(len(position), -1)
    reach = np.sqrt(GATE * (variance + WANDER**2))
    # A tree that is quickly made: it is asked once.
    tree = cKDTree(places, compact_nodes=False, balanced_tree=False)
    distance, row = tree.query(position, distance_upper_bound=float(reach.max()) + 1.0)
    return np.where(distance <= reach, row, -1)


class View(NamedTuple):
    """What the radar sees: from the origin [2] m, ranges from `near` to `far` m."""

    origin: Array
    near: float
    far: float

    def of(self, position: Array) -> BoolArray:
        """Mask [...] of the positions [..., 2] m that it sees."""
        apart = position - self.origin
        distance = np.hypot(apart[..., 0], apart[..., 1])
        found: BoolArray = (distance >= self.near) & (distance <= self.far)
        return found


def learn(before: Places, position: Array, variance: Array, time: Array, view: View) -> Places:
    """The map after one revolution.

    position [M, 2] m, variance [M] m^2, time [M] s: of the plots that no moving track took

    A place takes the nearest of the plots in its gate; the others there are of no other place.
    """
    row = nearest(before.position, position, variance)
    first = _nearest_of_each(before.position, row, position)
    hit, established = row[first], before.established
    visible = view.of(before.position)
    after = _looked(before, hit, visible)
    after = _with_plots(after, hit, position[first], variance[first], time[first])
    after = _by_chance(after, visible, position[~np.append(established, False)[row]], view)
    keep = (after.idle < TRIAL) | established | ((after.plots >= 3) & (after.share >= ENDS))
    if np.count_nonzero(established):
        no_more = after.share < np.maximum(ENDS, after.chance)
        keep &= ~(established & no_more & (after.looks > LEAST_LOOKS))
    new = (row < 0).nonzero()[0]
    after = some(after, keep)
    if len(new):
        after = append(after, _new(position[new], variance[new], time[new]))
    if len(after.share) > MOST:
        after = take(after, slice(0, MOST))
    sure = (after.looks >= LEAST_LOOKS) & (after.plots >= LEAST_PLOTS) & (after.number == 0)
    sure &= (np.minimum(after.share, after.lately) >= BECOMES) & _at_rest(after)
    number, rows = after.number, sure.nonzero()[0]
    if len(rows):
        number = number.copy()
        number[rows[surplus(take(after, rows)) > SURE]] = UNNAMED
    return after._replace(number=number, crowded=_crowded(after.position, number != 0))


def _nearest_of_each(places: Array, row: IntArray, position: Array) -> IntArray:
    """Of the plots at position [M, 2] m the nearest one of each place, in the order of the places
    [P, 2] m; row [M] of the place of each plot, -1 for none."""
    known = (row >= 0).nonzero()[0]
    east, north = (position[known] - places[row[known]]).T
    known = known[(east * east + north * north).argsort(kind='stable')[::-1]]
    plot = np.full(len(places), -1)
    plot[row[known]] = known  # of several the last, which is the nearest
    found: IntArray = plot[plot >= 0]
    return found


def surplus(places: Places) -> Array:
    """Log-likelihood ratio [P]: the place has plots more often than its neighbours, against all
    have them as often; of two binomial samples. 0 where it has them less often.

    The plot that a place began with does not count.
    """
    looks = np.maximum(np.minimum(places.looks, MEMORY) - 1.0, 1.0)
    around = _AROUND.shape[1] * np.minimum(np.maximum(places.tried, 1), MEMORY)
    hits = np.maximum(places.share * (looks + 1) - 1, 0)
    share = hits / looks
    pooled = (hits + around * places.chance) / (looks + around)
    found: Array = np.where(
        share > places.chance,
        looks * _divergence(share, pooled) + around * _divergence(places.chance, pooled),
        0.0,
    )
    return found


def _divergence(p: Array, q: Array) -> Array:
    """Of a coin that shows heads in a share p [P] from one with q [P] (Kullback and Leibler)."""
    found: Array = rel_entr(p, q) + rel_entr(1 - p, 1 - q)
    return found


def _by_chance(places: Places, visible: BoolArray, plots: Array, view: View) -> Places:
    """The share of plots [K, 2] m in the neighbours of the places, counted for one revolution.

    It is not counted where the place surely moves, or will not be known to rest before long.
    """
    rows = (visible & (places.plots >= TRIED) & _may_rest(places)).nonzero()[0]
    if not len(rows):
        return places
    reach = np.sqrt(GATE * (places.variance[rows] + WANDER**2))
    around = places.position[rows, None] + reach[:, None, None] * _AROUND[places.tried[rows] % 2]
    counted = view.of(around)
    hit = np.zeros(counted.shape, bool)
    if len(plots):
        tree = cKDTree(plots, compact_nodes=False, balanced_tree=False)
        hit = tree.query(around, distance_upper_bound=float(reach.max()))[0] <= reach[:, None]
    share = (hit & counted).sum(1) / np.maximum(counted.sum(1), 1)
    chance, tried = places.chance.copy(), places.tried.copy()
    tried[rows] += 1
    chance[rows] += (share - chance[rows]) / np.minimum(tried[rows], MEMORY)
    return places._replace(chance=chance, tried=tried)


def _looked(places: Places, hit: IntArray, visible: BoolArray) -> Places:
    """One revolution counted for the places that are visible or were hit."""
    seen = np.zeros(len(places.share), bool)
    seen[hit] = True
    counted = visible | seen
    looks = places.looks + counted
    gain = counted / np.minimum(np.maximum(looks, 1), MEMORY)
    quick = counted / np.minimum(np.maximum(looks, 1), SHORT)
    return places._replace(
        share=places.share + gain * (seen - places.share),
        lately=places.lately + quick * (seen - places.lately),
        looks=looks,
        idle=np.where(seen, 0, places.idle + counted),
    )


def _with_plots(places: Places, row: IntArray, at: Array, variance: Array, time: Array) -> Places:
    """One more plot for each of the rows [K], by the recursion of means and sums of squares."""
    keeps = 1 - 1 / MEMORY  # what older plots count for
    means = _Means(*(getattr(places, name) for name in _Means._fields))
    before = take(means, row)
    old = keeps * before.plots
    count = old + 1
    late, off = time - before.time, at - before.position
    now = _Means(
        before.position + off / count[:, None],
        before.variance + (variance - before.variance) / count,
        count,
        before.time + late / count,
        keeps * before.spread + late**2 * old / count,
        keeps * before.slope + (late * old / count)[:, None] * off,
    )
    return places._replace(**put(means, row, now)._asdict())


def _new(position: Array, variance: Array, time: Array) -> Places:
    """What may become places, of one plot each."""
    count = len(time)
    none, one = np.zeros(count), np.ones(count)
    whole = np.ones(count, np.int64)
    return Places(
        position,
        variance,
        one,
        one,
        whole,
        none,
        0 * whole,
        0 * whole,
        one,
        time,
        none,
        np.zeros((count, 2)),
        0 * whole,
        whole > 1,
    )


def _crowded(position: Array, established: BoolArray) -> BoolArray:
    """Mask [P] of the established places that have enough others near by."""
    found = np.zeros(len(established), bool)
    rows = established.nonzero()[0]
    if len(rows) >= CROWD:
        tree = cKDTree(position[rows])
        found[rows] = tree.query_ball_point(position[rows], NEAR, return_length=True) >= CROWD
    return found


def _motion(places: Places) -> tuple[Array, Array]:
    """m/s [P], how fast they move, and three deviations of that, by the slope of their lines."""
    spread = np.maximum(places.spread, 1e-9)
    speed = np.hypot(*places.slope.T) / spread
    sigma = np.sqrt((places.variance + WANDER**2) / spread)
    return speed, 3 * sigma


def _at_rest(places: Places) -> BoolArray:
    """Mask [P] of those that surely move less than AT_REST."""
    speed, unsure = _motion(places)
    found: BoolArray = speed + unsure < AT_REST
    return found


def _may_rest(places: Places) -> BoolArray:
    """Mask [P] of those that do not surely move, and of which it may be known before long."""
    speed, unsure = _motion(places)
    found: BoolArray = (speed - unsure < AT_REST) & (unsure < SOON * AT_REST)
    return found
