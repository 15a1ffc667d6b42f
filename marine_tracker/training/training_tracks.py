"""The simulated traffic and radars for tuning filters and training networks.

They are described by data, for each vessel class (`WATERS`).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..simulation import motion
from ..simulation.scenario import Scenario
from ..types import Array, IntArray, put, take
from . import ship_tracks, steered_tracks
from .ship_tracks import Kind, RunRadar, Ships
from .steered_tracks import Steered

SPEED = 25.0  # m/s, maximum target speed given to the tracker
# Radars under hard conditions: limits of uniform draws, and the share of such radars to which they
# apply.
DETECTION = (0.7, 1.0)
OUTLIERS, WITH_OUTLIERS = (0.0, 0.06), 0.5
TRULY, WRONGLY_STATED = (0.5, 2.2), 0.4  # drawn by its logarithm
JITTER = (0.0, 0.06)  # deviation of a scan's time, relative to the time
TRIES = 50  # start times that are tried for stretches of a scenario
TURNING = 0.04  # m/s^2, acceleration that counts as a manoeuvre


class Radars(NamedTuple):
    """Radars of one sort. Pairs are minimum and maximum of uniform draws.

    share          share of the tracks that they see
    range_sigma    m
    bearing_sigma  deg
    ranges         m, at which tracks begin; drawn by the logarithm
    nearest        m; tracks that come nearer are left out
    rpm            antenna rate
    hard           share of them under hard conditions
    hard_rpm       antenna rate of those
    fastest        m/s, maximum speed of the ships
    hull           m, how far the plots wander and jump over the ship
    detection      probability of a plot in a scan, except under hard conditions
    """

    share: float
    range_sigma: tuple[float, float]
    bearing_sigma: tuple[float, float]
    ranges: tuple[float, float]
    nearest: float
    rpm: tuple[float, float]
    hard: float
    hard_rpm: tuple[float, float]
    fastest: tuple[float, float] = (100.0, 100.0)
    hull: tuple[float, float] = (0.0, 0.0)
    detection: tuple[float, float] = (1.0, 1.0)


class Waters(NamedTuple):
    """Where to learn: kinds of ships by name, equally often; sorts of radars, at most two.

    steered   more kinds, of vessels that are steered
    scenario  its targets' tracks are one more kind
    """

    kinds: dict[str, Kind]
    radars: tuple[Radars, ...]
    steered: dict[str, Steered] = {}
    scenario: Scenario | None = None

    @property
    def names(self) -> list[str]:
        """Names of all kinds, in the order of their numbers."""
        told = [] if self.scenario is None else [f'scenario {self.scenario.name}']
        return [*self.kinds, *self.steered, *told]

    def without(self, name: str) -> 'Waters':
        """The same without a kind of motion.

        Raises ValueError if there is no such kind, or no other.
        """
        own = [*self.kinds, *self.steered]
        if name not in own:
            raise ValueError(f'kind of motion {name!r}; it must be one of {", ".join(own)}')
        kinds, steered = dict(self.kinds), dict(self.steered)
        kinds.pop(name, None)
        steered.pop(name, None)
        if not kinds:
            raise ValueError(f'without {name!r} no kind of motion is left')
        return self._replace(kinds=kinds, steered=steered)


WATERS = {
    'ship': Waters(
        ship_tracks.KINDS,
        (
            Radars(
                0.85,
                (8.0, 35.0),
                (0.15, 0.5),
                (1500.0, 18000.0),
                1000.0,
                (22.0, 22.0),
                0.25,
                (20.0, 26.0),
            ),
            Radars(
                0.15,
                (2.0, 15.0),
                (0.3, 1.0),
                (60.0, 2500.0),
                30.0,
                (22.0, 22.0),
                1.0,
                (20.0, 40.0),
                (3.0, 18.0),
            ),
        ),
        steered_tracks.SHIPS,
    ),
    'small_craft': Waters(
        ship_tracks.SMALL_CRAFT,
        (
            Radars(
                0.5, (2.0, 15.0), (0.3, 1.2), (60.0, 5000.0), 20.0, (20.0, 48.0), 0.3, (20.0, 48.0)
            ),
            Radars(
                0.5,
                (2.0, 15.0),
                (0.3, 1.2),
                (60.0, 5000.0),
                20.0,
                (20.0, 48.0),
                1.0,
                (20.0, 48.0),
                hull=(0.0, 5.0),
            ),
        ),
        steered_tracks.SMALL_CRAFT,
    ),
}


class Traffic(NamedTuple):
    """B tracks and the radars that see them.

    ships, radar; kind [B]: number among the waters' kinds; sort [B]: of the radar; hull [B]: m.
    """

    ships: Ships
    radar: RunRadar
    kind: NDArray[np.int64]
    sort: NDArray[np.int64]
    hull: Array


def draw(waters: Waters, kind: IntArray, scans: int, rng: np.random.Generator) -> Traffic:
    """Tracks of the kinds [B] (numbers), without those that come too near their radar."""
    count = len(kind)
    share = np.array([one.share for one in waters.radars])
    sort = np.searchsorted(np.cumsum(share / share.sum())[:-1], rng.random(count), 'right')

    def drawn(name):
        low, high = np.array([getattr(one, name) for one in waters.radars])[sort].T
        return low + (high - low) * rng.random(count)

    def by_log(low, high):
        return np.exp(rng.uniform(np.log(low), np.log(high)))

    own = {
        name: np.array([getattr(one, name) for one in waters.radars])[sort]
        for name in ('hard', 'nearest', 'ranges')
    }
    hard = rng.random(count) < own['hard']
    some = rng.random((2, count)) < np.array([[WITH_OUTLIERS], [WRONGLY_STATED]])
    period = 60 / np.where(hard, drawn('hard_rpm'), drawn('rpm'))
    radar = RunRadar(
        range_sigma=drawn('range_sigma'),
        bearing_sigma=np.radians(drawn('bearing_sigma')),
        detection=np.where(hard, rng.uniform(*DETECTION, count), drawn('detection')),
        outliers=np.where(hard & some[0], rng.uniform(*OUTLIERS, count), 0.0),
        truly=np.where(hard & some[1], by_log(*np.full((count, 2), TRULY).T), 1.0),
        period=period,
    )
    jitter = np.where(hard, rng.uniform(*JITTER, count), 0.0)[:, None]
    steps = period[:, None] * (1 + jitter * np.clip(rng.standard_normal((count, scans)), -3, 3))
    kind = np.asarray(kind)
    ships, hull = sail(waters, kind, by_log(*own['ranges'].T), steps, rng, drawn('fastest'))
    nearest = np.hypot(*np.moveaxis(ships.position, -1, 0)).min(1)
    keep = np.flatnonzero(nearest > own['nearest'])
    return take(Traffic(ships, radar, kind, sort, hull + drawn('hull')), keep)


def sail(
    waters: Waters,
    kind: IntArray,
    ranges: Array,
    steps: Array,
    rng: np.random.Generator,
    fastest: Array,
) -> tuple[Ships, Array]:
    """Ships of the kinds [B] (numbers), and how far [B] m their plots wander over the hull.

    ranges [B] m, at which they begin; steps [B, K] s: time since the previous scan; fastest [B] m/s
    """
    names, hull = list(waters.kinds), np.zeros(len(kind))
    ships = ship_tracks.sail(
        [names[i % len(names)] for i in kind], ranges, steps, rng, fastest, waters.kinds
    )
    for i, steered in enumerate(waters.steered.values(), len(names)):
        rows = np.flatnonzero(kind == i)
        own, hull[rows] = steered_tracks.sail(
            steered, ranges[rows], steps[rows], rng, fastest[rows]
        )
        ships = put(ships, rows, own)
    if waters.scenario is not None:
        rows = np.flatnonzero(kind == len(waters.names) - 1)
        ships = put(ships, rows, _targets(waters.scenario, steps[rows], rng))
    return ships, hull


def _targets(scenario: Scenario, steps, rng) -> Ships:
    """Stretches of the tracks of a scenario's targets, seen from own ship's place half-way.

    Raises ValueError if no target exists for long enough.
    """
    time = np.cumsum(steps, 1) - steps[:, :1]
    paths, longest = scenario.fleet.paths, time[:, -1].max()
    room = scenario.duration - longest
    ship, begin = np.broadcast_arrays(
        np.arange(1, paths.ships), np.linspace(0.0, max(room, 0.0), TRIES)[:, None]
    )
    there = motion.exist(paths, ship, begin) & motion.exist(paths, ship, begin + longest)
    if room <= 0 or not there.any():
        raise ValueError(
            f'scenario {scenario.name} has no target that is there for '
            f'{longest:.0f} s; make it longer'
        )
    pick = rng.integers(0, there.sum(), len(steps))
    at = begin[there][pick][:, None] + time
    position, velocity = motion.locate_ships(
        paths, np.broadcast_to(ship[there][pick][:, None], at.shape), at
    )
    own = np.zeros(len(at), np.int64)
    middle, _ = motion.locate_ships(paths, own, at[:, at.shape[1] // 2])
    acceleration = np.gradient(velocity, axis=1) / steps[..., None]
    return Ships(
        time,
        position - middle[:, None],
        velocity,
        np.hypot(*np.moveaxis(acceleration, -1, 0)) > TURNING,
    )
