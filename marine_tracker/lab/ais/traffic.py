"""Scenes of ships with and without AIS, run through the service, with the truth beside."""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...ais.pairs import Pairs
from ...ais.sentences import Sentences
from ...parameters import AisParameters, TrackerParameters, from_mapping
from ...service import Output, Service
from ...simulation import ais_sentences, radar, scenario, transponders
from ...simulation.scenario import Scenario
from ...tracking.lifecycle import LOST
from ...types import Array, Scan

EPOCH = 1_700_000_000.0  # s of UTC at time 0 of a scene
OWN_PLACE = 150.0  # m; a track so near a ship, and to no other, is hers
LANE = 300.0  # m between the ships of the lane
IN_LANE = 12
SPOOFED, SPOOFED_FROM = 4, (150.0, 210.0)  # ships of a scene; s
ORIGIN = {'lat_deg': 54.2, 'lon_deg': 6.1}


def scene(
    seed: int,
    ships: int = 40,
    minutes: float = 8.0,
    send: dict[str, Any] | None = None,
    spoof: dict[str, Any] | None = None,
    **top: Any,
) -> Scenario:
    """Ships all about own ship, of many courses and speeds, twelve of them in a lane."""
    rng = np.random.default_rng(np.random.SeedSequence([seed, 3]))
    targets = []
    course = float(rng.uniform(0, 360))
    speed = float(rng.uniform(8, 14))
    along = np.array([np.sin(np.radians(course)), np.cos(np.radians(course))])
    middle = rng.uniform(1.5, 4.0) * 1852 * np.array([along[1], -along[0]])
    for k in range(ships):
        if k < IN_LANE:
            place = middle + (k - IN_LANE / 2) * LANE * along
            its = course, speed
        else:
            range_, bearing = rng.uniform(1.0, 9.0) * 1852, rng.uniform(0, 2 * np.pi)
            place = range_ * np.array([np.sin(bearing), np.cos(bearing)])
            its = float(rng.uniform(0, 360)), float(rng.uniform(4, 20))
        target = {
            'name': f'ship {k + 1}',
            'start': {'north_m': float(place[1]), 'east_m': float(place[0])},
            'course_deg': its[0],
            'speed_kn': its[1],
            'length_m': float(rng.uniform(30, 200)),
        }
        if k >= IN_LANE and rng.random() < 0.3:
            turn = float(rng.choice([-1, 1]) * rng.uniform(20, 60))
            target['legs'] = [
                {'straight': {'duration_s': float(rng.uniform(60, 300))}},
                {'turn': {'angle_deg': turn, 'rate_deg_per_s': 0.5}},
            ]
        targets.append(target)
    chosen = rng.permutation(ships)[: SPOOFED if spoof else 0].tolist()
    for k in chosen:
        begins, way = float(rng.uniform(*SPOOFED_FROM)), float(rng.uniform(0, 360))
        small = rng.random() < 0.1
        targets[k]['ais'] = {
            'class': 'b' if small else 'a',
            'spoof': {**(spoof or {}), 'from_s': begins, 'bearing_deg': way},
        }
    values = {
        'duration_s': 60 * minutes,
        'origin': ORIGIN,
        'radar': {'max_range_nm': 12, 'pd_near': 0.95, 'pd_far': 0.9},
        'own_ship': {'course_deg': 20, 'speed_kn': 10},
        'ais': {'send': {'share': 0.7, 'class_b': 0.1, 'latency_s': 10, **(send or {})}},
        'targets': targets,
        **top,
    }
    return scenario.build(values, f'ais {seed}')


def biased(scans: Iterator[Any], range_: float, bearing: float) -> Iterator[tuple[Scan, Any]]:
    """The scans of a radar that measures range_ m too much, and bearing rad."""
    for scan, truth in scans:
        plots = scan.plots
        plots = plots._replace(range=plots.range + range_, bearing=plots.bearing + bearing)
        yield scan._replace(plots=plots), truth


class Moment(NamedTuple):
    """A scan: its output; truth of the ships [T, 2] m at its end, nan where none exists; which ship
    each track is [N], of the report's tracks, 0 for none and -1 where that is not sure; the pairs
    of ships and tracks with their evidence."""

    output: Output
    place: Array
    ship: NDArray[np.int64]
    pairs: Pairs


def follow(
    of: Scenario,
    seed: int,
    errors: tuple[float, float] = (0.0, 0.0),
    parameters: dict[str, Any] | None = None,
    each: Callable[[Moment], None] = lambda moment: None,
    **tracker: Any,
) -> Service:
    """Runs a scene through the service, AIS as sentences; `each` sees every scan.

    errors      m, rad: of the radar's range and bearing
    parameters  of AIS;  tracker  those of the tracker beside the scene's
    """
    service = Service(
        from_mapping(TrackerParameters, {**of.tracker_parameters(), **tracker}),
        ais=from_mapping(AisParameters, parameters or {}),
    )
    memory, frame, fleet = service.start(), of.fleet.origin, of.fleet
    assert frame is not None and fleet.ais is not None
    sentences = Sentences()
    sent = transponders.transmit(fleet.ais, fleet.paths, fleet.length, of.duration, seed)
    lines = (
        pair for some in sent for pair in ais_sentences.encode(some, frame, fleet.names, EPOCH)
    )
    waiting = next(lines, None)
    for scan, _ in biased(radar.simulate(of, seed), *errors):
        while waiting is not None and waiting[0] <= scan.end:
            for line in waiting[1]:
                sentences.take(line, waiting[0] + EPOCH)
            waiting = next(lines, None)
        reports = sentences.reports()
        reports = reports._replace(heard=reports.heard - EPOCH, time=reports.time - EPOCH)
        memory = service.hear(
            memory, reports, frame.to_local_or_nan(reports.latitude, reports.longitude)
        )
        memory, output = service.step(memory, scan)
        truth = of.truth_at(scan.end)
        place = np.full((fleet.paths.ships - 1, 2), np.nan)
        place[truth.target - 1] = truth.position
        ship = whose(of, scan.end, output, place, errors)
        each(Moment(output, place, ship, memory.ais.pairs))
    return service


def whose(
    of: Scenario, now: float, output: Output, place: Array, errors: tuple[float, float]
) -> NDArray[np.int64]:
    """[N] the ship of each track: the nearest, where no other is nearly as near; else -1; 0 where
    none is within OWN_PLACE."""
    tracks = output.report.tracks
    count = len(tracks.id)
    if not count:
        return np.zeros(0, np.int64)
    own = of.own_ship_at(now).position[0]
    offset = place - own
    range_, bearing = np.hypot(*offset.T), np.arctan2(*offset.T)
    seen = own + (range_ + errors[0])[:, None] * np.stack(
        [np.sin(bearing + errors[1]), np.cos(bearing + errors[1])], -1
    )
    estimate = output.estimate
    at_end = estimate.position + (now - estimate.time)[:, None] * estimate.velocity
    away = np.linalg.norm(at_end[:, None] - seen, axis=2)
    away[:, np.isnan(place[:, 0])] = np.inf
    order = np.argsort(away, axis=1)
    first = away[np.arange(count), order[:, 0]]
    found = np.where(first < OWN_PLACE, order[:, 0] + 1, 0)
    if away.shape[1] > 1:
        second = away[np.arange(count), order[:, 1]]
        found = np.where((found > 0) & (second < 2 * first + 20), -1, found)
    return np.where(tracks.status == LOST, 0, found)


def number_of(mmsi: NDArray[np.int64]) -> NDArray[np.int64]:
    """The ship, from 1 on, of each number that the simulator gave."""
    return mmsi - transponders.FIRST_MMSI + 1
