"""The simulated radar: one scan and its truth for each revolution of the antenna.

Echoes of the ships that the beam meets are detected or not, merged within a resolution cell, given
errors, and mixed with false plots. A plot's time is when the beam met the target. Ships with a
hull, and shores, give cells instead (extended.py).
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ..geometry import to_range_bearing, unit_vector, wrap_angle, wrap_bearing
from ..types import Array, PolarPlots, Scan, Truth, append, take
from . import beam, clutter, extended, reflectors, sensor_errors
from .echoes import STRONGEST, THRESHOLD
from .scenario import Scenario
from .scenario_radar import ScenarioRadar

OWN_SHIP_SAMPLES = 4  # a revolution, both ends included


class Echoes(NamedTuple):
    """Echoes of points over the threshold, E rows.

    time [E] s, when the beam met them; distance [E] m; power [E] over noise; error [E, 2] m and rad
    of a plot of each; radial_speed [E] m/s as measured, None where the radar has no Doppler
    """

    time: Array
    distance: Array
    power: Array
    error: Array
    radial_speed: Array | None = None


def simulate(scenario: Scenario, seed: int) -> Iterator[tuple[Scan, Truth]]:
    """The scans of a scenario and the truth of each, a pair for every whole revolution.

    Plots are in time order. Truth has a row for every target that exists, at the time when the beam
    passed it (see beam.Revolution). The same scenario and seed give exactly the same plots. Each
    kind of random draw has its own stream: clutter or detection do not change the noise of targets.
    """
    detection, noise, uniform, sea, errors, reckoning, doppler, false_doppler, cells, ashore = (
        np.random.default_rng(child) for child in np.random.SeedSequence(seed).spawn(10)
    )
    radar = scenario.radar
    imo = sensor_errors.draw(errors) if radar.sensor_errors == 'imo' else None
    drift = np.zeros(2)
    scene = extended.scene(scenario, cells) if scenario.in_cells else None
    point = np.isnan(scenario.fleet.hulls.beam)  # targets that give one plot
    chance_ashore = reflectors.begin(scenario.fixed, ashore)
    for start, end, passages, truth in beam.revolutions(scenario):
        # Draws are made for every ship (own ship's are unused) and for both possible passages, seen
        # or not. So the use of one stream never depends on the results of another.
        shape = (2, scenario.fleet.paths.ships)
        chance = detection.exponential(size=shape)
        white = noise.standard_normal(shape + (2,))
        deviation = white * [radar.range_sigma, radar.bearing_sigma]
        if imo is not None:
            passages, deviation = _imo(scenario, imo, passages, errors, shape)

        passages = take(passages, point[passages.target - 1])
        distance, _ = to_range_bearing(passages.offset)
        seen, power = _detect(
            scenario, passages.target, distance, chance[passages.turn, passages.target]
        )
        turn, target = passages.turn[seen], passages.target[seen]
        echoes = Echoes(passages.time[seen], distance[seen], power[seen], deviation[turn, target])
        if radar.radial_speed_sigma is not None:
            shift = radar.radial_speed_sigma * doppler.standard_normal(shape)
            echoes = echoes._replace(
                radial_speed=_radial_speed(passages)[seen] + shift[turn, target]
            )
        fixed, chance_ashore = _ashore(scenario, start, chance_ashore)
        plots = _resolve(radar, append(echoes, fixed), start)
        plots = take(plots, plots.range > 0)
        plots = append(plots, _false_plots(scenario, start, uniform, sea, false_doppler))
        if scene is not None:
            plots = append(plots, extended.plots(scene, scenario, start, truth, cells))
        plots = take(plots, np.argsort(plots.time, kind='stable'))

        own_ship = scenario.own_ship_at(np.linspace(start, end, OWN_SHIP_SAMPLES))
        if imo is not None:
            own_ship, drift = sensor_errors.reckon(imo, own_ship, drift, reckoning)
        yield Scan(start, end, plots, own_ship), truth


def _detect(scenario, target, distance, chance):
    """[P] which passages give an echo over the threshold, and its power over noise.

    A slowly fluctuating ship (Swerling 1) of mean power s is seen with probability exp(-threshold /
    s). s falls with the fourth power of range. So the probability is pd_near (pd_far /
    pd_near)^((range / max_range)^4).
    """
    radar, fleet = scenario.radar, scenario.fleet
    pd = radar.pd_near * (radar.pd_far / radar.pd_near) ** ((distance / radar.max_range) ** 4)
    pd = np.where(
        np.isnan(fleet.pd[target - 1]), pd * fleet.pd_factor[target - 1], fleet.pd[target - 1]
    )
    with np.errstate(divide='ignore'):
        mean = THRESHOLD / -np.log(np.minimum(pd, STRONGEST))
    power = chance * mean
    seen = (
        ((power > THRESHOLD) | (pd >= 1))
        & (distance >= radar.blind_range)
        & (distance <= radar.max_range)
    )
    return seen, np.maximum(power, THRESHOLD)


def _ashore(scenario, start, chance):
    """Echoes of the fixed things in the revolution from `start` s on, and the chance of the next
    one."""
    radar = scenario.radar
    seen, following = reflectors.echoes(scenario.fixed, radar, scenario.own_ship_at, start, chance)
    error = chance.random.standard_normal((len(seen.time), 2))
    speed = None
    if radar.radial_speed_sigma is not None:
        speed = radar.radial_speed_sigma * chance.random.standard_normal(len(seen.time))
    error *= [radar.range_sigma, radar.bearing_sigma]
    return Echoes(seen.time, seen.distance, seen.power, error, speed), following


def _resolve(radar: ScenarioRadar, echoes, start):
    """Plots with their errors, one a resolution cell.

    Echoes closer than a cell in range and in the beam's angle merge, also in chains. The plot lies
    at the centre weighted by amplitude; its errors and radial speed are those of the strongest
    echo. Echoes on different sides of north belong to different revolutions and are not merged.
    """
    turn = 2 * np.pi / radar.scan_period
    time, distance, power, row = echoes.time, echoes.distance, echoes.power, slice(None)
    if radar.range_resolution > 0 and radar.beam_width > 0 and len(time) > 1:
        cells = np.column_stack(
            [distance / radar.range_resolution, (time - start) * turn / radar.beam_width]
        )
        pairs = cKDTree(cells).query_pairs(1.0, p=np.inf, output_type='ndarray')
        if len(pairs):
            graph = coo_array((np.ones(len(pairs)), pairs.T), shape=(len(time), len(time)))
            count, group = connected_components(graph, directed=False)
            weight = np.sqrt(power)
            total = np.bincount(group, weight, count)
            distance = np.bincount(group, weight * distance, count) / total
            time = start + np.bincount(group, weight * (time - start), count) / total
            strongest = np.lexsort((-power, group))
            row = strongest[np.append(True, np.diff(group[strongest]) > 0)]
            power = np.bincount(group, power, count)
    error = echoes.error[row]
    speed = None if echoes.radial_speed is None else echoes.radial_speed[row]
    return PolarPlots(
        time,
        distance + error[:, 0] + radar.range_bias,
        wrap_bearing(turn * (time - start) + error[:, 1] + radar.bearing_bias),
        10 * np.log10(power),
        speed,
    )


def _radial_speed(passages):
    """[P] m/s over ground along the line of sight, positive when opening."""
    _, bearing = to_range_bearing(passages.offset)
    return (passages.velocity * unit_vector(bearing)).sum(1)


def _false_plots(scenario, start, uniform, sea, doppler):
    radar = scenario.radar
    kinds = (
        clutter.uniform_plots(scenario.clutter, radar, uniform),
        clutter.sea_plots(scenario.clutter, radar, sea),
    )
    distance, bearing, excess = (np.concatenate(columns) for columns in zip(*kinds, strict=True))
    speed = None
    if radar.radial_speed_sigma is not None:
        noise, waves = (len(kind[0]) for kind in kinds)
        speed = clutter.radial_speeds(radar, noise, waves, doppler)
    return PolarPlots(
        start + bearing * radar.scan_period / (2 * np.pi),
        distance,
        bearing,
        10 * np.log10(THRESHOLD + excess),
        speed,
    )


def _imo(scenario, imo, passages, random, shape):
    """The passages moved by glint, and errors of range and bearing [2, 1 + T, 2] of any passage."""
    row = (passages.turn, passages.target)
    velocity = np.zeros(shape + (2,))
    relative, time = np.zeros(shape), np.zeros(shape)
    heading = scenario.own_ship_at(passages.time).velocity
    relative[row] = to_range_bearing(passages.offset)[1] - np.arctan2(heading[:, 0], heading[:, 1])
    time[row], velocity[row] = passages.time, passages.velocity
    length = np.concatenate([[0.0], scenario.fleet.length])
    glint = sensor_errors.glint(velocity, np.broadcast_to(length, shape), random)[row]
    errors = np.stack(sensor_errors.measurement_errors(imo, time, relative, random), -1)
    moved = passages.offset + glint
    errors[*row, 1] += wrap_angle(to_range_bearing(moved)[1] - to_range_bearing(passages.offset)[1])
    return passages._replace(offset=moved), errors
