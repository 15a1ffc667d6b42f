"""Recordings of spokes through the chain, drawn: the last picture, its plots, the tracks."""

import math
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...evaluation.video_source import tracker_parameters
from ...geometry import own_ship_at, unit_vector
from ...parameters import TrackerParameters, VideoParameters, from_mapping
from ...recording import spokes_file
from ...service import Service
from ...tracking.lifecycle import COASTING, CONFIRMED
from ...types import Array, PolarPlots
from ...video import chain, picture

SIZE = 900  # pixels
MOVING = 2.0 * 1852 / 3600  # m/s
# Beam widths of makers' data sheets, deg, by a word in the name of the file.
BEAMS = {'4g': 5.2, 'br24': 5.2, 'halo': 2.4}
DEFAULT_BEAM = 2.0


class Recorded(NamedTuple):
    """name; shown [SIZE, SIZE] north up to `reach` m; plots [M, 2] m of the last scan; tracks
    [N, 2] m with velocity [N, 2] m/s; plots a scan, confirmed moving targets alive, on average;
    plots of every scan."""

    name: str
    shown: NDArray[np.uint8]
    reach: float
    plots: Array
    tracks: Array
    velocity: Array
    mean_plots: float
    mean_moving: float
    every: list[PolarPlots]


def follow(path: Path) -> Recorded:
    """Takes a recording through extraction and tracker; a missing heading counts as 0."""
    video = spokes_file.read(path, 0.0)
    beam = next((width for word, width in BEAMS.items() if word in path.stem), DEFAULT_BEAM)
    parameters = VideoParameters(beam_width_deg=beam)
    service = Service(from_mapping(TrackerParameters, tracker_parameters(parameters, video.sweep)))
    memory, output = service.start(), None
    extraction = chain.Chain(parameters)
    known, polar = extraction.start(), picture.start()
    counts: list[tuple[int, int]] = []
    every: list[PolarPlots] = []
    last = np.empty((0, 2))
    for sweep in spokes_file.sweeps(video):
        times = sweep.time[np.isfinite(sweep.time)]
        if not len(times):
            continue
        own = spokes_file.own_ship_between(video.own_ship, float(times[0]), float(times[-1]))
        known, done = extraction.step(known, sweep, own)
        for spokes in done.placed:
            polar = picture.painted(polar, spokes)
        for scan in done.scans:
            memory, output = service.step(memory, scan)
            every.append(scan.plots)
            status = output.report.tracks.status
            alive = (status == CONFIRMED) | (status == COASTING)
            speed = np.hypot(*output.estimate.velocity[alive].T)
            counts.append((len(scan.plots.time), int((speed > MOVING).sum())))
            origin, _ = own_ship_at(scan.own_ship, scan.plots.time)
            last = origin + scan.plots.range[:, None] * unit_vector(scan.plots.bearing)
    assert output is not None
    status = output.report.tracks.status
    alive = (status == CONFIRMED) | (status == COASTING)
    newest = int(np.argmax(polar.time))
    mean = np.mean(counts, axis=0)
    return Recorded(
        path.stem,
        picture.north_up(polar, SIZE, float(polar.time[newest])),
        float(polar.step[newest] * polar.strength.shape[1]),
        last,
        output.estimate.position[alive],
        output.estimate.velocity[alive],
        float(mean[0]),
        float(mean[1]),
        every,
    )


def paint(canvas: Any, of: Recorded) -> None:
    """The picture with plots as rings, and tracks with a minute of way."""
    axis = canvas.subplots()
    reach = of.reach
    axis.imshow(of.shown, extent=(-reach, reach, -reach, reach), cmap='gist_heat', vmax=300)
    axis.plot(*of.plots.T, 'o', markersize=7, mfc='none', mec='c', mew=0.8, label='plots')
    axis.plot(*of.tracks.T, '+', color='lime', markersize=5, label='confirmed targets')
    for (x, y), (vx, vy) in zip(of.tracks, of.velocity):
        if math.hypot(vx, vy) > MOVING:
            axis.plot([x, x + 60 * vx], [y, y + 60 * vy], color='lime', linewidth=1)
    axis.set(xlim=(-reach, reach), ylim=(-reach, reach), xlabel='east, m', ylabel='north, m')
    axis.set_title(
        f'{of.name}: {of.mean_plots:.0f} plots a revolution, '
        f'{of.mean_moving:.1f} moving targets on average',
        fontsize=10,
    )
    axis.legend(fontsize=8, loc='upper right')
