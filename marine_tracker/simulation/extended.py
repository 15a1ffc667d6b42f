"""The cells that the radar sees in a scenario: hulls of ships, and shores."""

from typing import NamedTuple

import numpy as np

from ..geometry import to_range_bearing
from ..types import Array, PolarPlots, Truth
from . import echoes, hull, land
from .scenario import Scenario

SHORE_SPACING = 0.5  # of the range resolution
EDGE_SPACING = 1.0  # m
HIDES = 2.0  # range resolutions; a shore hides what is farther behind it


class Scene(NamedTuple):
    """The scatterers of a scenario.

    hulls  those of ships
    shore  [L, 2]  m, east and north
    power  [L]     mean power of the shore's, over noise
    edge   [E, 2]  m, points along the shores; they hide what is behind them
    """

    hulls: hull.Scatterers
    shore: Array
    power: Array
    edge: Array


def scene(scenario: Scenario, random: np.random.Generator) -> Scene:
    """Places the scatterers, once a run.

    Rocks differ: the power of a shore's scatterers is exponential about its mean.
    """
    spacing = SHORE_SPACING * scenario.radar.range_resolution
    shore, power, edge = [np.empty((0, 2))], [np.empty(0)], [np.empty((0, 2))]
    for line in scenario.shores:
        places, _ = hull.along(line.corners, spacing, random)
        shore.append(places)
        edge.append(hull.along(line.corners, EDGE_SPACING, random)[0])
        power.append(10 ** (0.1 * line.snr_db) * random.exponential(size=len(places)))
    return Scene(
        hull.scatterers(scenario.fleet, random),
        np.concatenate(shore),
        np.concatenate(power),
        np.concatenate(edge),
    )


def plots(
    of: Scene, scenario: Scenario, start: float, truth: Truth, random: np.random.Generator
) -> PolarPlots:
    """The cells of one revolution, which begins at `start` s; truth: its ships."""
    own = scenario.own_ship_at(np.append(truth.time, start + 0.5 * scenario.radar.scan_period))
    offset, power = _hulls(of.hulls, scenario, start, truth, own)
    shore = of.shore - own.position[-1]
    shown = land.lit(shore, of.edge - own.position[-1], HIDES * scenario.radar.range_resolution)
    # The beam sees the shore as it passes, and own ship moves meanwhile.
    shore = shore[shown]
    shore -= (_passed(scenario, start, shore) - own.time[-1])[:, None] * own.velocity[-1]
    power = np.concatenate([power, of.power[shown]])
    echo = np.sqrt(0.5 * power) * (random.standard_normal((2, len(power))).T @ np.array([1, 1j]))
    distance, bearing = to_range_bearing(np.concatenate([offset, shore]))
    return echoes.cells(scenario.radar, start, distance, bearing, echo, random)


def _passed(scenario, start, offset):
    """Times [S] s when the beam passes offsets [S, 2] m in the revolution from `start` on."""
    return start + to_range_bearing(offset)[1] * (scenario.radar.scan_period / (2 * np.pi))


def _hulls(of, scenario, start, truth, own):
    """Offsets [S, 2] m from own ship, and mean power [S], of the ships' scatterers that are lit.

    Each is at its place at the time when the beam passes it. Part of a ship across north is met at
    one end of the revolution, and the rest at the other end.
    """
    row = np.full(scenario.fleet.paths.ships, -1)
    row[truth.target] = np.arange(len(truth.target))
    there = row[of.target] >= 0
    row = row[of.target[there]]
    velocity, middle = truth.velocity[row], truth.position[row]
    heading = scenario.fleet.hulls.heading[of.target[there] - 1]
    heading = np.where(np.isnan(heading), np.arctan2(*velocity.T), heading)
    own_position = own.position[row]
    offset, shown = hull.place(
        hull.Scatterers(*(field[there] for field in of)), middle, heading, own_position
    )
    offset = (offset + middle - own_position)[shown]
    row = row[shown]
    later = _passed(scenario, start, offset) - truth.time[row]
    offset += later[:, None] * (truth.velocity - own.velocity[:-1])[row]
    return offset, of.power[there][shown]
