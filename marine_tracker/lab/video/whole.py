"""The whole chain in a simulated scene, from spokes to targets, beside a threshold and blobs."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from ...evaluation import video_source
from ...geometry import to_range_bearing
from ...parameters import TrackerParameters, VideoParameters, from_mapping
from ...service import Service
from ...simulation import land, picture, radar_equation, scenario, video
from ...simulation.scenario import Scenario
from ...tracking.lifecycle import COASTING, CONFIRMED
from ...types import Array, BoolArray, Scan, Truth
from . import rival

SHIPS = 20
WITHIN = 300.0  # m; a target no farther from a ship is that ship
MOVING = 2.0 * 1852 / 3600  # m/s
VISIBLE_DB = 16.0  # mean power over noise and sea from which a ship can be detected
BEGIN_S = 60.0  # a ship must have been visible so long before it must be held
LOST_S = 30.0  # and is not judged so shortly before or after it is not
RIVAL_THRESHOLD = 0.5  # of full strength: noise 32 dB below it
NEAR_LAND = 600.0  # m


class Held(NamedTuple):
    """Of one run.

    held      share of their detectable time that ships are targets: the worst, and the mean
    false     false moving targets alive, on average
    on_land   targets within NEAR_LAND of the shore and away from ships, on average
    plots     a revolution
    """

    worst: float
    mean: float
    false: float
    on_land: float
    plots: float


def scene(minutes: float, seed: int, spokes: int = 1440, samples: int = 512) -> Scenario:
    """20 ships, sea state 4, a coast, a shower and two other radars."""
    random = np.random.default_rng([seed, 5])
    ships = []
    for k in range(SHIPS):
        away, angle = random.uniform(1.2, 4.8), random.uniform(-130, 130)
        north = away * math.cos(math.radians(angle))
        east = away * math.sin(math.radians(angle))
        ships.append(
            {
                'name': f'ship {k + 1}',
                'start': {'north_nm': north, 'east_nm': east},
                'course_deg': float(random.uniform(-180, 180)),
                'speed_kn': float(random.uniform(4, 14)),
                'length_m': float(random.choice([25, 40, 60, 90, 140, 200])),
            }
        )
    values: dict[str, Any] = {
        'description': '20 ships, sea state 4, coast, rain, other radars',
        'duration_s': 60.0 * minutes,
        'radar': {
            'rotation_rpm': 24,
            'max_range_nm': 6,
            'blind_range_m': 60,
            'range_resolution_m': 35,
            'beam_width_deg': 1.2,
            'video': {
                'spokes': spokes,
                'samples': samples,
                'sea_state': 4,
                'interference': 2,
                'rain': [
                    {
                        'start': {'north_nm': 2.5, 'east_nm': -3},
                        'radius_nm': 1.0,
                        'rate_mm_per_h': 10,
                        'course_deg': 80,
                        'speed_kn': 15,
                    }
                ],
            },
        },
        'own_ship': {'course_deg': 90, 'speed_kn': 6},
        'targets': ships,
        'land': [
            {
                'name': 'coast',
                'corners_nm': [[-5, -7], [-4, -3], [-4.4, 0], [-3.8, 3], [-4.5, 7], [-4.2, 11]],
                'snr_db': 25,
            }
        ],
    }
    return scenario.build(values, 'video_scene')


def visible(chosen: Scenario, truth: Truth) -> BoolArray:
    """[T] whether ships are in range, not behind land, and their mean echo clear of the sea, as far
    as the display can show it."""
    radar = chosen.radar
    assert radar.video is not None
    own = chosen.own_ship_at(truth.time)
    range_, bearing = to_range_bearing(truth.position - own.position)
    course = np.arctan2(truth.velocity[:, 0], truth.velocity[:, 1])
    length = chosen.fleet.length[truth.target - 1]
    pulse, beam = radar.range_resolution, radar.beam_width
    factor = radar_equation.point_factor(radar.video.power, pulse) / range_**4
    # Of a ship longer than the pulse, a cell holds a part.
    part = np.minimum(pulse / length, 1.0)
    echo = radar_equation.ship_section(length, bearing - course) * part * factor
    sea, _ = radar_equation.sea(range_, beam, pulse, radar.video.sea_state)
    rain = np.zeros(len(range_))
    for shower in radar.video.rain:
        away = truth.position - shower.place - shower.velocity * truth.time[:, None]
        wet = np.hypot(*away.T) < shower.radius
        rain += wet * radar_equation.rain(range_, beam, pulse, shower.rate) * factor
    clutter = 1 + sea * factor + rain
    shown = np.minimum(10 * np.log10(echo), picture.SPAN_DB - picture.NOISE_DB)
    clear = shown - 10 * np.log10(clutter) >= VISIBLE_DB
    edge = np.concatenate([along(shore.corners) for shore in chosen.shores])
    lit = land.lit(truth.position - own.position, edge - own.position.mean(0), 0.0)
    inside: BoolArray = (range_ < radar.max_range - 100) & (range_ > radar.blind_range + 50)
    return clear & lit & inside


def along(corners: Array) -> Array:
    """Points of a line, 20 m apart."""
    parts = []
    for a, b in zip(corners, corners[1:]):
        count = max(int(np.hypot(*(b - a)) / 20.0), 1)
        parts.append(a + (np.arange(count) / count)[:, None] * (b - a))
    return np.concatenate(parts)


def by_rival(chosen: Scenario, seed: int) -> Iterator[tuple[Scan, Truth]]:
    """The same pictures through a fixed threshold and blobs."""
    settings = chosen.radar.video
    assert settings is not None
    threshold = round(RIVAL_THRESHOLD * (2**settings.bits - 1))
    step = chosen.radar.max_range / settings.samples
    for turn in video.simulate(chosen, seed):
        sweep = turn.sweep
        true = np.arange(settings.spokes, dtype=np.float64) * (2 * np.pi / settings.spokes)
        plots = rival.blobs(
            sweep.strength, sweep.time, true, step, threshold, VideoParameters().max_size_m
        )
        yield Scan(float(sweep.time[0]), turn.own_ship.time[-1], plots, turn.own_ship), turn.truth


def run(chosen: Scenario, scans: Iterator[tuple[Scan, Truth]], parameters: dict[str, Any]) -> Held:
    """Tracks the scans and judges the targets by the truth."""
    service = Service(from_mapping(TrackerParameters, parameters))
    memory = service.start()
    ships = chosen.fleet.paths.ships - 1
    since = np.full(ships, np.nan)  # s, from when on a ship has been visible
    judged, held = np.zeros(ships), np.zeros(ships)
    pending: list[tuple[float, Array, BoolArray]] = []
    false, on_land, plots, count = 0.0, 0.0, 0, 0
    shore = np.concatenate([along(one.corners) for one in chosen.shores])
    for scan, _ in scans:
        memory, output = service.step(memory, scan)
        now = scan.end
        truth = chosen.truth_at(min(now, chosen.duration))
        shown = np.zeros(ships, bool)
        shown[truth.target - 1] = visible(chosen, truth)
        since = np.where(shown, np.where(np.isnan(since), now, since), np.nan)
        tracks, estimate = output.report.tracks, output.estimate
        alive = (tracks.status == CONFIRMED) | (tracks.status == COASTING)
        position = (
            estimate.position[alive]
            + (now - estimate.time[alive])[:, None] * (estimate.velocity[alive])
        )
        speed = np.hypot(*estimate.velocity[alive].T)
        away = np.linalg.norm(position[:, None] - truth.position, axis=2)
        has = np.zeros(ships, bool)
        has[truth.target - 1] = (away < WITHIN).any(0) if len(position) else False
        pending.append((now, since.copy(), has))
        nobody: BoolArray = (away >= WITHIN).all(1)
        to_shore = np.array([np.hypot(*(shore - p).T).min() for p in position[nobody]])
        false += (speed[nobody] > MOVING).sum()
        on_land += (to_shore < NEAR_LAND).sum()
        plots += len(scan.plots.time)
        count += 1
    end = pending[-1][0]
    last_seen = np.full(ships, end)
    for now, began, has in reversed(pending):
        gone = np.isnan(began)
        last_seen = np.where(gone, now, last_seen)
        ready = (now - began > BEGIN_S) & (last_seen - now > LOST_S)
        judged += ready
        held += ready & has
    share = held[judged > 20] / judged[judged > 20]
    worst = float(share.min()) if len(share) else math.nan
    mean = float(share.mean()) if len(share) else math.nan
    return Held(worst, mean, false / count, on_land / count, plots / count)


def both(minutes: float, seed: int) -> tuple[Held, Held]:
    """This chain, and the rival."""
    chosen = scene(minutes, seed)
    parameters = video_source.for_scenario(chosen, VideoParameters())
    for_tracker = video_source.scenario_tracker_parameters(chosen, parameters)
    ours = run(chosen, video_source.scans_with_truth(chosen, seed, parameters), for_tracker)
    theirs = run(chosen, by_rival(chosen, seed), for_tracker)
    return ours, theirs
