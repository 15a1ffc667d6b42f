"""CPU cost of taking plots out of a revolution of radar video, in sectors of a sixteenth."""

import itertools
import time
from typing import Any, NamedTuple

import numpy as np

from ..parameters import VideoParameters
from ..simulation import scenario, video
from ..types import append, take
from ..video.chain import Chain
from . import video_source

SECTORS = 16
WARM_UP = 2  # revolutions
SCENE: dict[str, Any] = {
    'duration_s': 3600,
    'radar': {
        'rotation_rpm': 24,
        'max_range_nm': 12,
        'blind_range_m': 60,
        'range_resolution_m': 45,
        'beam_width_deg': 1.2,
        'video': {
            'spokes': 2048,
            'samples': 1024,
            'sea_state': 4,
            'interference': 2,
            'rain': [{'start': {'north_nm': 5, 'east_nm': -4}, 'radius_nm': 2, 'rate_mm_per_h': 8}],
        },
    },
    'own_ship': {'course_deg': 20, 'speed_kn': 10},
    'targets': [
        {
            'start': {'range_nm': 1.5 + 0.28 * k, 'bearing_deg': 17 * k % 360},
            'course_deg': 47 * k % 360,
            'speed_kn': 6 + k % 9,
            'length_m': 20 + 9 * k,
        }
        for k in range(30)
    ],
    'land': [{'name': 'coast', 'corners_nm': [[-8, -10], [-6, -4], [-7, 0], [-6, 5], [-9, 10]]}],
}


class VideoCost(NamedTuple):
    """cpu_s: median of a revolution; latency: 99th percentile of how long after the beam a plot
    came out, in revolutions; plots: a revolution."""

    cpu_s: float
    latency: float
    plots: float


def benchmark(revolutions: int, seed: int) -> VideoCost:
    """Measures so many revolutions, after two that do not count."""
    chosen = scenario.build(SCENE, 'video benchmark')
    chain = Chain(video_source.for_scenario(chosen, VideoParameters()))
    memory = chain.start()
    period = chosen.radar.scan_period
    cpu, late, count = [], [], 0
    before = None
    for turn in itertools.islice(video.simulate(chosen, seed), revolutions + WARM_UP):
        own = turn.own_ship
        if before is not None:
            own = append(take(before, before.time < own.time[0]), own)
        before = turn.own_ship
        steps, spokes = [], len(turn.sweep.time)
        began = time.process_time()  # once a revolution: to ask is not free
        for first in range(0, spokes, spokes // SECTORS):
            part = take(turn.sweep, slice(first, first + spokes // SECTORS))
            memory, done = chain.step(memory, part, own)
            steps.append((part.time[-1], done.found))
        cpu.append(time.process_time() - began)
        for now, every in steps:
            for found in every:
                late += ((now - found.plots.time) / period).tolist()
                count += len(found.plots.time)
    measured = cpu[WARM_UP:]
    return VideoCost(
        float(np.median(measured)),
        float(np.percentile(late, 99)) if late else np.nan,
        count / len(cpu),
    )
