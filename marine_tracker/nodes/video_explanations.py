"""Why there is no plot at a place, from the video.

Asked on `explain` as the tracker is, answered on `video_explanation` with the question's stamp.
"""

import math
from collections.abc import Callable

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped

from ..types import Array
from ..video.explain import Why
from . import topics
from .base_node import RunnableNode
from .diagnostics import OK, WARN, status
from .faults import bare

ABOUT = 'video'


class VideoExplanations:
    """why(point in the map, point ahead and to port of own ship): one of them is None."""

    def __init__(
        self, node: RunnableNode, why: Callable[[Array | None, Array | None], list[Why]]
    ) -> None:
        self._why, self._hardware_id = why, node.hardware_id
        self._to_answers = node.publisher(
            DiagnosticArray, topics.VIDEO_EXPLANATION, topics.reliable()
        )
        node.subscription(PointStamped, topics.EXPLAIN, self._on_question, topics.reliable())

    def _on_question(self, message: PointStamped) -> None:
        place = np.array([message.point.x, message.point.y])
        if not all(map(math.isfinite, place)):
            return  # the tracker says so
        on_board = bare(message.header.frame_id) == topics.OWN_SHIP_FRAME
        reasons = self._why(None, place) if on_board else self._why(place, None)
        answer = DiagnosticArray(
            status=[
                status(
                    ABOUT, self._hardware_id, WARN if one.decides else OK, f'video: {one.text}', {}
                )
                for one in reasons
            ]
        )
        answer.header.stamp, answer.header.frame_id = message.header.stamp, topics.FRAME
        self._to_answers.publish(answer)
