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


def cluster(cells: Plots, range_resolution: float, beam_width: float, place: Place) -> Clusters:
    """The clusters of one scan's cells [M]; range_resolution m, beam_width rad."""
    first, second = _links(cells, range_resolution, beam_width)
    group, crowded = _groups(first, second, place)
    _, group = np.unique(group, return_inverse=True)
    return _summary(cells, group, crowded, place, range_resolution, beam_width)


def _links(cells: Plots, range_resolution: float, beam_width: float) -> IntArray:
    """All pairs of cells that touch, [P] each, also across north."""
    if len(cells.range) < 2:
        return np.zeros((2, 0), np.int64)
    turn = TURN / (LINK * beam_width)
    places = np.column_stack(
        [
            cells.range / (LINK * range_resolution),
            np.minimum(cells.bearing * (turn / TURN), np.nextafter(turn, 0)),
        ]
    )
    tree = cKDTree(places, boxsize=[0, turn], balanced_tree=False)
    near = cKDTree(cells.position, balanced_tree=False)
    return np.concatenate(
        [
            tree.query_pairs(1.0 + 1e-9, p=np.inf, output_type='ndarray'),
            near.query_pairs(GAP, output_type='ndarray'),
        ]
    ).T


def in_gates(cells: Plots, gates: Gates) -> Place:
    """Where the cells [M] lie among the gates. `land` is False for all."""
    dry = np.zeros(len(cells.time), bool)
    if not len(gates.time):
        return Place(np.full(len(dry), -1), np.full(len(dry), np.inf), dry)
    later = cells.time - gates.time[:, None]
    offset = (
        cells.position - gates.middle[:, None] - later[..., None] * gates.velocity[:, None]
    )  # [H, M, 2]
    inverse, _ = invert_2x2(gates.area)
    depth = squared_distance(offset, inverse[:, None])
    nearest = depth.argmin(0)
    every = np.arange(len(nearest))
    return Place(
        np.where(depth[nearest, every] <= 1, nearest, -1), np.hypot(*offset[nearest, every].T), dry
    )


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
