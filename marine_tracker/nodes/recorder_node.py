"""Records the topics of the service into MCAP files, as they are, and the tracker's parameters.

What is recorded is on disk within a second. A full disk ends the recording with a whole file and an
error on /diagnostics; nothing else is touched by it.
"""

import json
import time
from functools import partial
from typing import Any

from rcl_interfaces.msg import ParameterEvent
from rcl_interfaces.srv import GetParameters
from rclpy.clock import Clock, ClockType
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.parameter import parameter_value_to_python
from rclpy.qos import DurabilityPolicy
from rclpy.subscription import Subscription

from ..parameter_files import fields
from ..parameters import RecorderParameters
from ..recording.mcap_write import McapLog, Message, Topic
from . import recorded_topics
from .base_node import RunnableNode, State
from .declare import declare
from .diagnostics import ERROR, OK, WARN, one_line
from .message_definitions import definition
from .recorded_topics import SILENT_S, Wanted
from .recorder_writing import Writing

STUCK_S = 5.0  # s without a write while messages wait


class _Heard:
    """One topic: what was asked for, and how it fares."""

    def __init__(self, wanted: Wanted, topic: Topic, subscription: Subscription) -> None:
        self.wanted, self.topic, self.subscription = wanted, topic, subscription
        self.count = self.lost = 0
        self.sequence: int | None = None
        self.at = time.monotonic()
        self.publishers = 0


class RecorderNode(RunnableNode):
    """See the module. ValueError, OSError where it cannot record there."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__('recorder', **node_arguments)
        (p,) = declare(self, RecorderParameters)
        wanted = recorded_topics.of_this_package(p.plots_topics.split(), p.without.split())
        self._others = [name for name in p.topics.split() if name not in {w.name for w in wanted}]
        self._not_installed: dict[str, str] = {}
        folder = p.folder or time.strftime('marine_tracker_%Y-%m-%d_%H-%M-%S')
        self._writing = Writing(
            McapLog(folder, p.split_mb << 20, p.keep_free_mb << 20, p.compression)
        )
        self._told_end = self._told_clock = False
        self._heard: dict[str, _Heard] = {}
        for one in wanted:
            self._listen(one)
        self._tracker = p.tracker
        self._names = [field.name for field in fields('tracker')]
        self._ask = self.create_client(GetParameters, f'{p.tracker}/get_parameters')
        self._asking, self._known = False, False
        self.subscription(
            ParameterEvent, '/parameter_events', self._on_change, recorded_topics.reliable(100)
        )
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(1.0, self._on_second, clock=steady)
        self.watch(steady, 'recording', self._state)
        self.get_logger().info(f'records into {one_line(self._writing.log.folder)}')

    def close(self) -> None:
        """All that came is on disk, and the file is whole."""
        self._writing.close()

    # -- in ------------------------------------------------------------------------------------

    def _listen(self, wanted: Wanted) -> None:
        name = self.resolve_topic_name(wanted.name)
        module = wanted.kind.__module__.split('.')[0]
        kind = f'{module}/msg/{wanted.kind.__name__}'
        topic = Topic(
            name,
            kind,
            definition(kind),
            recorded_topics.described(wanted.quality),
            wanted.quality.durability == DurabilityPolicy.TRANSIENT_LOCAL,
        )
        subscription = self.create_subscription(
            wanted.kind,
            wanted.name,
            partial(self._on_message, name),
            wanted.quality,
            raw=True,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
        )
        before = self._heard.get(name)
        self._heard[name] = heard = _Heard(wanted, topic, subscription)
        if before is not None:
            self.destroy_subscription(before.subscription)
            heard.count, heard.lost, heard.at = before.count, before.lost, before.at

    def _on_message(self, name: str, data: bytes, info: dict[str, Any]) -> None:
        wall_ns = time.time_ns()
        now_ns = self.get_clock().now().nanoseconds
        simulated = self.get_parameter('use_sim_time').value
        if simulated and not now_ns:
            if not self._told_clock:
                self._told_clock = True
                self.get_logger().warning(
                    'use_sim_time is set and /clock is silent: nothing is recorded before it runs'
                )
            return
        heard = self._heard[name]
        heard.count += 1
        heard.at = time.monotonic()
        sequence = info.get('publication_sequence_number')
        if sequence is not None and heard.publishers == 1:
            if heard.sequence is not None and sequence > heard.sequence + 1:
                heard.lost += sequence - heard.sequence - 1
            heard.sequence = sequence
        came_ns = info.get('received_timestamp') or wall_ns
        message = Message(
            heard.topic,
            now_ns if simulated else came_ns,
            info.get('source_timestamp') or came_ns,
            data,
        )
        self._writing.put(came_ns, message)

    # -- each second ---------------------------------------------------------------------------

    def _on_second(self) -> None:
        for name in self._others:
            if self.resolve_topic_name(name) not in self._heard:
                self._find(name)
        for name, heard in list(self._heard.items()):
            publishers = self.get_publishers_info_by_topic(name)
            if len(publishers) != heard.publishers:
                heard.publishers, heard.sequence = len(publishers), None
                heard.at = time.monotonic()
            offered = [one.qos_profile for one in publishers]
            if offered and not recorded_topics.hears(heard.wanted.quality, offered):
                quality = recorded_topics.matched(offered)
                self._listen(heard.wanted._replace(quality=quality))
                self.get_logger().info(f'{name} is published with less: heard so')
        if not self._known and not self._asking and self._ask.service_is_ready():
            self._asking = True
            future = self._ask.call_async(GetParameters.Request(names=self._names))
            future.add_done_callback(self._guarded(self._on_parameters))
        if self._writing.ended and not self._told_end:
            self._told_end = True
            self.get_logger().error(f'the recording has ended: {one_line(self._writing.ended)}')

    def _find(self, name: str) -> None:
        try:
            wanted = recorded_topics.of_others(self, name)
        except ValueError as error:
            self._not_installed[name] = str(error)
            return
        if wanted is not None:
            self._not_installed.pop(name, None)
            self._listen(wanted)

    def _on_change(self, event: ParameterEvent) -> None:
        """A tracker that begins anew has other parameters, or comes after the recorder."""
        if event.new_parameters and event.node == self._full(self._tracker):
            self._known = False

    def _full(self, name: str) -> str:
        return name if name.startswith('/') else f'{self.get_namespace().rstrip("/")}/{name}'

    def _on_parameters(self, future: Any) -> None:
        self._asking = False
        values = future.result().values
        found = {
            name: value
            for name, value in zip(self._names, map(parameter_value_to_python, values))
            if value is not None
        }
        if found:
            self._known = True
            self._writing.settings(
                {'tracker': json.dumps(found), 'tracker_node': self._full(self._tracker)}
            )

    # -- how it fares --------------------------------------------------------------------------

    def _state(self) -> State:
        writing, wall = self._writing, time.monotonic()
        worries = list(self._not_installed.values())
        values: dict[str, Any] = {
            'folder': writing.log.folder,
            'MB': f'{writing.log.size / (1 << 20):.1f}',
            'files': len(writing.log.files),
            'messages waiting': writing.waiting,
        }
        lost = 0
        for name, heard in self._heard.items():
            gone = heard.lost + writing.lost[name]
            lost += gone
            if heard.count or heard.publishers:
                values[name] = (
                    f'{writing.written[name]} written, {wall - heard.at:.1f} s ago, {gone} lost'
                )
            if heard.wanted.steady and heard.publishers and wall - heard.at > SILENT_S:
                worries.append(f'{name} is published, and nothing came for {wall - heard.at:.0f} s')
        if lost:
            worries.append(f'{lost} messages lost')
        if writing.ended:
            return ERROR, f'the recording has ended: {writing.ended}', values
        if writing.waiting and wall - writing.at > STUCK_S:
            worries.insert(0, f'nothing was written for {wall - writing.at:.0f} s')
            return ERROR, '; '.join(worries), values
        count = sum(writing.written.values())
        return (WARN if worries else OK), '; '.join(worries) or f'{count} messages', values
