"""Recordings and scenarios through the service in process, faster than real time."""

import csv
import tempfile
import time
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import IO, Any, NamedTuple

import numpy as np

from ..arpa import alarms, alerts
from ..arpa.alarm_text import parts, text
from ..arpa.situation import DANGERS
from ..arpa.targets import label
from ..geometry import NAUTICAL_MILE
from ..recording import csv_folder, spokes_file, track_file
from ..recording.csv_folder import Recording
from ..recording.mcap_name import is_mcap
from ..recording.track_file import TargetColumns, TrackRows
from ..service import Output, Service, service_for
from ..simulation import radar, scenario
from ..tracking import offsets
from ..tracking.lifecycle import CONFIRMED, STATUS_NAMES
from ..tracking.radars import fused, merged
from ..types import Scan
from . import metrics, screened, video_source
from .source import Source
from .video_source import DEFAULT_VIDEO, VideoOptions

NAMES = np.array(STATUS_NAMES)
ALARM_COLUMNS = ('time_s', 'alarm', 'target', 'where', 'priority', 'state', 'text')


class Summary(NamedTuple):
    """Number of scans; number of tracks ever confirmed; the service's mean CPU time a scan in ms;
    whether any plots had radial speeds; pairs left out in crowds (tracking/pair_budget.py); tracks
    ever confirmed that surely moved; stationary objects ever shown (tracking/at_rest.py); what is
    known of each radar's offsets (tracking/offsets.py).
    """

    scans: int
    confirmed: int
    cpu_ms: float
    doppler: bool
    left_out: int
    moving: int
    stationary: int
    offsets: tuple[dict[str, str], ...]


def open_source(name: str, seed: int = 1, video: VideoOptions = DEFAULT_VIDEO) -> Source:
    """A recording if `name` is a folder, a file of spokes or an MCAP file, else a scenario run with
    `seed`.

    video  how plots are taken out of spokes
    ValueError if it is none of these, or has an error.
    """
    if spokes_file.is_spokes_file(name):
        return video_source.open_recording(name, video)
    if Path(name).is_dir() or is_mcap(name):
        recording, remarks = screened.read(name)
        numbers = recording.numbers.tolist()
        return Source(
            zip(numbers, recording.scans), len(numbers), recording.tracker_parameters, remarks
        )
    chosen = scenario.load(name)
    if chosen.radar.video is not None:
        return video_source.open_scenario(chosen, seed, video)
    simulated = enumerate(scan for scan, _ in radar.simulate(chosen, seed))
    return Source(simulated, None, chosen.tracker_parameters(), chosen.fleet.remarks)


def fuse(names: Sequence[str], seed: int = 1, video: VideoOptions = DEFAULT_VIDEO) -> Source:
    """The sources of one scene combined, each as a radar of its own. A single source is returned as
    it is.

    Scans are numbered in the order of their ends. Each scenario has its own noise: seeds count up
    from `seed`.
    """
    sources = [open_source(name, seed + k, video) for k, name in enumerate(names)]
    if len(sources) == 1:
        return sources[0]
    radars = [f'radar_{k}' for k in range(1, len(sources) + 1)]
    totals = [source.total for source in sources if source.total is not None]
    return Source(
        enumerate(merged(*((scan for _, scan in source.scans) for source in sources))),
        sum(totals) if len(totals) == len(sources) else None,
        fused([source.tracker_parameters for source in sources], radars),
        sum((source.remarks for source in sources), ()),
    )


def run(service: Service, scans: Iterable[Scan]) -> Iterator[Output]:
    """The output of each scan. Own ship's heading is its course."""
    memory = service.start()
    for scan in scans:
        memory, output = service.step(memory, scan)
        yield output


def write_tracks(
    service: Service,
    scans: Iterable[tuple[int, Scan]],
    file: IO[str],
    alarm_file: IO[str] | None = None,
) -> Summary:
    """Runs the service over numbered scans and writes the results after each scan.

    One row a track; in `alarm_file` one row for each alert that changes.
    """
    confirmed: set[int] = set()
    moved: set[int] = set()
    stationary: set[int] = set()
    count, cpu, doppler, left_out = 0, 0.0, False, 0
    memory = service.start()
    track_file.write_header(file)
    if alarm_file:
        csv.writer(alarm_file, lineterminator='\n').writerow(ALARM_COLUMNS)
    for number, scan in scans:
        began = time.process_time()
        memory, output = service.step(memory, scan)
        cpu += time.process_time() - began
        left_out += output.report.left_out
        tracks = output.report.tracks
        track_file.write_scan(
            file,
            number,
            output.estimate,
            tracks.id,
            NAMES[tracks.status],
            output.report.predicted,
            output.report.plot,
            scan.own_ship,
            service.tracker.parameters.estimator,
            target_columns(output),
        )
        if alarm_file:
            _write_alarms(alarm_file, service, output)
        confirmed.update(tracks.id[tracks.status == CONFIRMED].tolist())
        moved.update(memory.tracker.ground.moving.tolist())
        stationary.update(output.picture.fixed.shown.number.tolist())
        count += 1
        doppler |= scan.plots.radial_speed is not None
    cpu_ms = 1e3 * cpu / max(count, 1)
    moving = len(confirmed & moved)
    off = tuple(offsets.in_words(radar.offsets) for radar in memory.tracker.radars)
    return Summary(count, len(confirmed), cpu_ms, doppler, left_out, moving, len(stationary), off)


def target_columns(output: Output) -> TargetColumns:
    """The target columns of a track file for N tracks: target data and sizes."""
    picture, count = output.picture, len(output.report.tracks.id)

    def of_targets(values):
        column = np.full(count, np.nan)
        column[picture.row] = values
        return column

    danger = np.full(count, '', dtype='<U9')
    danger[picture.row] = np.array(DANGERS)[picture.danger]
    length, beam, heading = np.full((3, count), np.nan)
    if output.shapes is not None:
        sized = output.shapes.extended
        length[sized] = output.shapes.length[sized]
        beam[sized] = output.shapes.beam[sized]
        heading[sized] = output.shapes.heading[sized]
    return TargetColumns(
        output.report.tracks.number,
        of_targets(picture.approach.cpa / NAUTICAL_MILE),
        of_targets(picture.approach.tcpa / 60),
        danger,
        of_targets(picture.approach.danger_probability),
        length,
        beam,
        heading,
    )


def _write_alarms(file: IO[str], service: Service, output: Output) -> None:
    changed = output.picture.changed
    radars = [radar.name for radar in service.arpa.radars]
    zones = service.arpa.zones
    rows = zip(
        changed.kind.tolist(),
        [name if id else '' for id, name in zip(changed.id, label(changed.id, changed.number))],
        parts(changed, zones, radars),
        changed.state.tolist(),
        text(changed, zones, radars),
    )
    csv.writer(file, lineterminator='\n').writerows(
        (
            f'{output.picture.time:.4f}',
            alarms.NAMES[kind],
            name,
            where,
            alarms.PRIORITY[kind],
            alerts.STATES[state],
            words,
        )
        for kind, name, where, state, words in rows
    )


def figures(recording: Recording, estimator: str) -> dict[str, Any]:
    """`metrics.score` of the tracks, with the recording's own parameters and this estimator."""
    service = service_for(recording.tracker_parameters, estimator=estimator)
    return metrics.score(recording, follow(service, recording)).figures


def follow(service: Service, recording: Recording) -> TrackRows:
    """The rows that `write_tracks` would write, with the columns that scores need."""
    rows = []
    for number, output in zip(recording.numbers.tolist(), run(service, recording.scans)):
        tracks, now = output.report.tracks, output.estimate
        rows.append(
            (
                now.time,
                tracks.id.astype(str),
                NAMES[tracks.status],
                now.position,
                now.velocity,
                output.report.predicted,
                np.full(len(now.time), number),
            )
        )
    return TrackRows(*map(np.concatenate, zip(*rows)))


def simulated(chosen: scenario.Scenario, seed: int) -> Recording:
    """A scenario as a recording."""
    with tempfile.TemporaryDirectory() as work:
        folder = Path(work, chosen.name)
        csv_folder.write(
            folder, chosen.name, radar.simulate(chosen, seed), chosen.tracker_parameters()
        )
        return csv_folder.read(folder)
