"""Radar video of a scenario: spokes as a radar would give them, a revolution at a time.

The picture is physical (radar_equation.py, picture.py): ships by length and aspect, as scatterers
along their length that fluctuate from scan to scan; the sea; rain; shores with land behind them,
which hide what lies farther; other radars. The beam starts each revolution at true north.
"""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry import heading_at, to_range_bearing, unit_vector, wrap_bearing
from ..types import Array, FloatArray, OwnShip, Sweep, Truth, append
from . import beam, extended, land, picture
from . import radar_equation as equation
from .picture import Form, Points
from .scenario import Scenario
from .video_settings import VideoSettings

OWN_SHIP_SAMPLES = 26  # a revolution, both ends included: ten a second at 24 rpm
SPACING = 0.5  # of the pulse, of a ship's scatterers
INLAND = (0.0, 60.0, 130.0)  # m behind a shore, scatterers of the land
INLAND_POWER = 0.3
FROM_OTHERS = 55.0, 35.0  # dB over noise: strongest and weakest of another radar's pulses
OTHERS_SEEN = math.radians(50.0)  # width of the sector in which another radar is seen


class Turn(NamedTuple):
    """One revolution: its spokes, own ship meanwhile, and the truth."""

    sweep: Sweep
    own_ship: OwnShip
    truth: Truth


class Others(NamedTuple):
    """Other radars, I of them: bearing rad, pulses a second, phase, strongest amplitude."""

    bearing: Array
    rate: Array
    phase: Array
    power: Array


def simulate(scenario: Scenario, seed: int) -> Iterator[Turn]:
    """The revolutions of a scenario whose radar gives video. Same seed, same picture.

    ValueError where the scenario has no video.
    """
    radar, settings = scenario.radar, scenario.radar.video
    if settings is None:
        raise ValueError(f'scenario {scenario.name} has no video: its radar needs video: true')
    noise, ships, shore, others = (
        np.random.default_rng(child) for child in np.random.SeedSequence([seed, 77]).spawn(4)
    )
    of = picture.form(
        settings.spokes, settings.samples, radar.max_range, radar.beam_width, radar.range_resolution
    )
    factor = equation.point_factor(settings.power, of.pulse)
    scene = extended.scene(scenario, shore)
    about = _others(settings, others)
    for revolution in beam.revolutions(scenario):
        start, end = revolution.start, revolution.end
        own = scenario.own_ship_at(np.linspace(start, end, OWN_SHIP_SAMPLES))
        power = picture.background(of, factor, settings.sea_state, noise)
        middle = own.position[OWN_SHIP_SAMPLES // 2]
        for shower in settings.rain:
            offset = shower.place + shower.velocity * (0.5 * (start + end)) - middle
            picture.add_rain(power, of, factor, offset, shower.radius, shower.rate)
        edge = scene.edge - middle
        points = _together(
            _ships(scenario, of, factor, revolution.passages, edge, ships),
            _shores(scene, middle, of, factor, edge, shore),
        )
        power = picture.add_points(power, of, points, noise)
        number = np.arange(settings.spokes, dtype=np.float64)
        time = start + number * ((end - start) / settings.spokes)
        if settings.interference:
            _add_others(power, of, about, time)
        power[:, : int(radar.blind_range / of.step)] = 1e-6
        heading = heading_at(own, time)
        heading = np.where(np.isnan(heading), 0.0, heading)
        sweep = Sweep(
            time,
            wrap_bearing(of.bearing - heading),
            heading,
            np.full(settings.spokes, radar.max_range),
            picture.displayed(power, settings.bits),
        )
        yield Turn(sweep, own, revolution.truth)


def _ships(
    scenario: Scenario,
    of: Form,
    factor: float,
    passages: beam.Passages,
    edge: Array,
    random: np.random.Generator,
) -> Points:
    """The scatterers of all ships that the beam passes."""
    row = passages.target - 1
    length = scenario.fleet.length[row]
    course = np.arctan2(passages.velocity[:, 0], passages.velocity[:, 1])
    stated = scenario.fleet.hulls.heading[row]
    course = np.where(np.isnan(stated), course, stated)
    distance, bearing = to_range_bearing(passages.offset)
    section = equation.ship_section(length, bearing - course)
    count = np.maximum(np.rint(length / (SPACING * of.pulse)).astype(np.int64), 1)
    ship = np.repeat(np.arange(len(row)), count)
    first = np.repeat(np.cumsum(count) - count, count)
    share = (np.arange(len(ship)) - first + 0.5) / np.repeat(count, count) - 0.5
    place = passages.offset[ship] + (share * length[ship])[:, None] * unit_vector(course[ship])
    range_, bearing = to_range_bearing(place)
    mean = section[ship] / count[ship] * factor / np.maximum(range_, 10.0) ** 4
    if len(edge):
        mean = mean * land.lit(place, edge, 2 * of.pulse)
    # How fast it comes nearer turns the phase from spoke to spoke.
    own = scenario.own_ship_at(passages.time)
    closing = ((passages.velocity - own.velocity) * unit_vector(bearing_of(passages.offset))).sum(1)
    spoke = scenario.radar.scan_period / len(of.bearing)
    turning = np.mod(4 * np.pi / equation.WAVELENGTH * closing * spoke, 2 * np.pi)
    assert scenario.radar.video is not None
    amplitude = _amplitude(scenario.radar.video.swerling, len(ship), random)
    return Points(range_, bearing, np.sqrt(mean) * amplitude, turning[ship])


def bearing_of(offset: Array) -> Array:
    """Bearings [N] rad of offsets [N, 2] m."""
    return to_range_bearing(offset)[1]


def _amplitude(swerling: int, count: int, random: np.random.Generator) -> NDArray[np.complex128]:
    """Complex amplitudes of mean power 1. Swerling 1: exponential power; 3: chi-square of four."""
    power = random.standard_gamma(1.0 if swerling == 1 else 2.0, count)
    power = power if swerling == 1 else 0.5 * power
    found: NDArray[np.complex128] = np.sqrt(power) * np.exp(2j * np.pi * random.random(count))
    return found


def _shores(
    scene: extended.Scene,
    middle: Array,
    of: Form,
    factor: float,
    edge: Array,
    random: np.random.Generator,
) -> Points:
    """The scatterers of the land that is in sight: the shore, and what lies behind it.

    A shore's snr_db counts as dB over a square metre.
    """
    offset = scene.shore - middle
    if not len(offset):
        none = np.empty(0)
        return Points(none, none, none.astype(complex), none)
    range_, bearing = to_range_bearing(offset)
    behind = np.repeat(INLAND, len(offset)) * (0.5 + random.random(len(offset) * len(INLAND)))
    place = np.tile(offset, (len(INLAND), 1)) + behind[:, None] * np.tile(
        unit_vector(bearing), (len(INLAND), 1)
    )
    section = np.repeat([1.0, INLAND_POWER, INLAND_POWER**2], len(offset)) * np.tile(
        scene.power, len(INLAND)
    )
    shown = land.lit(place, edge, max(INLAND) * 1.6)
    range_, bearing = to_range_bearing(place[shown])
    mean = section[shown] * factor / np.maximum(range_, 10.0) ** 4
    echo = np.sqrt(mean) * _amplitude(1, len(mean), random)
    return Points(range_, bearing, echo, np.zeros(len(mean)))


def _together(one: Points, other: Points) -> Points:
    return append(one, other)


def _others(settings: VideoSettings, random: np.random.Generator) -> Others:
    """Other radars, somewhere about."""
    count = settings.interference
    strongest, weakest = FROM_OTHERS
    return Others(
        random.uniform(0, 2 * np.pi, count),
        random.uniform(700.0, 2500.0, count),
        random.random(count),
        10 ** (0.1 * random.uniform(weakest, strongest, count)),
    )


def _add_others(power: FloatArray, of: Form, others: Others, time: Array) -> None:
    """Adds the pulses of other radars, which come one way: alone in their spokes."""
    window = 2 * of.range[-1] / equation.LIGHT  # s that a spoke listens
    depth = max(round(of.pulse / of.step), 1)
    for bearing, rate, phase, strength in zip(*others):
        after = np.mod(phase - time * rate, 1.0) / rate  # s until its next pulse
        off = np.abs(np.mod(of.bearing - bearing + np.pi, 2 * np.pi) - np.pi)
        spoke = np.flatnonzero((after < window) & (off < OTHERS_SEEN))
        first = np.floor(after[spoke] / window * len(of.range)).astype(np.int64)
        column = np.minimum(first[:, None] + np.arange(depth), len(of.range) - 1)
        power[spoke[:, None], column] += np.float32(strength)
