"""Radar video as a source of scans: spokes of a file through the extraction."""

import math
from collections import Counter
from typing import Any, NamedTuple

import numpy as np

from ..parameters import VideoParameters
from ..recording import spokes_file
from ..types import Array, Sweep
from ..video import chain
from .source import Source


class VideoOptions(NamedTuple):
    """How plots are taken out of spokes.

    parameters  of the extraction
    heading     rad, own ship's where a recording tells none; None: none
    """

    parameters: VideoParameters
    heading: float | None = None


DEFAULT_VIDEO = VideoOptions(VideoParameters())


def open_recording(path: str, options: VideoOptions) -> Source:
    """A file of spokes; ValueError where it is none, or tells no heading and none is stated."""
    video = spokes_file.read(path, options.heading)
    own_ship = video.own_ship
    if own_ship.heading is None and not np.isfinite(video.sweep.heading).any():
        raise ValueError(video.remarks[0])
    counts: Counter[str] = Counter()
    scans = chain.run(
        chain.Chain(options.parameters),
        spokes_file.sweeps(video),
        lambda start, end: spokes_file.own_ship_between(own_ship, start, end),
        counts.update,
    )

    def told() -> tuple[str, ...]:
        reasons = ', '.join(f'{count} {reason}' for reason, count in counts.items())
        return (f'recording {video.name}: {reasons}',) if reasons else ()

    return Source(
        enumerate(scans),
        None,
        tracker_parameters(options.parameters, video.sweep),
        video.remarks,
        told,
    )


def tracker_parameters(parameters: VideoParameters, sweep: Sweep) -> dict[str, Any]:
    """The tracker parameters for plots from such spokes.

    Each plot has a covariance of its own; these sigmas are a typical one's.
    """
    range_ = sweep.range[np.isfinite(sweep.range) & (sweep.range > 0)]
    longest = float(range_.max(initial=100.0))
    step = float(np.median(range_)) / sweep.strength.shape[1] if len(range_) else 1.0
    pulse = parameters.pulse_length_m or 2 * step
    return {
        'range_sigma_m': min(max(0.3 * pulse, 1.0), 1000.0),
        'bearing_sigma_deg': min(max(0.15 * parameters.beam_width_deg, 0.01), 10.0),
        'range_resolution_m': min(max(pulse, 1.0), 1000.0),
        'beam_width_deg': parameters.beam_width_deg,
        'min_range_m': parameters.blind_range_m,
        'max_range_m': min(max(longest, 100.0, parameters.blind_range_m + 1.0), 200_000.0),
        'scan_period_s': min(max(_period(sweep.time, sweep.angle), 0.2), 120.0),
    }


def _period(time: Array, angle: Array) -> float:
    """s of a revolution, from the first spokes."""
    good = np.flatnonzero(np.isfinite(time) & np.isfinite(angle))[:4096]
    if len(good) < 2:
        return 60.0 / 22.0
    turn = np.mod(np.diff(angle[good]), 2 * math.pi).sum()
    return float((time[good[-1]] - time[good[0]]) * 2 * math.pi / max(turn, 1e-3))
