"""Why there is no target at a place: asked on the topic `explain`, answered on `explanation`.

The question is a PointStamped in `map`, or in `base_link` (metres ahead and to port). The answer is
a DiagnosticArray with the question's stamp: one entry a reason, the deciding ones first (level
WARN), then what is known beside (OK).
"""

import time
from collections import deque
from collections.abc import Callable
from itertools import chain

import numpy as np
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PointStamped
from rclpy.clock import Clock, ClockType

from ..arpa.explain import explain
from ..arpa.explain_plots import SCANS, Reason, Seen, seen
from ..service import Output, Service, ServiceMemory
from ..types import Array
from . import convert, topics
from .base_node import RunnableNode
from .diagnostics import OK, WARN, one_line, status

MOST = 20  # questions of one asker that wait for their answers
REASONS = 40  # of one answer
VIDEO_S = 0.5  # longest wait for the extractor's word, after the tracker's


class Explanations:
    """The tracker's side: keeps the last scans, and answers.

    point   the position [2] m of a question in `map`, or ValueError
    now     the service and its memory, as they are; and s without scans, see explain
    """

    def __init__(
        self,
        node: RunnableNode,
        now: Callable[[], tuple[Service, ServiceMemory, float]],
        point: Callable[[PointStamped], Array],
        hardware_id: str,
    ) -> None:
        self._now, self._point, self._hardware_id = now, point, hardware_id
        self._recent: list[deque[Seen]] = [deque(maxlen=SCANS) for _ in now()[0].arpa.radars]
        self._to_answers = node.publisher(DiagnosticArray, topics.EXPLANATION, topics.reliable())
        node.subscription(PointStamped, topics.EXPLAIN, self._on_question, topics.reliable())

    def take(self, output: Output) -> None:
        """A scan was taken: only looked at when somebody asks."""
        kept = seen(output.report, output.estimate, output.picture)
        self._recent[kept.scan.radar].append(kept)

    def _on_question(self, message: PointStamped) -> None:
        try:
            reasons = self._answer(self._point(message))
        except ValueError as error:
            reasons = [Reason('question', one_line(error), True)]
        answer = DiagnosticArray(
            status=[
                status(
                    reason.about, self._hardware_id, WARN if reason.decides else OK, reason.text, {}
                )
                for reason in reasons[:REASONS]
            ]
        )
        answer.header.stamp, answer.header.frame_id = message.header.stamp, topics.FRAME
        self._to_answers.publish(answer)

    def _answer(self, position: Array) -> list[Reason]:
        if not np.isfinite(position).all():
            raise ValueError(f'the place asked about is {position}; it must be two finite numbers')
        service, memory, silent = self._now()
        land = memory.extents.land if service.extents.on else None
        return explain(
            position,
            service.tracker,
            service.arpa,
            memory.tracker,
            memory.arpa,
            land,
            sorted(chain.from_iterable(self._recent), key=lambda one: one.scan.end),
            silent,
        )


class Asker:
    """Who asks: of a node. Answers are told apart by the stamp, which counts up."""

    def __init__(self, node: RunnableNode) -> None:
        self._to_questions = node.publisher(PointStamped, topics.EXPLAIN, topics.reliable())
        self._waiting: dict[tuple[int, int], Callable[[str], None]] = {}
        node.subscription(DiagnosticArray, topics.EXPLANATION, self._on_answer, topics.reliable())
        # Of radar video the extractor has its word as well: the tracker's waits for it a moment.
        self._node, self._of_video = node, dict[tuple[int, int], str]()
        self._held: dict[tuple[int, int], str] = {}
        node.subscription(
            DiagnosticArray, topics.VIDEO_EXPLANATION, self._on_video, topics.reliable()
        )
        node.create_timer(VIDEO_S, self._flush, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def ask(
        self, x: float, y: float, hear: Callable[[str], None], frame: str = topics.FRAME
    ) -> None:
        """hear(the reasons, one a line), later. ValueError where no tracker listens."""
        if not self._to_questions.get_subscription_count():
            raise ValueError(f'no tracker listens to {self._to_questions.topic_name}')
        point = PointStamped(header=convert.header(time.time_ns(), frame))
        point.point.x, point.point.y = x, y
        if len(self._waiting) >= MOST:  # a tracker that never answered
            self._waiting.pop(next(iter(self._waiting)))
        self._waiting[_key(point.header.stamp)] = hear
        self._to_questions.publish(point)

    def _on_answer(self, message: DiagnosticArray) -> None:
        key, text = _key(message.header.stamp), _lines(message)
        if key not in self._waiting:
            return
        if key in self._of_video or not self._node.count_publishers(topics.VIDEO_EXPLANATION):
            self._tell(key, text)
        else:
            self._held[key] = text

    def _on_video(self, message: DiagnosticArray) -> None:
        key = _key(message.header.stamp)
        if key in self._waiting:
            self._of_video[key] = _lines(message)
            if key in self._held:
                self._tell(key, self._held[key])

    def _flush(self) -> None:
        for key, text in tuple(self._held.items()):
            self._tell(key, text)

    def _tell(self, key: tuple[int, int], text: str) -> None:
        more = self._of_video.pop(key, '')
        self._held.pop(key, None)
        hear = self._waiting.pop(key, None)
        if hear:
            hear(f'{text}\n{more}' if more else text)


def _line(entry: DiagnosticStatus) -> str:
    return one_line(entry.message)


def _key(stamp: Time) -> tuple[int, int]:
    return stamp.sec, stamp.nanosec


def _lines(message: DiagnosticArray) -> str:
    """The reasons, one a line."""
    return '\n'.join(map(_line, message.status[:REASONS]))
