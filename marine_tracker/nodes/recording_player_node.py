"""Plays a recording as a node: its plots, own ship and truth, at their own times.

A file of spokes (recording/spokes_file.py) is played as `radar/spokes`, with own ship.

Else it publishes the same as radar_simulator, from plots.csv, own_ship.csv and truth.csv of a
folder, or from the topics in MCAP files. Nothing else of those is played: logs, alarms and health
of the past would pass for new. Own ship comes as often as it was recorded. Rate and `/clock`: see
playback.py. The node ends when the recording has ended, unless it loops. The values of radar.yaml,
and the parameters that were recorded, are for the tracker; give them as its parameters.
"""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ..geodesy import LocalFrame
from ..parameters import RecordingPlayerParameters
from ..recording import csv_folder, spokes_file
from ..recording.mcap_name import is_mcap
from ..types import OwnShip, Scan, Truth, take
from .base_node import RunnableNode
from .declare import declare
from .diagnostics import one_line
from .playback import NO_PLOTS, Playback, Revolution

NO_TRUTH = Truth(np.empty(0), np.empty(0, np.int64), np.empty((0, 2)), np.empty((0, 2)))


def _parts(video: spokes_file.Video) -> Iterator[Revolution]:
    """The spokes of a recording, some at a time, with own ship's samples of that time."""
    own_ship, before = video.own_ship, -math.inf
    for sweep in spokes_file.sweeps(video):
        time = sweep.time[np.isfinite(sweep.time)]
        if not len(time):
            continue
        start, end = float(time[0]), float(time.max())
        if video.own_ship.heading is None:  # at rest, with the heading that the spokes tell
            samples = OwnShip(
                time[-1:], np.zeros((1, 2)), np.zeros((1, 2)), sweep.heading[-1:].copy()
            )
        else:
            samples = take(own_ship, (own_ship.time > before) & (own_ship.time <= end))
        before = end
        scan = Scan(start, end, NO_PLOTS, spokes_file.own_ship_between(own_ship, start, end))
        yield Revolution(scan, NO_TRUTH, samples, sweep)


def _read(
    folder: str,
) -> tuple[list[Revolution], dict[str, Any], LocalFrame | None, tuple[str, ...]]:
    """The revolutions, the tracker's parameters, where the frame is, and remarks."""
    if is_mcap(folder):
        from ..recording import mcap_topics  # needs packages of the extra `record`

        inside = mcap_topics.contents(folder)
        played = [Revolution(*one) for one in mcap_topics.revolutions(inside)]
        return played, inside.parameters, mcap_topics.origin(inside), inside.files.remarks
    recording = csv_folder.read(folder)
    played = [
        Revolution(scan, truth, take(recording.own_ship, slice(k, k + 1)))
        for k, (scan, truth) in enumerate(zip(recording.scans, recording.truths))
    ]
    return played, recording.tracker_parameters, None, ()


class RecordingPlayerNode(RunnableNode):
    """Plays a recording. ValueError if the parameters or the recording are wrong."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__('recording_player', **node_arguments)
        (parameters,) = declare(self, RecordingPlayerParameters)
        if not parameters.folder:
            raise ValueError('parameter folder is empty; it must name the folder of a recording')
        if spokes_file.is_spokes_file(parameters.folder):
            self._playback = self._of_video(parameters)
            return
        played, for_tracker, origin, remarks = _read(parameters.folder)
        self._playback = Playback(
            self, lambda: iter(played), parameters.rate, parameters.loop, origin
        )
        for remark in remarks:
            self.get_logger().warning(one_line(remark))
        self.get_logger().info(
            f'recording {one_line(Path(parameters.folder).name)}, {len(played)} scans, '
            f'rate {parameters.rate:g}'
        )
        if for_tracker:
            named = ', '.join(f'{name}: {value}' for name, value in for_tracker.items())
            self.get_logger().info(f'it has for the tracker {one_line(named, 2_000)}')

    def _of_video(self, parameters: RecordingPlayerParameters) -> Playback:
        """Plays a file of spokes."""
        video = spokes_file.read(parameters.folder)
        for remark in video.remarks:
            self.get_logger().warning(one_line(remark))
        made = Playback(self, lambda: _parts(video), parameters.rate, parameters.loop)
        self.get_logger().info(
            f'recording {one_line(video.name)}, {len(video.sweep.time)} spokes, '
            f'rate {parameters.rate:g}'
        )
        return made

    @property
    def done(self) -> bool:
        """Whether the recording has ended."""
        return self._playback.done

    def close(self) -> None:
        """Let the last messages arrive."""
        self._playback.close()
