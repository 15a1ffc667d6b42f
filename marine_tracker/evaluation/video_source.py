"""Radar video as a source of scans: spokes of a file through the extraction."""

import dataclasses
import math
from collections import Counter
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from ..parameters import GLINT_SIGMA, VideoParameters
from ..recording import spokes_file
from ..simulation import video
from ..simulation.scenario import Scenario
from ..types import Array, OwnShip, Scan, Sweep, Truth, append, take
from ..video import chain
from ..video.lobes import SHORTEST
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
    recorded = spokes_file.read(path, options.heading)
    own_ship = recorded.own_ship
    if own_ship.heading is None and not np.isfinite(recorded.sweep.heading).any():
        raise ValueError(recorded.remarks[0])
    counts: Counter[str] = Counter()
    scans = chain.run(
        chain.Chain(options.parameters),
        spokes_file.sweeps(recorded),
        lambda start, end: spokes_file.own_ship_between(own_ship, start, end),
        counts.update,
    )

    def told() -> tuple[str, ...]:
        reasons = ', '.join(f'{count} {reason}' for reason, count in counts.items())
        return (f'recording {recorded.name}: {reasons}',) if reasons else ()

    return Source(
        enumerate(scans),
        None,
        tracker_parameters(options.parameters, recorded.sweep),
        recorded.remarks,
        told,
    )


def open_scenario(chosen: Scenario, seed: int, options: VideoOptions) -> Source:
    """A scenario whose radar gives video, run with `seed`.

    Beam width, pulse length and blind range are the scenario's, where `options` leave them at
    their defaults.
    """
    parameters = for_scenario(chosen, options.parameters)
    return Source(
        enumerate(scan for scan, _ in scans_with_truth(chosen, seed, parameters)),
        chosen.scans,
        scenario_tracker_parameters(chosen, parameters),
        chosen.fleet.remarks,
    )


def for_scenario(chosen: Scenario, given: VideoParameters) -> VideoParameters:
    """The parameters of the extraction for the radar of a scenario."""
    radar, default = chosen.radar, VideoParameters()
    own: dict[str, Any] = {
        'beam_width_deg': math.degrees(radar.beam_width),
        'pulse_length_m': radar.range_resolution,
        'blind_range_m': radar.blind_range,
    }
    return dataclasses.replace(
        given, **{k: v for k, v in own.items() if getattr(given, k) == getattr(default, k)}
    )


def scans_with_truth(
    chosen: Scenario, seed: int, parameters: VideoParameters
) -> Iterator[tuple[Scan, Truth]]:
    """The scans of a scenario with video, each with the truth of the revolution that it covers."""
    extraction = chain.Chain(parameters)
    memory, own, truth = extraction.start(), None, None
    for turn in video.simulate(chosen, seed):
        own = turn.own_ship if own is None else _joined(own, turn.own_ship)
        memory, done = extraction.step(memory, turn.sweep, own)
        own = own if not done.scans else turn.own_ship
        for scan in done.scans:
            yield scan, truth or turn.truth
        truth = turn.truth
    assert own is not None and truth is not None
    memory, done = extraction.end(memory, own)
    for scan in done.scans:
        yield scan, truth


def _joined(before: OwnShip, after: OwnShip) -> OwnShip:
    """Own ship's samples of two revolutions."""
    return append(take(before, before.time < after.time[0]), after)


def scenario_tracker_parameters(chosen: Scenario, parameters: VideoParameters) -> dict[str, Any]:
    """The tracker's parameters for a scenario with video."""
    return {
        **chosen.tracker_parameters(),
        'range_sigma_m': max(0.3 * parameters.pulse_length_m, 0.1),
        'bearing_sigma_deg': max(0.15 * parameters.beam_width_deg, 0.01),
        **chosen.stated,
    }


def tracker_parameters(parameters: VideoParameters, sweep: Sweep) -> dict[str, Any]:
    """The tracker parameters for plots from such spokes.

    Each plot has a covariance of its own; these sigmas are a typical one's.
    """
    range_ = sweep.range[np.isfinite(sweep.range) & (sweep.range > 0)]
    longest = float(range_.max(initial=100.0))
    step = float(np.median(range_)) / sweep.strength.shape[1] if len(range_) else 1.0
    pulse = parameters.pulse_length_m or max(2 * step, SHORTEST)
    return {
        'range_sigma_m': min(max(0.3 * pulse, 1.0), 1000.0),
        'bearing_sigma_deg': min(max(0.15 * parameters.beam_width_deg, 0.01), 10.0),
        # Close by the parts of a ship are resolved: what echoes wanders over less than the ship.
        'glint_sigma_m': min(GLINT_SIGMA['ship'], longest / 200.0),
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
