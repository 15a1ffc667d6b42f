"""Plays a recorded folder as a node: its plots, own ship and truth, at their own times.

Publishes the same as radar_simulator, from plots.csv, own_ship.csv and truth.csv. Own ship comes as
often as it was recorded. Rate and `/clock`: see playback.py. The node ends when the recording has
ended, unless it loops. The values of radar.yaml are for the tracker; give them as its parameters.
"""

from collections.abc import Iterator
from typing import Any

from ..parameters import RecordingPlayerParameters
from ..recording import csv_folder
from ..types import take
from .base_node import RunnableNode
from .declare import declare
from .diagnostics import one_line
from .playback import Playback, Revolution


class RecordingPlayerNode(RunnableNode):
    """Plays a recording. ValueError if the parameters or the recording are wrong."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__('recording_player', **node_arguments)
        (parameters,) = declare(self, RecordingPlayerParameters)
        if not parameters.folder:
            raise ValueError('parameter folder is empty; it must name the folder of a recording')
        recording = csv_folder.read(parameters.folder)

        def revolutions() -> Iterator[Revolution]:
            for k, (scan, truth) in enumerate(zip(recording.scans, recording.truths)):
                yield Revolution(scan, truth, take(recording.own_ship, slice(k, k + 1)))

        self._playback = Playback(self, revolutions, parameters.rate, parameters.loop)
        self.get_logger().info(
            f'recording {one_line(recording.name)}, {len(recording.scans)} scans, '
            f'rate {parameters.rate:g}'
        )
        if recording.tracker_parameters:
            named = ', '.join(
                f'{name}: {value}' for name, value in recording.tracker_parameters.items()
            )
            self.get_logger().info(f'its radar.yaml has for the tracker {one_line(named, 2_000)}')

    @property
    def done(self) -> bool:
        """Whether the recording has ended."""
        return self._playback.done

    def close(self) -> None:
        """Let the last messages arrive."""
        self._playback.close()
