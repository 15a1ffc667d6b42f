"""Cuts the scans of whole revolutions into sectors, as a radar sends them that does not wait."""

from collections.abc import Iterator

import numpy as np

from ..geometry import heading_at, own_ship_at
from ..types import OwnShip, Scan, Sector, Truth, take

SAMPLES = 2  # of own ship in a sector, at least: both ends


def cut(scan: Scan, count: int) -> list[Scan]:
    """`count` sectors, equal in time; the beam passes true north when the revolution begins."""
    edges = np.linspace(scan.start, scan.end, count + 1)
    place = np.clip(np.searchsorted(edges, scan.plots.time, 'right') - 1, 0, count - 1)
    turn = 2 * np.pi / count
    return [
        Scan(
            float(edges[k]),
            float(edges[k + 1]),
            take(scan.plots, place == k),
            _samples(scan.own_ship, float(edges[k]), float(edges[k + 1])),
            scan.radar,
            None if scan.antenna is None else _samples(scan.antenna, edges[k], edges[k + 1]),
            Sector(k * turn, turn),
        )
        for k in range(count)
    ]


def parts(scans: Iterator[tuple[Scan, Truth]], count: int) -> Iterator[tuple[Scan, Truth]]:
    """The scans with their truth, each cut into `count` sectors, 1 for none; the truth of a sector
    is that of the beam's passages in it."""
    for scan, truth in scans:
        if count == 1:
            yield scan, truth
            continue
        for k, part in enumerate(cut(scan, count)):
            late = truth.time >= part.start if k else np.ones(len(truth.time), bool)
            early = truth.time < part.end if k < count - 1 else np.ones(len(truth.time), bool)
            yield part, take(truth, late & early)


def _samples(own: OwnShip, start: float, end: float) -> OwnShip:
    """Own ship's samples from start to end, s, both included."""
    within = own.time[(own.time > start) & (own.time < end)]
    time = np.concatenate([[start], within, [end]])
    heading = None if own.heading is None else heading_at(own, time)
    return OwnShip(time, *own_ship_at(own, time), heading)
