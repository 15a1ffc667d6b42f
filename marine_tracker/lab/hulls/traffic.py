"""Whole scenarios of hulls and land, tracked with and without extents."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...geometry import locate, unit_vector
from ...service import service_for
from ...simulation import hull, radar, scenario
from ...tracking.lifecycle import COASTING, CONFIRMED
from ...types import Array, Extrapolation

SETTLED = 10  # first scans, left out
CUTOFF = 100.0  # m beyond half the length; a track farther off is not on the ship
OUTLINE_SCAN = 110  # the scan of the picture


class Snapshot(NamedTuple):
    """One scan for a picture.

    Cells [M, 2] m; tracks' positions [N, 2] m; outlines [N, K, 2] m relative to them, for extended
    tracks [N]; truth [T, 2] m and true outlines [T, C, 2] m relative to it, nan without a hull; own
    ship [2] m.
    """

    cells: Array
    position: Array
    outline: Array
    extended: NDArray[np.bool_]
    truth: Array
    true_outline: Array
    own: Array


class HullsInTraffic(NamedTuple):
    """confirmed: tracks ever confirmed; held [T]: share of the scans in which each ship had a
    track; rmse m: of the tracks that the ships kept; nearest m: the same for the nearest track at
    each moment; snapshot of one scan, None without extents.
    """

    confirmed: int
    held: Array
    rmse: float
    nearest: float
    snapshot: Snapshot | None


def track(name: str, extent: str, seed: int) -> HullsInTraffic:
    """One run of a shipped scenario. A ship keeps its track while that is confirmed and near.

    If the nearest track counted instead, a tracker with many tracks on one hull would look too
    good.
    """
    loaded = scenario.load(name)
    service = service_for(loaded.tracker_parameters(), extent=extent)
    memory = service.start()
    ships = len(loaded.fleet.names)
    holder, held, seen = np.full(ships, -1), np.zeros(ships), np.zeros(ships)
    confirmed: set[int] = set()
    squares: list[float] = []
    nearest: list[float] = []
    snapshot = None
    for k, (scan, truth) in enumerate(radar.simulate(loaded, seed)):
        memory, (_, report, estimate, shapes) = service.track(memory, scan)
        tracks = report.tracks
        confirmed.update(tracks.id[tracks.status == CONFIRMED].tolist())
        live = np.isin(tracks.status, (CONFIRMED, COASTING))
        if k == OUTLINE_SCAN and shapes is not None:
            snapshot = Snapshot(
                _positions(scan),
                estimate.position[live],
                shapes.outline[live],
                shapes.extended[live],
                truth.position,
                _outlines(loaded.fleet, truth),
                scan.own_ship.position[-1],
            )
        if k < SETTLED:
            continue
        for row, ship in enumerate((truth.target - 1).tolist()):
            away = _away(estimate, report.time, truth, row)
            away[~live | (away > CUTOFF + 0.5 * loaded.fleet.length[ship])] = np.inf
            kept = np.flatnonzero((tracks.id == holder[ship]) & np.isfinite(away))
            one = kept[0] if len(kept) else int(away.argmin()) if len(away) else -1
            seen[ship] += 1
            if one >= 0 and np.isfinite(away[one]):
                holder[ship] = tracks.id[one]
                held[ship] += 1
                squares.append(away[one] ** 2)
                nearest.append(away.min() ** 2)
    rmse, least = (float(np.sqrt(np.mean(of))) for of in (squares, nearest))
    return HullsInTraffic(len(confirmed), held / np.maximum(seen, 1), rmse, least, snapshot)


def _away(estimate: Extrapolation, time, truth, row) -> Array:
    """Distances m [N] of the tracks from a ship at their times."""
    there = truth.position[row] + (time - truth.time[row])[:, None] * truth.velocity[row]
    return np.hypot(*(estimate.position - there).T)


def _positions(scan) -> Array:
    return locate(scan.plots, scan.own_ship, 1.0, 1e-3).position


def _outlines(fleet, truth) -> Array:
    ship = truth.target - 1
    heading = fleet.hulls.heading[ship]
    ahead = unit_vector(np.where(np.isnan(heading), np.arctan2(*truth.velocity.T), heading))
    corners = 0.5 * np.stack([fleet.length, fleet.hulls.beam], -1)[ship][:, None] * hull.OUTLINE
    starboard = np.stack([ahead[:, 1], -ahead[:, 0]], -1)
    return corners[..., :1] * ahead[:, None] + corners[..., 1:] * starboard[:, None]
