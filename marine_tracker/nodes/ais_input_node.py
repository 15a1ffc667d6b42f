"""AIS sentences in, reports out: by UDP, TCP, serial port, file, or topics of sentences.

What is heard is published as numbers on `ais/reports`, and as it came on `ais/sentences`. What
cannot be taken is counted on /diagnostics by a named reason (ais/sentences.py), and logged once.
"""

import time
from pathlib import Path
from typing import Any

from rclpy.clock import Clock, ClockType
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import String

from ..ais import sentences
from ..ais.sentences import Sentences
from ..files import shortened
from ..parameters import AisInputParameters
from . import ais_cloud, topics
from .ais_input_links import Links
from .base_node import RunnableNode, State
from .declare import declare
from .diagnostics import OK, WARN, Tally, one_line

POLL_S = 0.05
SILENT_S = 60.0  # s of the wall without a report
LONGEST_FILE = 100_000_000  # bytes


class AisInputNode(RunnableNode):
    """See the module. ValueError where the parameters are wrong or a port is taken."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__('ais_input', **node_arguments)
        (p,) = declare(self, AisInputParameters)
        self._sentences = Sentences(p.own_mmsi)
        self._bad = Tally((*sentences.REFUSED, sentences.CLOCK), self.tell)
        self._reported: dict[str, int] = {}  # refusals that the tally knows
        self._heard = time.monotonic()
        self._links = Links(self._take)
        self._links.listen_udp('udp', p.udp)
        self._links.connect_tcp('tcp', p.tcp)
        self._links.serve_tcp('tcp_server', p.tcp_server)
        if p.serial:
            self._links.open_serial('serial', p.serial, p.baud)
        self._recorded, self._rate = _read(p.file), p.rate
        self._played: float | None = None  # s of the wall
        self._first = 0.0  # s of the first recorded line
        self._to_reports = self.publisher(
            PointCloud2, topics.AIS_REPORTS, topics.reliable(topics.BURST)
        )
        self._to_sentences = self.publisher(
            String, topics.AIS_SENTENCES, topics.reliable(topics.BURST)
        )
        for topic in p.topics.split():
            self.subscription(String, topic, self._on_sentence, topics.best_effort(topics.BURST))
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(POLL_S, self._poll, clock=steady)
        self.watch(steady, 'input', self._state)
        sources = (p.udp, p.tcp, p.tcp_server, p.serial, p.file, p.topics)
        self.get_logger().info(one_line('AIS from ' + ', '.join(one for one in sources if one)))

    def close(self) -> None:
        """Closes all links."""
        self._links.close()

    def _on_sentence(self, message: String) -> None:
        self._take(message.data.encode('ascii', 'replace'), 'topic')
        self._publish()

    def _take(self, line: bytes, source: str) -> None:
        outcome = self._sentences.take(line, self._now(), source)
        if outcome in (sentences.TAKEN, sentences.WAITING, sentences.OWN):
            self._heard = time.monotonic()
        if outcome not in sentences.REFUSED and outcome != sentences.OTHER:
            self._to_sentences.publish(String(data=line.decode('ascii', 'replace').strip()))

    def _now(self) -> float:
        return self.get_clock().now().nanoseconds * 1e-9

    def _poll(self) -> None:
        self._links.poll()
        self._play()
        self._publish()
        wall = time.monotonic()
        for reason in (*sentences.REFUSED, sentences.CLOCK):
            of = self._sentences.left_out if reason == sentences.CLOCK else self._sentences.outcome
            new = of[reason] - self._reported.get(reason, 0)
            if new > 0:
                self._reported[reason] = of[reason]
                self._bad.add(reason, wall, new)
        for fault in self._links.faults:
            self.tell('a link', fault)
        self._links.faults.clear()

    def _play(self) -> None:
        """Recorded lines that are due; their own times are left out."""
        if not self._recorded:
            return
        wall = time.monotonic()
        if self._played is None:
            if not self._to_reports.get_subscription_count():
                return  # nobody listens yet
            self._played = wall
            self._first = self._recorded[-1][0]
        due = self._first + (wall - self._played) * self._rate
        while self._recorded and self._recorded[-1][0] <= due:
            self._take(self._recorded.pop()[1], 'file')

    def _publish(self) -> None:
        reports = self._sentences.reports()
        if len(reports.mmsi):
            now_ns = self.get_clock().now().nanoseconds
            self._to_reports.publish(ais_cloud.message(reports, now_ns * 1e-9, now_ns))

    def _state(self) -> State:
        wall = time.monotonic()
        level, message = OK, 'reports come in'
        fresh = self._bad.fresh(wall)
        if wall - self._heard > SILENT_S:
            level, message = WARN, f'no AIS for {wall - self._heard:.0f} s'
        elif fresh:
            level, message = WARN, 'lately: ' + ', '.join(fresh)
        outcome = self._sentences.outcome
        values = {f'lines {name}': outcome[name] for name in sentences.OUTCOMES if outcome[name]}
        left_out = {f'left out: {name}': n for name, n in self._sentences.left_out.items()}
        return (
            level,
            message,
            {
                'lines': self._sentences.lines,
                **values,
                **left_out,
                'connections': self._links.connected,
                'own MMSI': self._sentences.own or 'not known',
            },
        )


def _read(path: str) -> list[tuple[float, bytes]]:
    """Lines of a file with their seconds after the first, the last line first. ValueError."""
    if not path:
        return []
    file = Path(path)
    try:
        if file.stat().st_size > LONGEST_FILE:
            raise ValueError(f'parameter file is {shortened(file)}; it is larger than 100 MB')
        text = file.read_bytes()
    except OSError as error:
        raise ValueError(f'parameter file is {shortened(file)}: {error.strerror}') from error
    found: list[tuple[float, bytes]] = []
    at = 0.0
    for line in text.splitlines():
        stamp = sentences.SECONDS.match(line.decode('ascii', 'replace'))
        if stamp:
            at, line = float(stamp[1]), line[stamp.end() :]
        block = sentences.TAG_BLOCK.match(line.decode('ascii', 'replace'))
        if block:  # its time is that of the recording
            told = dict(one.split(':', 1) for one in block[1].split(',') if ':' in one)
            at, line = sentences.unix_time(told.get('c', ''), at), line[block.end() :]
        if line.strip():
            found.append((at, line))
    return found[::-1]
