"""Plays a recording as a node: its plots, own ship and truth, at their own times.

Publishes the same as radar_simulator, from plots.csv, own_ship.csv and truth.csv of a folder, or
from the topics in MCAP files. Nothing else of those is played: logs, alarms and health of the past
would pass for new. Own ship comes as often as it was recorded. Rate and `/clock`: see playback.py.
The node ends when the recording has ended, unless it loops. The values of radar.yaml, and the
parameters that were recorded, are for the tracker; give them as its parameters.
"""

from pathlib import Path
from typing import Any

from ..geodesy import LocalFrame
from ..parameters import RecordingPlayerParameters
from ..recording import csv_folder
from ..recording.mcap_name import is_mcap
from ..types import take
from .base_node import RunnableNode
from .declare import declare
from .diagnostics import one_line
from .playback import Playback, Revolution


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

    @property
    def done(self) -> bool:
        """Whether the recording has ended."""
        return self._playback.done

    def close(self) -> None:
        """Let the last messages arrive."""
        self._playback.close()
