"""Ships of an independent simulation, to judge `gwnn` on what it has never seen.

It shares no code with the tracks of the training, and takes no part in the training or in any
choice for `gwnn`. Only a rival is tuned on it (`strangers_rival`). A ship follows a plan of
waypoints, or orders to the helm, through: line-of-sight guidance, a PID autopilot with a dead band,
a steering gear of limited rate, the nonlinear steering of Norrbin (1963), an engine that follows
its telegraph against the water's quadratic resistance, stream, gusts and waves (a resonant filter
on the yaw).
"""

from typing import NamedTuple

import numpy as np

from ...estimators.gwnn.bank_settings import PERIOD
from ...estimators.imm import Modes
from ...training.ship_tracks import Ships
from ...types import Array

TICK = 0.5  # s, at most, of the integration
BENDS = 0.04  # m/s^2, acceleration that counts as a manoeuvre
DEAD_BAND = np.radians(0.3)


class Craft(NamedTuple):
    """A class of ships. Pairs are least and most of uniform draws.

    length    m
    speed     m/s, at full ahead
    leg       s, mean time from waypoint to waypoint, or from order to order
    turn      deg, change of course there, either way
    conned    steered by orders of heading instead of along waypoints
    telegraph s, mean time between orders to the engine
    ahead     such orders, as shares of full ahead
    turning   K' and T' of Norrbin's equation: turning ability and slowness
    rudder    deg, largest angle
    gear      deg/s, rate of the steering gear
    inertia   lengths that the ship runs on at full ahead until the speed has followed the engine
    """

    length: tuple[float, float]
    speed: tuple[float, float]
    leg: float
    turn: tuple[float, float]
    conned: bool
    telegraph: float
    ahead: tuple[float, float]
    turning: tuple[tuple[float, float], tuple[float, float]]
    rudder: float
    gear: float
    inertia: float


CRAFT: dict[str, Craft | None] = {
    'still': None,
    'cargo': Craft(
        (90, 300), (5, 11), 420, (10, 60), False, 2500, (0.7, 1), ((0.8, 1.6), (1, 3.5)), 20, 2.5, 9
    ),
    'ferry': Craft(
        (50, 180), (6, 12), 200, (15, 90), False, 500, (0.4, 1), ((1, 2), (0.6, 1.8)), 30, 4, 6
    ),
    'tug': Craft(
        (22, 40), (3, 7), 90, (20, 150), True, 150, (0.2, 1), ((1.2, 2.2), (0.5, 1.2)), 35, 5, 4
    ),
    'trawler': Craft(
        (15, 45), (1.5, 6), 260, (30, 175), True, 700, (0.5, 1), ((1, 1.8), (0.6, 1.6)), 30, 4, 4
    ),
}

# The strongest IMMs on these ships that `experiments gwnn_rival` finds.
TUNED = {
    'training': Modes(
        noise=(7.7879e-06, 0.017143, 0.032258, 0.032258),
        turn_rate=(0, 0, 0.027577, -0.027577),
        stay=(0.99413, 0.97611, 0.95933, 0.95933),
        period=PERIOD,
    ),
    'manoeuvre': Modes(
        noise=(0.0025455, 0.0027151, 0.022747, 0.022747),
        turn_rate=(0, 0, 0.043699, -0.043699),
        stay=(0.91854, 0.93724, 0.88907, 0.88907),
        period=PERIOD,
    ),
}


def sail(name: str, steps: Array, rng: np.random.Generator) -> Ships:
    """Ships of a class for time steps [B, K] s; they begin at 2 to 14 km."""
    count, scans = steps.shape
    craft = CRAFT[name]
    angle, far = rng.uniform(0, 2 * np.pi, count), rng.uniform(2e3, 14e3, count)
    place = np.stack([far * np.sin(angle), far * np.cos(angle)], 1)
    time = np.cumsum(steps, 1) - steps[:, :1]
    if craft is None:
        course, speed = rng.uniform(0, 2 * np.pi, count), rng.uniform(2, 14, count)
        velocity = np.stack([speed * np.sin(course), speed * np.cos(course)], 1)[:, None]
        where = place[:, None] + time[..., None] * velocity
        return Ships(time, where, np.repeat(velocity, scans, 1), np.zeros(steps.shape, bool))
    ship = _Ship(craft, place, rng)
    where, velocity = np.empty((2, count, scans, 2))
    bends = np.empty((count, scans), bool)
    for k in range(scans):
        where[:, k], velocity[:, k], bends[:, k] = ship.place, ship.velocity(), ship.bends
        ahead = steps[:, min(k + 1, scans - 1)]
        ticks = int(np.ceil(ahead.max() / TICK))
        for _ in range(ticks):
            ship.go(ahead / ticks)
    return Ships(time, where, velocity, bends)


class _Ship:
    """B ships under way, [B] or [B, 2] each."""

    def __init__(self, craft: Craft, place: Array, rng: np.random.Generator) -> None:
        count = len(place)

        def draw(pair: tuple[float, float]) -> Array:
            return rng.uniform(pair[0], pair[1], count)

        self.craft, self.rng, self.place = craft, rng, place
        self.length, self.full = draw(craft.length), draw(craft.speed)
        self.ability, self.slowness = (draw(pair) for pair in craft.turning)
        self.bias = rng.normal(0, np.radians(1), count)  # of the rudder: wind, one screw
        self.telegraph = draw(craft.ahead)
        self.engine = self.telegraph.copy()
        self.surge = self.full * self.engine
        self.leg_course = draw((0, 2 * np.pi))
        self.leg_start = place.copy()
        self.left = rng.exponential(craft.leg, count) * self.surge  # m, of the leg
        self.heading = self.leg_course.copy()
        self.yaw_rate, self.rudder, self.summed = np.zeros((3, count))
        self.bends = np.zeros(count, bool)
        tide, knots = draw((0, 2 * np.pi)), draw((0, 1.2))
        self.stream = np.stack([knots * np.sin(tide), knots * np.cos(tide)], 1)
        self.gust = np.zeros(count)
        self.gustiness = draw((0, 0.12))  # m/s of leeway
        self.wave, self.wave_rate = np.zeros((2, count))
        self.encounter = draw((0.4, 1.1))  # rad/s
        self.sea = np.radians(draw((0, 0.25)))  # rad/s, deviation of the yaw rate in the waves

    def velocity(self) -> Array:
        """[B, 2] m/s over ground."""
        sin, cos = np.sin(self.heading), np.cos(self.heading)
        # The hull slides outwards in a turn; the pivot lies before the middle.
        sway = -0.35 * self.length * self.yaw_rate + self.gust
        return self.stream + np.stack(
            [self.surge * sin + sway * cos, self.surge * cos - sway * sin], 1
        )

    def go(self, dt: Array) -> None:
        """dt [B] s further."""
        craft, rng, count = self.craft, self.rng, len(dt)
        pace = np.maximum(self.surge, 0.8) / self.length
        wanted = self._guide(dt)
        off = (wanted - self.heading + np.pi) % (2 * np.pi) - np.pi
        off = np.sign(off) * np.maximum(np.abs(off) - DEAD_BAND, 0)
        near = np.abs(off) < np.radians(8)
        self.summed = np.where(near, np.clip(self.summed + off * dt, -3, 3), 0.9 * self.summed)
        order = 1.2 * off + 0.01 * self.summed - 1.1 * self.slowness / pace * self.yaw_rate
        most, gear = np.radians(craft.rudder), np.radians(craft.gear) * dt
        self.rudder += np.clip(np.clip(order, -most, most) - self.rudder, -gear, gear)

        bend = self.yaw_rate / pace
        moment = self.ability * (self.rudder + self.bias) - bend - 0.4 * bend**3
        self.yaw_rate = self.yaw_rate + dt * moment * pace * pace / self.slowness
        self.engine += np.clip(self.telegraph - self.engine, -dt / 25, dt / 25)
        self.telegraph = np.where(
            rng.random(count) < dt / craft.telegraph,
            rng.uniform(*craft.ahead, count),
            self.telegraph,
        )
        drive = (self.full * self.engine) ** 2 - (1 + 2.5 * bend**2) * self.surge**2
        push = drive / (craft.inertia * self.length)
        self.surge = np.maximum(self.surge + dt * push, 0.1)

        shake = self.sea * np.sqrt(0.4 * self.encounter / np.maximum(dt, 1e-6))
        pull = -0.2 * self.encounter * self.wave_rate - self.encounter**2 * self.wave
        self.wave_rate += dt * (pull + self.encounter * shake * rng.standard_normal(count))
        self.wave += dt * self.wave_rate
        self.gust += -dt / 50 * self.gust + self.gustiness * np.sqrt(dt / 25) * rng.standard_normal(
            count
        )
        self.heading = self.heading + dt * (self.yaw_rate + self.wave)
        self.place = self.place + dt[:, None] * self.velocity()
        self.bends = (np.abs(self.yaw_rate) * self.surge > BENDS) | (np.abs(push) > BENDS)

    def _guide(self, dt: Array) -> Array:
        """The heading [B] that is wanted: along the leg, back to its line if it has been left."""
        craft, rng, count = self.craft, self.rng, len(dt)
        self.left -= dt * self.surge
        new = self.left < 0
        side = np.where(rng.random(count) < 0.5, -1, 1)
        turn = np.where(new, side * np.radians(rng.uniform(*craft.turn, count)), 0.0)
        self.leg_course = self.leg_course + turn
        # The next line begins where the wheel-over makes the ship run into it.
        sin, cos = np.sin(self.leg_course), np.cos(self.leg_course)
        start = self.place + (2.0 * self.length * np.tan(np.abs(turn) / 3))[:, None] * np.stack(
            [np.sin(self.heading), np.cos(self.heading)], 1
        )
        self.leg_start = np.where(new[:, None], start, self.leg_start)
        self.left = np.where(new, rng.exponential(craft.leg, count) * self.surge, self.left)
        if craft.conned:
            return self.leg_course
        east, north = (self.place - self.leg_start).T
        beside = east * cos - north * sin  # m to starboard of the line
        return self.leg_course - np.arctan2(beside, 5 * self.length)
