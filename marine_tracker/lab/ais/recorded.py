"""A recording of spokes with the AIS of the same seconds: what is joined, and how far apart."""

import math
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pyais

from ...ais import join, registration
from ...ais.sentences import EPOCH, SECONDS, Sentences
from ...evaluation import report
from ...evaluation.report import Figure
from ...evaluation.result import Picture
from ...evaluation.video_source import tracker_parameters
from ...geodesy import LocalFrame
from ...geometry import own_ship_at, unit_vector
from ...parameters import TrackerParameters, VideoParameters, from_mapping
from ...recording import spokes_file
from ...service import Service
from ...types import Array, BoolArray
from ...video import chain

BEAM = 2.4  # deg, of the HALO's data sheet
MOVING = 2.0 * 1852 / 3600  # m/s
REACH = 20_000.0  # m
A_PLOT = 3.0  # deviations of AIS and radar within which a plot may be the ship's
BASE = 20 * EPOCH  # s; recorded times become those of a clock that is UTC but for whole minutes


class Recorded(NamedTuple):
    """V vessels of AIS at the end of a recording.

    name      of the file
    position  [V, 2]  m from own ship, as AIS says
    moving    [V]     faster than 2 kn
    plotted   [V]     a plot of the last revolution may be hers
    tracked   [V]     a confirmed track may be hers
    joined    [V]     joined to a track
    off       [V]     deviations by which joined pairs differ; nan for others
    tracks    [N, 2]  m, radar's
    errors    radar less AIS
    """

    name: str
    position: Array
    moving: BoolArray
    plotted: BoolArray
    tracked: BoolArray
    joined: BoolArray
    off: Array
    tracks: Array
    errors: registration.Registration


def read_lines(path: Path) -> tuple[list[tuple[float, str]], tuple[float, float]]:
    """The sentences with their seconds, and own ship's place: the median of all GLL."""
    lines, places = [], []
    for line in path.read_text('ascii', 'replace').splitlines():
        stamp = SECONDS.match(line)
        if not stamp:
            continue
        sentence = line[stamp.end() :]
        lines.append((float(stamp[1]), sentence))
        if sentence[3:6] == 'GLL':
            north, south, east, west = sentence.split(',')[1:5]
            places.append(
                (
                    (float(north[:2]) + float(north[2:]) / 60) * (1 if south == 'N' else -1),
                    _longitude(east) * (1 if west == 'E' else -1),
                )
            )
    if not places:
        raise ValueError(f'{path} has no GLL sentence: own ship is nowhere')
    latitude, longitude = np.median(np.array(places), axis=0).tolist()
    return lines, (latitude, longitude)


def _longitude(text: str) -> float:
    """Degrees of (d)ddmm.m: also where leading noughts are missing."""
    whole, _, part = text.partition('.')
    return float(whole[:-2]) + float(f'{whole[-2:]}.{part}') / 60


def clock(lines: list[tuple[float, str]]) -> float:
    """s that the recording's clock lacks of UTC's second: that by which most reports are a moment
    old when they come."""
    offsets = []
    for at, line in lines:
        if line[3:6] != 'VDM' or line.split(',')[1] != '1':
            continue
        second: Any = pyais.decode(line).asdict().get('second', 60)
        if second < 60:
            offsets.append((second - at) % 60)
    if not offsets:
        return 0.0
    found = np.array(offsets)
    grid = np.arange(0.0, 60.0, 0.25)
    late = (grid[:, None] - found) % 60
    return float(grid[int((late < 3.0).sum(1).argmax())])


def follow(path: Path) -> Recorded:
    """Takes spokes and sentences through extraction, tracker and AIS."""
    video = spokes_file.read(path, 0.0)
    lines, place = read_lines(path.with_suffix('.nmea'))
    shift, frame = BASE + clock(lines), LocalFrame(*place)
    parameters = VideoParameters(beam_width_deg=BEAM)
    service = Service(from_mapping(TrackerParameters, tracker_parameters(parameters, video.sweep)))
    memory, output, plots = service.start(), None, np.zeros((0, 2))
    extraction = chain.Chain(parameters)
    known, sentences = extraction.start(), Sentences()
    for sweep in spokes_file.sweeps(video):
        times = sweep.time[np.isfinite(sweep.time)]
        if not len(times):
            continue
        own = spokes_file.own_ship_between(video.own_ship, float(times[0]), float(times[-1]))
        known, done = extraction.step(known, sweep, own)
        for scan in done.scans:
            while lines and lines[0][0] <= scan.end:
                at, line = lines.pop(0)
                sentences.take(line, at + shift)
            reports = sentences.reports()
            reports = reports._replace(heard=reports.heard - shift, time=reports.time - shift)
            where = frame.to_local_or_nan(reports.latitude, reports.longitude)
            memory = service.hear(memory, reports, where)
            memory, output = service.step(memory, scan)
            origin, _ = own_ship_at(scan.own_ship, scan.plots.time)
            plots = origin + scan.plots.range[:, None] * unit_vector(scan.plots.bearing)
    assert output is not None and output.ais is not None
    ships, errors = output.ais, output.ais.registration
    near = ships.ships.placed & (np.hypot(*ships.moving.position.T) < REACH)
    rows = near.nonzero()[0]
    told = ships.moving.position[rows]
    sigma = np.sqrt(0.5 * np.trace(ships.moving.covariance[rows][:, :2, :2], axis1=1, axis2=2))
    tracks = output.report.tracks
    seen = output.estimate.position[tracks.number > 0]
    state, track = ships.joined.state[rows], ships.joined.track[rows]
    off = np.full(len(rows), np.nan)
    h = registration.jacobian(told)
    common = 0.5 * np.trace(h @ errors.covariance @ h.swapaxes(1, 2), axis1=1, axis2=2)
    for k in (state == join.BOTH).nonzero()[0].tolist():
        at = (tracks.id == track[k]).nonzero()[0][0]
        spread = math.sqrt(sigma[k] ** 2 + registration.PAIR**2 + common[k])
        spread = math.hypot(
            spread, math.sqrt(0.5 * np.trace(output.estimate.covariance[at, :2, :2]))
        )
        place_seen = registration.corrected(errors, output.estimate.position[at : at + 1])[0]
        off[k] = float(np.hypot(*(place_seen - told[k]))) / spread
    return Recorded(
        path.stem,
        told,
        np.nan_to_num(ships.ships.speed[rows]) > MOVING,
        _within(errors, told, sigma, plots),
        _within(errors, told, sigma, seen),
        state == join.BOTH,
        off,
        seen,
        errors,
    )


def _within(errors: registration.Registration, told: Array, sigma: Array, seen: Array) -> BoolArray:
    """Mask [V]: something seen [M, 2] m lies where AIS says."""
    if not len(seen):
        return np.zeros(len(told), bool)
    away = np.linalg.norm(told[:, None] - registration.corrected(errors, seen), axis=2).min(1)
    range_ = np.hypot(*told.T)
    cell = np.hypot(registration.PAIR + 25.0, range_ * math.radians(BEAM) / 4)
    found: BoolArray = away < A_PLOT * np.hypot(sigma, cell)
    return found


def figures(found: Recorded) -> list[Figure]:
    """Of one recording."""
    moving, name = found.moving, found.name
    value, spread = found.errors.value, np.sqrt(np.diag(found.errors.covariance))
    there = moving & found.tracked
    return [
        Figure(f'{name}: vessels within 20 km', len(moving)),
        Figure(f'{name}: moving', int(moving.sum())),
        Figure(f'{name}: moving with a plot', int((moving & found.plotted).sum())),
        Figure(f'{name}: moving with a confirmed track', int(there.sum())),
        Figure(f'{name}: moving and joined', int((moving & found.joined).sum())),
        Figure(f'{name}: at rest and joined', int((~moving & found.joined).sum())),
        report.at_most(
            f'{name}: moving with a plot, not joined',
            int((moving & found.plotted & ~found.joined).sum()),
            0,
        ),
        report.at_most(
            f'{name}: joined, deviations apart, most', float(np.nanmax(found.off, initial=0.0)), 3.0
        ),
        Figure(f'{name}: range error of the radar', float(value[0]), 'm'),
        Figure(f'{name}: its deviation', float(spread[0]), 'm'),
        Figure(f'{name}: bearing error of the radar', float(np.degrees(value[1])), 'deg'),
        Figure(f'{name}: its deviation', float(np.degrees(spread[1])), 'deg'),
    ]


def picture(found: Recorded) -> Picture:
    """Ships and tracks about own ship."""

    def paint(canvas: Any) -> None:
        axis = canvas.subplots()
        axis.plot(*found.tracks.T, '.', color='0.6', markersize=4, label='radar tracks')
        for mask, colour, label in (
            (found.joined & found.moving, 'C2', 'moving, joined'),
            (found.joined & ~found.moving, 'C0', 'at rest, joined'),
            (~found.joined & found.moving, 'C3', 'moving, AIS only'),
            (~found.joined & ~found.moving, 'C1', 'at rest, AIS only'),
        ):
            axis.plot(*found.position[mask].T, '^', mfc='none', mec=colour, label=label)
        axis.set(xlabel='east, m', ylabel='north, m', aspect='equal')
        axis.legend(fontsize=8)

    return Picture(f'ais_{found.name}', (7, 7), paint)
