"""What comes of a scene: who was joined rightly, who was told to be wrong, and the registration."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...ais import join
from ...ais.pairs import probability_of
from ...types import Array
from . import traffic
from .traffic import Moment

SETTLED, REGISTERED = 60.0, 300.0  # s, from when on ships must be joined; registration be known
ERRORS = (30.0, float(np.radians(1.0)))  # m, rad: of the radar
TOLD_WITHIN = 60.0  # s
BEGINS = 15.0  # s, from when on probabilities are compared with what is


class Tally(NamedTuple):
    """Of a scene; ship-scans [2] of the ships beside the lane and in it, after SETTLED.

    right, wrong, missed  [2]  joined to her track, to another's, not at all though she has one
    mismatches  ships told wrongly to be elsewhere;  hours  ship-hours that this was looked at
    told        [K]  s from the beginning of each spoof to the mismatch; nan: never
    range, bearing  m, rad: errors of the registration at REGISTERED
    chance      [C, 2]  probability of all pairs from BEGINS on, and whether they are the same
    """

    right: NDArray[np.int64]
    wrong: NDArray[np.int64]
    missed: NDArray[np.int64]
    mismatches: int
    hours: float
    told: Array
    range: float
    bearing: float
    chance: Array


def of_scene(seed: int, spoof: dict[str, float] | None = None, minutes: float = 6.0) -> Tally:
    """One scene with its own noise."""
    scene = traffic.scene(seed, minutes=minutes, spoof=spoof)
    watch = Watch(scene)
    traffic.follow(scene, seed, ERRORS, each=watch.see)
    return watch.tally()


class Watch:
    """Sees the moments of a scene, counts."""

    def __init__(self, scene: traffic.Scenario) -> None:
        sends = scene.fleet.ais
        assert sends is not None
        self._period = scene.radar.scan_period
        self._begins = np.array([one.spoofed[0] for one in sends.targets])
        self._counts = np.zeros((3, 2), np.int64)
        self._told: dict[int, float] = {}
        self._false: set[tuple[int, int]] = set()
        self._hours = 0.0
        self._errors = np.full(2, np.nan)
        self._chance: list[tuple[float, bool]] = []

    def see(self, moment: Moment) -> None:
        """One scan."""
        output, ships = moment.output, moment.output.ais
        now = output.scan.end
        if ships is None:
            return
        tracks, joined = output.report.tracks, ships.joined
        number = traffic.number_of(ships.ships.mmsi)
        if now >= REGISTERED and np.isnan(self._errors[0]):
            self._errors = ships.registration.value[:2] - ERRORS
        spoofed = now >= self._begins[number - 1]
        for row in (joined.state == join.APART_STATE).nonzero()[0].tolist():
            if spoofed[row]:
                self._told.setdefault(int(number[row]), now - self._begins[number[row] - 1])
            else:
                self._false.add((int(number[row]), int(joined.track[row])))
        if now >= BEGINS and not spoofed.any():
            self._compare(moment, dict(zip(ships.ships.id.tolist(), number.tolist())))
        if now < SETTLED:
            return
        whose = dict(zip(tracks.id.tolist(), moment.ship.tolist()))
        have = set(moment.ship[tracks.number > 0].tolist())
        self._hours += len(number) * self._period / 3600
        for row in (~spoofed & ships.ships.placed).nonzero()[0].tolist():
            ship = int(number[row])
            lane = int(ship <= traffic.IN_LANE)
            its = whose.get(int(joined.track[row]), 0)
            if joined.state[row] == join.BOTH and its >= 0:
                self._counts[0 if its == ship else 1, lane] += 1
            elif joined.state[row] == join.AIS_ONLY and ship in have:
                self._counts[2, lane] += 1

    def _compare(self, moment: Moment, number: dict[int, int]) -> None:
        """Notes the probability of each pair, and whether ship and track are the same."""
        tracks, pairs = moment.output.report.tracks, moment.pairs
        whose = dict(zip(tracks.id.tolist(), moment.ship.tolist()))
        for ship, track, likely in zip(
            pairs.ship.tolist(), pairs.track.tolist(), probability_of(pairs).tolist()
        ):
            its = whose.get(track, -1)
            if its >= 0 and ship in number:
                self._chance.append((likely, its == number[ship]))

    def tally(self) -> Tally:
        """What was counted."""
        spoofed = np.flatnonzero(np.isfinite(self._begins)) + 1
        told = np.array([self._told.get(int(ship), np.nan) for ship in spoofed])
        right, wrong, missed = self._counts
        return Tally(
            right,
            wrong,
            missed,
            len(self._false),
            self._hours,
            told,
            float(self._errors[0]),
            float(self._errors[1]),
            np.array(self._chance[:: max(len(self._chance) // 4000, 1)]).reshape(-1, 2),
        )
