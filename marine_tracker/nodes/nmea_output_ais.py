"""AIS in what nmea_output sends: names of joined targets, sentences passed on, Signal K vessels."""

import time
import uuid
from collections.abc import Callable

import numpy as np
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import String

from ..ais.join import BOTH
from ..arpa import signalk
from ..arpa.nmea import AUTOMATIC, LOST, TRACKING, Targets
from . import ais_targets_cloud, topics
from .ais_cloud import text_of
from .base_node import RunnableNode
from .convert import nanoseconds
from .diagnostics import Tally, one_line
from .faults import ConversionError

LONGEST = 200  # characters of a sentence that is passed on
NO_SENTENCE = 'AIS sentences that are none'

Send = Callable[[list[str]], None]
Tell = Callable[[Targets, list[int], list[int], int], None]


class AisOutput:
    """What is known of the ships of AIS.

    send  sends sentences;  tell  tell(targets, numbers, mmsi, stamp) sends Signal K vessels
    """

    def __init__(
        self, node: RunnableNode, bad: Tally, passes: bool, send: Send, tell: Tell | None
    ) -> None:
        self._bad, self._send, self._tell = bad, send, tell
        self._names: dict[int, str] = {}
        node.subscription(PointCloud2, topics.AIS_TARGETS, self._on_ships, topics.latched(5))
        if passes:
            quality = topics.best_effort(topics.BURST)
            node.subscription(String, topics.AIS_SENTENCES, self._on_sentence, quality)

    def named(self, names: np.ndarray, mmsi: np.ndarray) -> np.ndarray:
        """The names [T] of targets; of those joined to a ship hers, or else her number."""
        found = [
            (self._names.get(one) or f'{one:09d}') if one else name
            for name, one in zip(names.tolist(), mmsi.tolist())
        ]
        return np.array(found, str)

    def _on_ships(self, message: PointCloud2) -> None:
        try:
            rows = ais_targets_cloud.read(message)
        except ConversionError as error:
            self._bad.add(error.reason, time.monotonic(), detail=str(error))
            return
        mmsi = rows['mmsi'].astype(np.int64)
        self._names = {
            number: one_line(name)
            for number, name in zip(mmsi.tolist(), text_of(rows['name']).tolist())
            if name
        }
        if self._tell is None:
            return
        alone = rows['state'] != BOTH
        rows, mmsi = rows[alone], mmsi[alone]
        count = len(rows)
        targets = Targets(
            np.ones(count, np.int64),
            np.where(rows['lost'] > 0, LOST, TRACKING),
            np.full(count, AUTOMATIC),
            self.named(np.full(count, ''), mmsi),
            *(rows[name] for name in ('range', 'bearing', 'speed', 'course', 'cpa', 'tcpa')),
        )
        numbers = mmsi.tolist()
        self._tell(targets, numbers, numbers, nanoseconds(message.header.stamp))

    def _on_sentence(self, message: String) -> None:
        line = message.data.strip()
        if not line.startswith(('!', '\\')) or len(line) > LONGEST or not line.isprintable():
            self._bad.add(NO_SENTENCE, time.monotonic(), detail=line)
            return
        if line.isascii():
            self._send([line])


def contexts(numbers: list[int], mmsi: list[int], vessels: uuid.UUID) -> list[str]:
    """The Signal K vessel of each target: by the MMSI where there is one."""
    return [
        f'vessels.urn:mrn:imo:mmsi:{one:09d}' if one else signalk.context(vessels, number)
        for number, one in zip(numbers, mmsi)
    ]
