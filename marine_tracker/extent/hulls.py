"""Length, beam and heading of the tracked targets: first by random matrix, later by an outline.

There is one row for each target. The point tracker decides where targets are and which cluster
belongs to which. A row starts with a random matrix. It changes to a Gaussian-process outline when
SCANS clusters with CELLS cells on average have come, and the smear is small compared with the beam.
It changes back if the outline contradicts the course or its cells. A scan without a cluster, or
with one that touches another, leaves size and outline unchanged.
"""

from typing import NamedTuple

import numpy as np

from ..estimators.contract import Velocity
from ..gaussian.linear import invert_2x2, squared_distance
from ..geometry import unit_vector
from ..types import Array, BoolArray, CodeArray, Extrapolation, IntArray, append, put, take, where
from . import gaussian_process, outline_measures, random_matrix
from .clustering import NOTHING, Clusters, take_clusters
from .gaussian_process import HEADING, GpState
from .lit_edge import FRINGE, Edge
from .random_matrix import BOX_SPREAD, NO_MEMORY, RandomMatrixState
from .ship_outline import SHIP, SLENDER, from_random_matrix, off_course

BY_RANDOM_MATRIX, BY_GAUSSIAN_PROCESS = 0, 1  # methods
SCANS, CELLS, SMEAR = 10, 10.0, 0.4  # for an outline: scans; mean cells; smear over half beam
OFF_COURSE = np.radians(15)  # between outline's heading and course; above this the heading is wrong
NIS = 3.0  # mean nu^2 / S of an outline's cells; above this they contradict it
EDGE_CELLS = 6  # cells of the lit edge that an outline needs to start
RECENT = 5.0  # scans, memory of the means of cells and NIS
FIRST_WEIGHT = 6.0  # of a random matrix's first cluster
LOST_TOUCH = 16.0  # squared distance of a random matrix from its track; above it is reset
SLOW = 1.0  # m/s; at a lower speed the course says little about the heading


class Hulls(NamedTuple):
    """The memory of N targets.

    id       [N]  of the track
    matrix   N rows
    outline  N rows, without meaning where the method is RANDOM_MATRIX; None if not asked for
    method   [N]  RANDOM_MATRIX or OUTLINE
    scans    [N]  clusters since the start, or since an outline failed
    cells    [N]  mean number of cells in recent scans
    nis      [N]  mean nu^2 / S of the outline's cells in recent scans, about 1
    """

    id: IntArray
    matrix: RandomMatrixState
    outline: GpState | None
    method: CodeArray
    scans: IntArray
    cells: Array
    nis: Array


class Shapes(NamedTuple):
    """N targets as they are shown.

    extended            [N]  the target is longer than pulse and beam make a point
    length, length_sd   [N]  m
    beam                [N]  m, an upper bound where the method is RANDOM_MATRIX
    heading             [N]  rad clockwise from north; of an axis, the end nearer to the course
    heading_sd          [N]  rad
    source              [N]  of the heading: index into SOURCES
    method              [N]  RANDOM_MATRIX or OUTLINE
    outline             [N, CORNERS, 2]  m, east and north of the tracker's position
    """

    extended: BoolArray
    length: Array
    length_sd: Array
    beam: Array
    heading: Array
    heading_sd: Array
    source: CodeArray
    method: CodeArray
    outline: Array


METHODS = ('random_matrix', 'gp')
COURSE, AXIS, BY_OUTLINE = 0, 1, 2
SOURCES = ('course', 'axis', 'outline')
CORNERS = 36
_AROUND: Array = 2 * np.pi / CORNERS * np.arange(float(CORNERS))


def begin(outlines: bool) -> Hulls:
    """No targets yet. outlines: whether outlines are used."""
    none = np.zeros(0)
    matrix = random_matrix.start(
        none,
        np.zeros((0, 2)),
        np.zeros((0, 2, 2)),
        Velocity(np.zeros((0, 2)), np.zeros((0, 2, 2))),
        np.zeros((0, 2, 2)),
    )
    return Hulls(
        none.astype(np.int64),
        matrix,
        _no_outline(0) if outlines else None,
        none.astype(np.int8),
        none.astype(np.int64),
        none,
        none,
    )


def step(
    before: Hulls,
    ids: IntArray,
    time: Array,
    estimate: Extrapolation,
    clusters: Clusters,
    taken: IntArray,
    edge: Edge | None,
    own_ship: Array,
) -> Hulls:
    """Processes one scan.

    ids [N] of the tracks; time [N] s when the beam passed them; estimate of the point tracker then;
    taken [N]: the cluster of each, -1 for none; edge of the clusters, None if outlines are not
    used; own_ship [2] m.
    """
    new = ~np.isin(ids, before.id)
    hulls = append(
        take(before, np.isin(before.id, ids)),
        _start(ids[new], take(estimate, new), clusters, taken[new], before.outline is not None),
    )
    hulls = take(hulls, np.argsort(hulls.id)[np.argsort(np.argsort(ids))])
    matrix = random_matrix.predict(hulls.matrix, time)
    has = (taken >= 0) & ~new
    whole = has.copy()
    whole[has] = ~clusters.crowded[taken[has]]
    rows = whole.nonzero()[0]
    own = take_clusters(clusters, taken[rows])
    matrix = _keep_touch(matrix, rows, own, take(estimate, rows))
    matrix = random_matrix.update(matrix, rows, own.position, own.scatter, own.cells, own.noise)
    count = np.zeros(len(ids))
    count[has] = clusters.cells[taken[has]]
    late = np.where(has, 1 / np.minimum(hulls.scans + 1.0, RECENT), 0.0)
    hulls = hulls._replace(
        matrix=matrix, scans=hulls.scans + whole, cells=hulls.cells + late * (count - hulls.cells)
    )
    if hulls.outline is None or edge is None:
        return hulls
    return _outlines(hulls, time, rows, taken, own, edge, own_ship)


def first_extent(scatter: Array, count: IntArray, noise: Array) -> Array:
    """A first guess of X [K, 2, 2] m^2 from one cluster each: its spread without the noise."""
    spread = scatter / count[:, None, None] - noise
    value, vector = np.linalg.eigh(spread)
    value = np.maximum(value, 0.25 * np.linalg.eigvalsh(noise)) / random_matrix.SHIP.spread
    found: Array = (vector * value[:, None]) @ vector.swapaxes(1, 2)
    return found


def _start(
    ids: IntArray, estimate: Extrapolation, clusters: Clusters, taken: IntArray, outlines: bool
) -> Hulls:
    count = len(ids)
    # A track that began before extents were switched on may have no cluster.
    none = taken < 0
    own = take_clusters(clusters if len(clusters.cells) else NOTHING, taken)
    scatter = np.where(none[:, None, None], 0.0, own.scatter)
    position = np.where(none[:, None], estimate.position, own.position)
    spread = np.where(
        none[:, None, None],
        estimate.covariance[:, :2, :2],
        own.scatter / own.cells[:, None, None] + own.noise,
    )
    matrix = random_matrix.start(
        estimate.time,
        position,
        spread / own.cells[:, None, None],
        Velocity(estimate.velocity, estimate.covariance[:, 2:, 2:]),
        first_extent(scatter, own.cells, own.noise),
        NO_MEMORY + np.where(none, 0.0, np.minimum(own.cells, FIRST_WEIGHT)),
    )
    return Hulls(
        ids,
        matrix,
        _no_outline(count) if outlines else None,
        np.zeros(count, np.int8),
        np.where(none, 0, 1),
        np.where(none, 1.0, own.cells),
        np.ones(count),
    )


def _no_outline(count: int) -> GpState:
    none = np.zeros(count)
    return gaussian_process.start(
        SHIP,
        none,
        np.zeros((count, 6)),
        np.zeros((count, 6, 6)),
        np.ones((count, len(SHIP.contour.angle))),
        np.ones((count, 2)),
    )


def _keep_touch(
    matrix: RandomMatrixState, rows: IntArray, own: Clusters, estimate: Extrapolation
) -> RandomMatrixState:
    """The matrices; of the named rows, those far from their track are reset to it.

    A random matrix moves straight on, but the track follows manoeuvres.
    """
    ahead = take(matrix, rows)
    off = own.position - ahead.mean[:, :2]
    cells = random_matrix.cell_covariance(ahead.extent, own.noise) / own.cells[:, None, None]
    inverse, _ = invert_2x2(ahead.covariance[:, :2, :2] + cells)
    lost = (squared_distance(off, inverse) > LOST_TOUCH).nonzero()[0]
    if not len(lost):
        return matrix
    mean = np.concatenate([own.position, estimate.velocity], 1)[lost]
    return put(
        matrix,
        rows[lost],
        take(ahead, lost)._replace(mean=mean, covariance=estimate.covariance[lost]),
    )


def _outlines(
    hulls: Hulls,
    time: Array,
    rows: IntArray,
    taken: IntArray,
    own: Clusters,
    edge: Edge,
    own_ship: Array,
) -> Hulls:
    """The outlines of the rows that may have one: predicted, started, updated or given up."""
    matrix, outline = hulls.matrix, hulls.outline
    assert outline is not None
    noise, cells = np.zeros_like(matrix.extent), np.zeros(len(time), np.int64)
    noise[rows] = own.noise
    cells[rows] = np.bincount(edge.cluster, minlength=taken.max(initial=-1) + 1)[taken[rows]]
    found = size(hulls.matrix, noise)
    velocity = matrix.mean[:, 2:]
    course = np.arctan2(*velocity.T)
    moving = np.hypot(*velocity.T) > SLOW
    active = hulls.method == BY_GAUSSIAN_PROCESS
    outline = where(active, gaussian_process.predict(outline, time, SHIP), outline)
    half = 0.5 * found.length / SLENDER
    abeam = unit_vector(course + np.pi / 2)
    blur = np.full(len(time), np.inf)
    blur[rows] = np.sqrt(np.einsum('ni,nij,nj->n', abeam[rows], own.noise, abeam[rows]))
    fit = (
        (hulls.scans >= SCANS)
        & (hulls.cells >= CELLS)
        & (cells >= EDGE_CELLS)
        & (blur <= SMEAR * half)
        & moving
    )
    fresh = (fit & ~active).nonzero()[0]
    if len(fresh):
        outline = put(
            outline, fresh, from_random_matrix(take(matrix, fresh), take(found, fresh), own_ship)
        )
    method = hulls.method.copy()
    method[fresh] = BY_GAUSSIAN_PROCESS
    nis = hulls.nis.copy()
    nis[fresh] = 1.0
    lined = rows[method[rows] == BY_GAUSSIAN_PROCESS]
    if len(lined):
        padded, count = _padded(edge, taken[lined])
        outline, found_nis = gaussian_process.update(
            outline, lined, padded, count, edge.noise[taken[lined]], SHIP
        )
        nis[lined] += (found_nis - nis[lined]) / RECENT
    failed = (method == BY_GAUSSIAN_PROCESS) & (
        (moving & (off_course(outline) > OFF_COURSE)) | (nis > NIS)
    )
    method[failed] = BY_RANDOM_MATRIX
    return hulls._replace(
        outline=outline, method=method, nis=nis, scans=np.where(failed, 1, hulls.scans)
    )


def _padded(edge: Edge, chosen: IntArray) -> tuple[Array, IntArray]:
    """Cells [K, C, 2] m of the chosen clusters' edges, and how many [K] each has."""
    first, last = (np.searchsorted(edge.cluster, chosen, side) for side in ('left', 'right'))
    count = last - first
    place = first[:, None] + np.arange(count.max())
    return edge.position[np.minimum(place, len(edge.cluster) - 1)], count


def size(matrix: RandomMatrixState, noise: Array) -> random_matrix.Measures:
    """Length, beam and axis of the random matrices; noise [N, 2, 2] m^2, R of a single cell.

    A radar shows a cell wherever an echo reaches, and all cells count the same. So the cells of a
    hull lie evenly over its length L plus F = FRINGE deviations of R at either end. The random
    matrix subtracts R as a variance, which leaves about L^2 + 4 L F. This function removes the F
    term.
    """
    found = random_matrix.measures(matrix, noise, size=BOX_SPREAD)
    line = unit_vector(found.axis)
    fringe = FRINGE * np.sqrt(np.einsum('ni,nij,nj->n', line, noise, line))
    return found._replace(length=np.sqrt(found.length**2 + 4 * fringe**2) - 2 * fringe)


def shapes(hulls: Hulls, noise: Array, position: Array) -> Shapes:
    """The shapes of the targets as they are shown.

    noise [N, 2, 2] m^2, R of a single cell at each target; position [N, 2] m of the point tracker.
    """
    matrix, found = hulls.matrix, size(hulls.matrix, noise)
    velocity = matrix.mean[:, 2:]
    speed, course = np.hypot(*velocity.T), np.arctan2(*velocity.T)
    side = unit_vector(course + np.pi / 2)
    sideways = np.einsum('ni,nij,nj->n', side, matrix.covariance[:, 2:, 2:], side)
    course_sd = np.sqrt(sideways) / np.maximum(speed, 1e-3)
    by_course = (speed > SLOW) & (course_sd < found.axis_sd)
    axis = np.where(np.cos(found.axis - course) < 0, found.axis + np.pi, found.axis)
    heading = np.where(by_course, course, axis)
    line, across = unit_vector(found.axis), unit_vector(found.axis + np.pi / 2)
    points = matrix.mean[:, None, :2] + 0.5 * (
        found.length[:, None, None] * np.cos(_AROUND)[:, None] * line[:, None]
        + found.beam[:, None, None] * np.sin(_AROUND)[:, None] * across[:, None]
    )
    length, length_sd, beam = found.length, found.length_sd, found.beam
    heading_sd = np.where(by_course, course_sd, found.axis_sd)
    source = np.where(by_course, COURSE, AXIS).astype(np.int8)
    lined = (hulls.method == BY_GAUSSIAN_PROCESS).nonzero()[0]
    if hulls.outline is not None and len(lined):
        outline = take(hulls.outline, lined)
        of = outline_measures.measures(outline, SHIP.contour)
        points[lined] = outline_measures.of_gaussian_process(outline, SHIP.contour, _AROUND).points
        length[lined], length_sd[lined], beam[lined] = of.length, of.length_sd, of.beam
        heading[lined], heading_sd[lined] = outline.mean[:, HEADING], of.axis_sd
        source[lined] = BY_OUTLINE
    return Shapes(
        (hulls.cells >= 3) & (length > 3 * length_sd),
        length,
        length_sd,
        beam,
        np.mod(heading, 2 * np.pi),
        heading_sd,
        source,
        hulls.method,
        points - position[:, None],
    )
