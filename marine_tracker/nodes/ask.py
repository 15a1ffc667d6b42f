"""A question to a tracker that runs, from a process of its own: `marine_tracker explain`."""

import math
import time
from typing import Any, NamedTuple

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped
from nav_msgs.msg import Odometry
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from ..geometry import NAUTICAL_MILE, unit_vector
from . import convert, topics
from .diagnostics import OK, one_line
from .visitor import visitor

NODE = 'marine_tracker_explain'
VIDEO_S = 1.0  # longest wait for the extractor's word, after the tracker's


class Question(NamedTuple):
    """A place: NM and degrees (of the bow, or true) if polar, else m east and north."""

    first: float
    second: float
    polar: bool
    bow: bool


def ask(question: Question, namespace: str = '/', wait: float = 10.0) -> list[tuple[bool, str]]:
    """Whether each reason decides, and its words. ValueError if nobody answers in `wait` s."""
    with visitor(NODE, namespace) as (node, executor):
        return _asked(node, executor, question, time.monotonic() + wait)


def _asked(
    node: Node, executor: SingleThreadedExecutor, question: Question, until: float
) -> list[tuple[bool, str]]:
    heard: list[Any] = []
    own: list[Odometry] = []
    node.create_subscription(DiagnosticArray, topics.EXPLANATION, heard.append, topics.reliable())
    of_video: list[Any] = []
    node.create_subscription(
        DiagnosticArray, topics.VIDEO_EXPLANATION, of_video.append, topics.reliable()
    )
    questions = node.create_publisher(PointStamped, topics.EXPLAIN, topics.reliable())
    north = question.polar and not question.bow
    if north:
        node.create_subscription(Odometry, topics.ODOMETRY, own.append, topics.best_effort())

    def patient(done: Any, words: str) -> None:
        while not done():
            if time.monotonic() > until:
                raise ValueError(words)
            executor.spin_once(timeout_sec=0.1)

    # The answers' way must be open before the question goes out.
    patient(
        lambda: questions.get_subscription_count() and node.count_publishers(topics.EXPLANATION),
        f'no tracker listens to {questions.topic_name}: is one running, in this ROS domain?',
    )
    if north:
        patient(lambda: own, f'no own ship on {topics.ODOMETRY}: ask by --bow, or --east, --north')
    point = _point(question, own)
    questions.publish(point)
    patient(
        lambda: any(answer.header.stamp == point.header.stamp for answer in heard),
        'the tracker did not answer in time',
    )
    # Where plots come out of radar video, the extractor has its word as well.
    soon = min(time.monotonic() + VIDEO_S, until)
    while node.count_publishers(topics.VIDEO_EXPLANATION) and time.monotonic() < soon:
        if any(answer.header.stamp == point.header.stamp for answer in of_video):
            break
        executor.spin_once(timeout_sec=0.05)
    return [
        (entry.level != OK, one_line(entry.message))
        for answer in (*heard, *of_video)
        if answer.header.stamp == point.header.stamp
        for entry in answer.status
    ]


def _point(question: Question, own: list[Odometry]) -> PointStamped:
    frame, place = topics.FRAME, np.array([question.first, question.second])
    if question.polar:
        away, bearing = question.first * NAUTICAL_MILE, math.radians(question.second)
        place = away * unit_vector(bearing)
        if question.bow:
            frame, place = topics.OWN_SHIP_FRAME, np.array([place[1], -place[0]])  # ahead, port
        else:
            place = place + convert.odometry_to_own_ship(own[-1])[0]
    point = PointStamped(header=convert.header(time.time_ns(), frame))
    point.point.x, point.point.y = map(float, place)
    return point
