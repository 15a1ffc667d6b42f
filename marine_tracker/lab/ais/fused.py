"""AIS as a sensor of tracks: how far they are off with it and without, and what a liar does."""

from typing import NamedTuple

import numpy as np

from ...ais import join
from ...evaluation import report
from ...evaluation.report import Figure
from ...geometry import unit_vector
from ...types import Array
from . import traffic
from .tallies import SETTLED
from .traffic import Moment

ESTIMATORS = ('gwnn', 'imm')
LIAR = {'walk_mps': 5.0}
LIES = 60.0  # s


class Off(NamedTuple):
    """Mean squares, m^2: of tracks without fusion, with it, and of AIS itself; and by how many
    deviations a liar moved her track her way, beside the same without fusion: the mean of the first
    LIES s, of the ship that moved it most."""

    alone: float
    fused: float
    ais: float
    moved: float


def of_scene(seed: int, estimator: str) -> Off:
    """One scene, honest, then with liars, each with fusion and without."""
    alone, fused = (_follow(seed, estimator, on, None) for on in (False, True))
    honest, lied = (_follow(seed, estimator, on, LIAR) for on in (False, True))
    moved: dict[int, list[float]] = {}
    for scan, ship in set(lied[1]) & set(honest[1]):
        of, beside = lied[1][scan, ship], honest[1][scan, ship]
        moved.setdefault(ship, []).append(float((of[0] - beside[0]) / beside[1]))
    return Off(
        float(np.mean(alone[0][:, 0])),
        float(np.mean(fused[0][:, 0])),
        float(np.mean(fused[0][:, 1])),
        max((float(np.mean(one)) for one in moved.values()), default=0.0),
    )


def _follow(
    seed: int, estimator: str, fuse: bool, spoof: dict[str, float] | None
) -> tuple[Array, dict[tuple[int, int], Array]]:
    """Squares [K, 2] m^2 of joined tracks and of AIS; of liars' tracks by scan and ship the place,
    m along her way, and its deviation."""
    scene = traffic.scene(seed, minutes=5.0, spoof=spoof)
    assert scene.fleet.ais is not None
    begins = np.array([one.spoofed[0] for one in scene.fleet.ais.targets])
    way = unit_vector(np.array([one.spoofed[3] for one in scene.fleet.ais.targets]))
    squares: list[tuple[float, float]] = []
    liars: dict[tuple[int, int], Array] = {}
    scans = [0]

    def see(moment: Moment) -> None:
        scans[0] += 1
        output, ships = moment.output, moment.output.ais
        now = output.scan.end
        if ships is None or now < SETTLED:
            return
        tracks, estimate = output.report.tracks, output.estimate
        place = estimate.position + (now - estimate.time)[:, None] * estimate.velocity
        for row, ship in enumerate(moment.ship.tolist()):
            if ship > 0 and tracks.number[row] and 0 < now - begins[ship - 1] < LIES:
                spread = np.sqrt(0.5 * np.trace(estimate.covariance[row, :2, :2]))
                along = float(place[row] @ way[ship - 1])
                liars[scans[0], ship] = np.array([along, max(spread, 1.0)])
        whose = dict(zip(tracks.id.tolist(), range(len(tracks.id))))
        for k in (ships.joined.state == join.BOTH).nonzero()[0].tolist():
            ship = int(traffic.number_of(ships.ships.mmsi[k]))
            at = whose.get(int(ships.joined.track[k]))
            if at is None or moment.ship[at] != ship or now > begins[ship - 1]:
                continue
            true = moment.place[ship - 1]
            squares.append(
                (
                    float(((place[at] - true) ** 2).sum()),
                    float(((ships.moving.position[k] - true) ** 2).sum()),
                )
            )

    traffic.follow(scene, seed, (0.0, 0.0), {'ais_fusion': fuse}, see, estimator=estimator)
    return np.array(squares).reshape(-1, 2), liars


def figures(estimator: str, found: list[Off]) -> list[Figure]:
    """Of all scenes with an estimator."""
    alone, fused, ais, _ = np.sqrt(np.mean(np.array(found), axis=0)).tolist()
    return [
        Figure(f'{estimator}: off by radar, RMS', alone, 'm'),
        Figure(f'{estimator}: off by AIS, RMS', ais, 'm'),
        report.at_most(f'{estimator}: off with both, RMS', fused, min(alone, ais), 'm'),
        report.at_most(
            f'{estimator}: a liar moves her track, deviations', max(one.moved for one in found), 1.0
        ),
    ]
