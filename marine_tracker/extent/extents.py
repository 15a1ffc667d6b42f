"""Extended targets around a point tracker: one plot a cluster in, sizes and headings out.

    plain, seen = extents.reduce(known, scan, ids, ahead)   # one plot a cluster
    tracks, report = tracker.step(tracks, plain)
    known = extents.step(known, seen, ...)
    shapes = extents.shapes(known, seen, estimate)

service.py has it in full. The tracker knows nothing of extents.

What is longer than any ship and stays where it is, is land: its clusters give no plots.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..gaussian.linear import invert_2x2, squared_distance
from ..geometry import locate, own_ship_at, polar_to_position, to_range_bearing, unit_vector
from ..parameters import TrackerParameters
from ..types import Array, Extrapolation, Plots, PolarPlots, Scan, row_of, take
from . import hulls, land_map
from .clustering import Clusters, Gates, cluster, in_gates
from .hulls import BY_GAUSSIAN_PROCESS, Hulls, Shapes
from .land_map import LONGEST, LandMap
from .lit_edge import lit_edge
from .random_matrix import SHIP, cell_covariance
from .smear import smear

# Of a ship's length: how far the centroid strays along her axis; across, as the lit side changes.
STRAY_ALONG, STRAY_ACROSS = 0.1, 0.04
RAMP = 0.2  # of the way to an outline's centre that the plots move each scan
ROD_SPREAD = 12.0  # length^2 over variance of a rod
# A gate is so many times the extent, the smear and the expectation's covariance: half again the
# half length, and 2.8 deviations.
OF_EXTENT, OF_NOISE = 1.5, 8.0
AT_SEA = 22  # scans clear of land that prove a ship, though she lies on it later
ALIKE, DRIFT = 9.0, 2.0  # squared distance of velocities, and m/s, of two parts of one hull


class ExtentsMemory(NamedTuple):
    """All that is known between two scans.

    hulls   one row a track
    shift   [N, 2]  m, from the centroid of its cells to where each track is led
    at_sea  [N]     scans in which each track was clear of land
    land    where it lies
    shores  clusters of land in the last scan
    """

    hulls: Hulls
    shift: Array
    at_sea: NDArray[np.int64]
    land: LandMap
    shores: int


class Seen(NamedTuple):
    """One scan in clusters.

    cells     M plots, as they came
    clusters  C rows
    chosen    [P]  the clusters that gave plots, in the order of the plots
    shores    how many were land
    own       [2] m, own ship in the middle of the scan
    map       of the land, this scan included
    """

    cells: Plots
    clusters: Clusters
    chosen: NDArray[np.int64]
    shores: int
    own: Array
    map: LandMap


class Extents:
    """The pure core: parameters in, no state of its own.

    on  whether the parameters ask for extents
    """

    def __init__(self, parameters: TrackerParameters):
        self.parameters = parameters
        self.on = parameters.extent != 'off'
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
        """The memory of another; sizes are found anew where it was asked for something else."""
        same = self.parameters.extent == previous.parameters.extent
        return known if same else self.start()

    def reduce(
        self, memory: ExtentsMemory, scan: Scan, ids, ahead: Extrapolation
    ) -> tuple[Scan, Seen]:
        """The scan with one plot a cluster, land left out.

        ids [N] of the tracks that are surely targets, and where they are expected.
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
        found = cluster(
            cells,
            p.range_resolution_m,
            self.beam_width,
            place._replace(land=(place.gate < 0) & land_map.on_land(land, cells.position)),
        )
        dry = found.land | ((found.size > LONGEST) & (found.gate < 0))
        chosen = (~dry).nonzero()[0]
        plots = self._plots(memory, hulls.take_clusters(found, chosen), row, scan)
        return scan._replace(plots=plots), Seen(cells, found, chosen, int(dry.sum()), own, land)

    def step(
        self, memory: ExtentsMemory, seen: Seen, ids, time, plot, estimate: Extrapolation
    ) -> ExtentsMemory:
        """After the tracker's step: ids [N] of its tracks, time [N] s, plot [N] rows of the
        reduced scan or -1, and its estimate then."""
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

    def _noise(self, offset):
        range_, bearing = to_range_bearing(offset)
        return smear(range_, bearing, self.parameters.range_resolution_m, self.beam_width)

    def _gates(self, memory, ids, ahead, own):
        """Where hulls are expected, and their rows of the memory.

        What was never long at sea and lies on land is land that was taken for a target before it
        was known: it has no gate. Nor has a track that never had a cluster to itself: one begun on
        a single cell before extents were asked for.
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
        gates, kept = one_a_ship(
            Gates(ahead.time, ahead.position - memory.shift[row], ahead.velocity, area),
            ahead.covariance[:, 2:, 2:],
            memory.hulls.scans[row] < hulls.SCANS,
        )
        return gates, row[kept]

    def _plots(self, memory, chosen, row, scan):
        """One plot a cluster: the centroid, with (z_s X + R) / n and what it strays along the hull.

        A cluster of a single cell is a plot like any other.
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


def one_a_ship(gates: Gates, velocity_covariance, young) -> tuple[Gates, NDArray[np.int64]]:
    """The gates without those of parts of a hull that has another; and their rows.

    Two that overlap and move alike, as far as velocities with covariances [H, 2, 2] m^2/s^2 tell,
    are one hull in two pieces, unless both are known for long; young [H] tells which are not. The
    gate of the older track, which comes first, grows over both; the other gets no more plots.
    """
    apart = gates.middle[:, None] - gates.middle
    way = np.hypot(*np.moveaxis(apart, -1, 0))
    inverse, _ = invert_2x2(gates.area)
    # From the middle of each row's gate to its edge, towards each column's.
    edge = way / np.sqrt(np.maximum(squared_distance(apart, inverse[:, None]), 1e-12))
    differ = gates.velocity[:, None] - gates.velocity
    certain, _ = invert_2x2(velocity_covariance[:, None] + velocity_covariance)
    one = np.triu(
        (way <= edge + edge.T)
        & (squared_distance(differ, certain) < ALIKE)
        & (np.square(differ).sum(-1) < DRIFT**2)
        & (young[:, None] | young),
        1,
    )
    area = gates.area.copy()
    for older, younger in zip(*one.nonzero()):
        reach = 1 + edge[younger, older] / max(way[older, younger], 1.0)
        area[older] += reach**2 * np.outer(apart[older, younger], apart[older, younger])
    kept = (~one.any(0)).nonzero()[0]
    return take(gates._replace(area=area), kept), kept
