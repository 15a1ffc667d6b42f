"""Extended targets around a point tracker: it gets one plot a cluster; sizes and headings come out.

    plain, seen = extents.reduce(known, scan, ids, ahead)   # one plot a cluster
    tracks, report = tracker.step(tracks, plain)
    known = extents.step(known, seen, ...)
    shapes = extents.shapes(known, seen, estimate)

See service.py for the full sequence. The tracker knows nothing of extents.

An echo that is longer than any ship and stays in place is land. Its clusters give no plots.
"""

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..gaussian.linear import invert_2x2, squared_distance
from ..geometry import locate, own_ship_at, polar_to_position, to_range_bearing, unit_vector
from ..parameters import TrackerParameters
from ..types import Array, BoolArray, Extrapolation, IntArray, Plots, PolarPlots, Scan, row_of, take
from . import hulls, land_map
from .clustering import Clusters, Gates, cluster, in_gates, take_clusters
from .hulls import BY_GAUSSIAN_PROCESS, Hulls, Shapes
from .land_map import LONGEST, LandMap
from .lit_edge import lit_edge
from .random_matrix import SHIP, cell_covariance
from .smear import smear

# Deviation of the centroid over the ship's length: along her axis; and across it, as the lit side
# changes.
STRAY_ALONG, STRAY_ACROSS = 0.1, 0.04
RAMP = 0.2  # share of the way to an outline's centre that the plots move each scan
ROD_SPREAD = 12.0  # length^2 over variance of a rod
# A gate is a multiple of the extent, the smear and the expectation's covariance: 1.5 times the half
# length, and 2.8 deviations.
OF_EXTENT, OF_NOISE = 1.5, 8.0
AT_SEA = 22  # scans clear of land that prove a ship, even if she lies on it later
ALIKE, DRIFT = 9.0, 2.0  # squared distance of velocities, and m/s, of two parts of one hull


class ExtentsMemory(NamedTuple):
    """The memory between two scans.

    hulls   one row a track
    shift   [N, 2]  m, from the centroid of the cells to the place where each track is led
    at_sea  [N]     number of scans in which each track was clear of land
    land    where land lies
    shores  clusters of land in the last scan
    """

    hulls: Hulls
    shift: Array
    at_sea: IntArray
    land: LandMap
    shores: int


class Seen(NamedTuple):
    """One scan in clusters.

    cells     M plots, as they came
    clusters  C rows
    chosen    [P]  the clusters that gave plots, in the order of the plots
    shores    number of clusters that were land
    own       [2] m, own ship in the middle of the scan
    map       of the land, this scan included
    left_out  pairs of cells that were not compared, because a crowd has too many
    """

    cells: Plots
    clusters: Clusters
    chosen: IntArray
    shores: int
    own: Array
    map: LandMap
    left_out: int


class Extents:
    """The pure core: it takes parameters and has no state.

    on  whether the parameters ask for extents
    """

    def __init__(self, parameters: TrackerParameters) -> None:
        self.parameters = parameters
        self.on = parameters.extent != 'none'
        self.beam_width = float(np.radians(parameters.beam_width_deg))

    def start(self) -> ExtentsMemory:
        """No targets yet."""
        return ExtentsMemory(
            hulls.begin(self.parameters.extent == 'gp'),
            np.zeros((0, 2)),
            np.zeros(0, np.int64),
            land_map.empty(),
            0,
        )

    def adopt(self, known: ExtentsMemory, previous: 'Extents') -> ExtentsMemory:
        """Takes over the memory of another instance. Sizes start again if it had other settings."""
        same = self.parameters.extent == previous.parameters.extent
        return known if same else self.start()

    def reduce(
        self, memory: ExtentsMemory, scan: Scan, ids: IntArray, ahead: Extrapolation
    ) -> tuple[Scan, Seen]:
        """The scan with one plot a cluster, without land.

        ids [N] of the tracks that are certainly targets; ahead: where they are expected.
        """
        p = self.parameters
        cells = locate(
            scan.plots, scan.measured_from, p.range_sigma_m, float(np.radians(p.bearing_sigma_deg))
        )
        own, _ = own_ship_at(scan.measured_from, 0.5 * (scan.start + scan.end))
        gates, row = self._gates(memory, ids, ahead, own)
        place = in_gates(cells, gates)
        along = unit_vector(cells.bearing)
        width = (self.beam_width * cells.range)[:, None] * np.stack([along[:, 1], -along[:, 0]], -1)
        land = land_map.learn(memory.land, cells.position, width)
        found, left_out = cluster(
            cells,
            p.range_resolution_m,
            self.beam_width,
            place._replace(land=(place.gate < 0) & land_map.on_land(land, cells.position)),
        )
        dry = found.land | ((found.size > LONGEST) & (found.gate < 0))
        chosen = (~dry).nonzero()[0]
        plots = self._plots(memory, take_clusters(found, chosen), row, scan)
        seen = Seen(cells, found, chosen, int(dry.sum()), own, land, left_out)
        return scan._replace(plots=plots), seen

    def step(
        self,
        memory: ExtentsMemory,
        seen: Seen,
        ids: IntArray,
        time: Array,
        plot: IntArray,
        estimate: Extrapolation,
    ) -> ExtentsMemory:
        """The memory after the tracker's step.

        ids [N] of its tracks; time [N] s; plot [N] rows of the reduced scan or -1; its estimate
        then.
        """
        taken = np.where(plot >= 0, np.append(seen.chosen, -1)[plot], -1)
        edge = (
            lit_edge(
                seen.cells,
                seen.clusters.of_cell,
                seen.clusters.noise,
                self.parameters.range_resolution_m,
                self.beam_width,
            )
            if self.parameters.extent == 'gp'
            else None
        )
        known = hulls.step(memory.hulls, ids, time, estimate, seen.clusters, taken, edge, seen.own)
        shift, at_sea = np.zeros((len(ids), 2)), np.zeros(len(ids), np.int64)
        was = row_of(memory.hulls.id, ids)
        shift[was >= 0], at_sea[was >= 0] = (
            of[was[was >= 0]] for of in (memory.shift, memory.at_sea)
        )
        at_sea += ~land_map.on_land(seen.map, estimate.position)
        wanted = np.zeros_like(shift)
        if known.outline is not None:
            lined = known.method == BY_GAUSSIAN_PROCESS
            wanted[lined] = known.outline.mean[lined, :2] - known.matrix.mean[lined, :2]
        return ExtentsMemory(known, shift + RAMP * (wanted - shift), at_sea, seen.map, seen.shores)

    def shapes(self, memory: ExtentsMemory, seen: Seen, estimate: Extrapolation) -> Shapes:
        """Sizes and headings of all N tracks after `step`, with the same estimate."""
        noise = self._noise(memory.hulls.matrix.mean[:, :2] - seen.own)
        return hulls.shapes(memory.hulls, noise, estimate.position)

    def _noise(self, offset: Array) -> Array:
        range_, bearing = to_range_bearing(offset)
        return smear(range_, bearing, self.parameters.range_resolution_m, self.beam_width)

    def _gates(
        self, memory: ExtentsMemory, ids: IntArray, ahead: Extrapolation, own: Array
    ) -> tuple[Gates, IntArray]:
        """Where hulls are expected, and their rows of the memory.

        A track that lies on land and was never clear of land for long is land that was taken for a
        target. It has no gate. A track that never had a cluster has no gate either: it began on a
        single cell before extents were switched on.
        """
        row = row_of(memory.hulls.id, ids)
        row, ahead = row[row >= 0], take(ahead, row >= 0)
        kept = (memory.hulls.scans[row] > 0) & (
            (memory.at_sea[row] >= AT_SEA) | ~land_map.on_land(memory.land, ahead.position)
        )
        row, ahead = row[kept], take(ahead, kept)
        matrix = memory.hulls.matrix
        area = OF_EXTENT * matrix.extent[row] + OF_NOISE * (
            self._noise(ahead.position - own) + ahead.covariance[:, :2, :2]
        )
        gates, alone = one_a_ship(
            Gates(ahead.time, ahead.position - memory.shift[row], ahead.velocity, area),
            ahead.covariance[:, 2:, 2:],
            memory.hulls.scans[row] < hulls.SCANS,
        )
        return gates, row[alone]

    def _plots(
        self, memory: ExtentsMemory, chosen: Clusters, row: IntArray, scan: Scan
    ) -> PolarPlots:
        """One plot a cluster: the centroid, with noise (z_s X + R) / n plus its deviation along the
        hull.

        A cluster of a single cell becomes a normal plot.
        """
        p = self.parameters
        count = chosen.cells[:, None, None]
        extent = hulls.first_extent(chosen.scatter, chosen.cells, chosen.noise)
        shift = np.zeros((len(chosen.cells), 2))
        own = (chosen.gate >= 0).nonzero()[0]
        of = row[chosen.gate[own]]
        extent[own], shift[own] = memory.hulls.matrix.extent[of], memory.shift[of]
        value, vector = np.linalg.eigh(extent)
        length = np.sqrt(ROD_SPREAD * SHIP.spread * value[:, 1])
        stray = (vector * np.square([STRAY_ACROSS, STRAY_ALONG])) @ vector.swapaxes(1, 2)
        covariance = (
            cell_covariance(extent, chosen.noise) / count + np.square(length)[:, None, None] * stray
        )
        origin, _ = own_ship_at(scan.measured_from, chosen.time)
        range_, bearing = to_range_bearing(chosen.position + shift - origin)
        _, single = polar_to_position(
            range_, bearing, p.range_sigma_m, np.radians(p.bearing_sigma_deg)
        )
        covariance = np.where(count > 1, covariance, single)
        return PolarPlots(chosen.time, range_, bearing, chosen.amplitude, covariance=covariance)


def one_a_ship(
    gates: Gates, velocity_covariance: Array, young: BoolArray
) -> tuple[Gates, IntArray]:
    """The gates, with at most one for each hull, and their rows.

    Two gates belong to one hull in two pieces if they overlap and their velocities agree within the
    covariances [H, 2, 2] m^2/s^2. They stay two if both tracks are old; young [H] tells which are
    not. The gate of the older track comes first and grows over both. The other gets no more plots.
    """
    area = gates.area.copy()
    if len(area) < 2:
        return gates, np.arange(len(area))
    farthest = 2 * np.sqrt(np.linalg.eigvalsh(area)[:, -1].max())
    pairs = cKDTree(gates.middle).query_pairs(farthest * (1 + 1e-9), output_type='ndarray')
    older, younger = pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))].T
    apart = gates.middle[older] - gates.middle[younger]
    way = np.hypot(*apart.T)
    inverse, _ = invert_2x2(area)
    # Distance from the middle of each one's gate to its edge, in the direction of the other's.
    edge, others = (
        way / np.sqrt(np.maximum(squared_distance(apart, inverse[rows]), 1e-12))
        for rows in (older, younger)
    )
    differ = gates.velocity[older] - gates.velocity[younger]
    certain, _ = invert_2x2(velocity_covariance[older] + velocity_covariance[younger])
    one = (
        (way <= edge + others)
        & (squared_distance(differ, certain) < ALIKE)
        & (np.square(differ).sum(-1) < DRIFT**2)
        & (young[older] | young[younger])
    ).nonzero()[0]
    for pair in one:
        reach = 1 + others[pair] / max(way[pair], 1.0)
        area[older[pair]] += reach**2 * np.outer(apart[pair], apart[pair])
    kept = np.setdiff1d(np.arange(len(area)), younger[one])
    return take(gates._replace(area=area), kept), kept
