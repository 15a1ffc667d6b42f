"""Groups cells that touch into clusters. A cluster is one target, several close together, or land.

Two cells touch if they lie within LINK cells of each other in range and in bearing. They also touch
if they lie within GAP, because fine cells separate the parts of a ship. The gates of tracked
targets, where hulls are expected, come first: a cell inside a gate belongs to it, whatever it
touches. So a hull that breaks up stays one cluster, ships side by side stay two, and a ship that
passes close to land is not merged with it.
"""

from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ..gaussian.linear import invert_2x2, squared_distance
from ..types import Array, BoolArray, IntArray, Plots, take
from .smear import smear

LINK = 1.5  # range resolutions, and beam widths
GAP = 40.0  # m
TURN = 2 * np.pi
REACH = 225.0  # m from a hull's middle; touching cells up to here still belong to the hull
LINKS = 500_000  # pairs of cells that touch; where there are more, not all are listed
AT_ONCE = 1_000_000  # pairs of a gate and a cell that are looked at together

Number = TypeVar('Number', np.float64, np.int64, np.bool_)


class Gates(NamedTuple):
    """Where H hulls are expected in this scan: p' area^-1 p <= 1 about the middle.

    time      [H]        s
    middle    [H, 2]     m, at that time
    velocity  [H, 2]     m/s
    area      [H, 2, 2]  m^2
    """

    time: Array
    middle: Array
    velocity: Array
    area: Array


class Clusters(NamedTuple):
    """C clusters; `of_cell` [M] is the cluster of each cell.

    time       [C]        s, mean over the cells
    position   [C, 2]     m, east and north: the centroid
    scatter    [C, 2, 2]  m^2, sum over the cells of d d' with d from the centroid
    cells      [C]        number of cells
    noise      [C, 2, 2]  m^2, R of a single cell
    size       [C]        m, between the farthest cells along the longer of two axes
    amplitude  [C]        dB, of the strongest cell
    gate       [C]        the hull whose gate it belongs to, -1 for none
    crowded    [C]        it touches another cluster, so its cells may not be its own
    land       [C]        most of its cells lie on land
    """

    time: Array
    position: Array
    scatter: Array
    cells: IntArray
    noise: Array
    size: Array
    amplitude: Array
    gate: IntArray
    crowded: BoolArray
    land: BoolArray
    of_cell: IntArray


NOTHING = Clusters(
    time=np.zeros(1),
    position=np.zeros((1, 2)),
    scatter=np.zeros((1, 2, 2)),
    cells=np.ones(1, np.int64),
    noise=np.eye(2)[None],
    size=np.zeros(1),
    amplitude=np.zeros(1),
    gate=np.full(1, -1),
    crowded=np.zeros(1, bool),
    land=np.zeros(1, bool),
    of_cell=np.zeros(0, np.int64),
)


class Place(NamedTuple):
    """Where M cells lie.

    gate [M]: the hull whose gate the cell is in, -1 for none; off [M] m from the middle of that
    hull, or of the nearest; land [M]: the cell is on land.
    """

    gate: IntArray
    off: Array
    land: BoolArray


def cluster(
    cells: Plots, range_resolution: float, beam_width: float, place: Place
) -> tuple[Clusters, int]:
    """The clusters of one scan's cells [M]; range_resolution m, beam_width rad. And how many pairs
    of cells were not compared (see `_touching`)."""
    first, second, left_out = _links(cells, range_resolution, beam_width, place.gate)
    group, crowded = _groups(first, second, place)
    _, group = np.unique(group, return_inverse=True)
    return _summary(cells, group, crowded, place, range_resolution, beam_width), left_out


def _links(
    cells: Plots, range_resolution: float, beam_width: float, gate: IntArray
) -> tuple[IntArray, IntArray, int]:
    """Pairs of cells that touch, [P] each, also across north; and how many more there were."""
    if len(cells.range) < 2:
        return *np.zeros((2, 0), np.int64), 0
    turn = TURN / (LINK * beam_width)
    places = np.column_stack(
        [
            cells.range / (LINK * range_resolution),
            np.minimum(cells.bearing * (turn / TURN), np.nextafter(turn, 0)),
        ]
    )
    boxes, of_boxes = _touching(places, 1.0 + 1e-9, np.inf, [0, turn], gate)
    near, of_near = _touching(cells.position, GAP, 2, None, gate)
    return *np.concatenate([boxes, near]).T, of_boxes + of_near


def _touching(
    places: Array, reach: float, norm: float, turn: list[float] | None, gate: IntArray
) -> tuple[IntArray, int]:
    """Pairs [P, 2] of the places [M, 2] within reach of each other; how many more there were.

    More than LINKS are not listed. Then places are put into squares an eighth of the reach wide, of
    each gate [M] those of its own. All places in a square touch; of each square one, the first,
    is compared with those of other squares.
    """
    tree, count = cKDTree(places, boxsize=turn, balanced_tree=False), len(places)
    if count * (count - 1) <= 2 * LINKS:
        return tree.query_pairs(reach, p=norm, output_type='ndarray'), 0
    every = (tree.count_neighbors(tree, reach, p=norm) - count) // 2
    if every <= LINKS:
        return tree.query_pairs(reach, p=norm, output_type='ndarray'), 0
    square = np.floor(places * (8 / reach)).astype(np.int64)
    square = np.column_stack([gate, square])
    _, first, of = np.unique(square, axis=0, return_index=True, return_inverse=True)
    own = np.column_stack([first[of.reshape(-1)], np.arange(count)])
    tree = cKDTree(places[first], boxsize=turn, balanced_tree=False)
    pairs = np.concatenate([own, first[tree.query_pairs(reach, p=norm, output_type='ndarray')]])
    return pairs, int(every - len(pairs))


def in_gates(cells: Plots, gates: Gates) -> Place:
    """Where the cells [M] lie among the gates. `land` is False for all."""
    dry = np.zeros(len(cells.time), bool)
    if not len(gates.time):
        return Place(np.full(len(dry), -1), np.full(len(dry), np.inf), dry)
    inverse, _ = invert_2x2(gates.area)
    parts = np.array_split(np.arange(len(dry)), 1 + len(gates.time) * len(dry) // AT_ONCE)
    gate, off = zip(*(_nearest_gate(take(cells, rows), gates, inverse) for rows in parts))
    return Place(np.concatenate(gate), np.concatenate(off), dry)


def _nearest_gate(cells: Plots, gates: Gates, inverse: Array) -> tuple[IntArray, Array]:
    """The gate that each of M cells is in, or -1; m from the middle of that, or of the nearest."""
    later = cells.time - gates.time[:, None]
    offset = (
        cells.position - gates.middle[:, None] - later[..., None] * gates.velocity[:, None]
    )  # [H, M, 2]
    depth = squared_distance(offset, inverse[:, None])
    nearest = depth.argmin(0)
    every = np.arange(len(nearest))
    return (np.where(depth[nearest, every] <= 1, nearest, -1), np.hypot(*offset[nearest, every].T))


def _groups(first: IntArray, second: IntArray, place: Place) -> tuple[IntArray, BoolArray]:
    """A label [M] of each cell's cluster, and whether [M] that cluster touches another one.

    Cells in one gate are one cluster. Cells outside belong to a hull too if they touch only its
    gate, are not land and do not reach too far.
    """
    gate, count = place.gate, len(place.gate)
    same = gate[first] == gate[second]
    hulls = (gate >= 0).nonzero()[0]
    pairs = (
        np.concatenate([first[same], hulls]),
        np.concatenate([second[same], count + gate[hulls]]),
    )
    graph = coo_array(
        (np.ones(len(pairs[0]), np.int8), pairs), shape=(count + gate.max(initial=-1) + 1,) * 2
    )
    group = connected_components(graph, directed=False)[1]
    crowded = np.zeros(len(group), bool)
    if same.all():
        return group[:count], crowded[:count]
    one, other = first[~same], second[~same]
    swap = gate[one] < 0
    one, other = np.where(swap, other, one), np.where(swap, one, other)  # let `one` be in a gate
    hull, part = group[one], group[other]
    reach = np.zeros(len(group))
    np.maximum.at(reach, group[:count], place.off)
    reach[_mostly(place.land, group[:count], len(group))] = np.inf
    owner, rivals = np.full(len(group), -1), np.zeros(len(group), bool)
    owner[part] = hull
    rivals[part[owner[part] != hull]] = True
    joins = (gate[other] < 0) & ~rivals[part] & (reach[part] <= REACH)
    new = np.arange(len(group))
    new[part[joins]] = hull[joins]
    crowded[hull[~joins]] = crowded[part[~joins]] = True
    group = new[group[:count]]
    return group, crowded[group]


def _mostly(land: BoolArray, group: IntArray, groups: int) -> BoolArray:
    """The groups of which more than half the cells are land."""
    return np.bincount(group, land, groups) > 0.5 * np.bincount(group, minlength=groups)


def _summary(
    cells: Plots,
    group: IntArray,
    crowded: BoolArray,
    place: Place,
    range_resolution: float,
    beam_width: float,
) -> Clusters:
    clusters = int(group.max(initial=-1)) + 1
    count = np.bincount(group, minlength=clusters)

    def mean(values: Array) -> Array:
        return np.bincount(group, values, clusters) / count

    def most(values: NDArray[Number], start: Number | float) -> NDArray[Number]:
        out = np.full(clusters, start, values.dtype)
        np.maximum.at(out, group, values)
        return out

    position = np.column_stack([mean(column) for column in cells.position.T])
    off = cells.position - position[group]
    scatter = np.empty((clusters, 2, 2))
    for i, j in ((0, 0), (0, 1), (1, 1)):
        scatter[:, i, j] = scatter[:, j, i] = np.bincount(group, off[:, i] * off[:, j], clusters)
    half = 0.5 * np.arctan2(2 * scatter[:, 0, 1], scatter[:, 1, 1] - scatter[:, 0, 0])
    along = off[:, 0] * np.sin(half)[group] + off[:, 1] * np.cos(half)[group]
    sin, cos = (mean(f(cells.bearing)) for f in (np.sin, np.cos))
    return Clusters(
        mean(cells.time),
        position,
        scatter,
        count,
        smear(mean(cells.range), np.arctan2(sin, cos), range_resolution, beam_width),
        most(along, -np.inf) + most(-along, -np.inf),
        most(cells.amplitude, -np.inf),
        most(place.gate, -1),
        most(crowded, False),
        _mostly(place.land, group, clusters),
        group,
    )


def take_clusters(clusters: Clusters, rows: IntArray) -> Clusters:
    """The chosen clusters; of_cell is left as it is."""
    return take(clusters._replace(of_cell=clusters.cells), rows)._replace(of_cell=clusters.of_cell)
