"""AIS of a scenario's ships as the simulator sends it: sentences on a topic and by UDP."""

from collections.abc import Iterator

from std_msgs.msg import String

from ..simulation import ais_sentences, transponders
from ..simulation.scenario import Scenario
from . import topics
from .base_node import RunnableNode
from .nmea_output_links import Datagrams


class SimulatedAis:
    """Sends what is due, from the beginning again where time goes back."""

    def __init__(self, node: RunnableNode, chosen: Scenario, seed: int, udp: str) -> None:
        self._of, self._seed = chosen, seed
        self._links = Datagrams('ais_udp', udp)
        self._topic = node.publisher(String, topics.AIS_SIMULATED, topics.reliable(topics.BURST))
        self._lines: Iterator[tuple[float, list[str]]] = iter(())
        self._next: tuple[float, list[str]] | None = None
        self._last = -1.0
        self.sent = 0

    def begin(self, epoch: float) -> None:
        """From the beginning, again where the scenario is played again."""
        of, fleet = self._of, self._of.fleet
        assert fleet.ais is not None and fleet.origin is not None
        frame, names = fleet.origin, fleet.names
        some = transponders.transmit(fleet.ais, fleet.paths, fleet.length, of.duration, self._seed)
        self._lines = (
            pair for sent in some for pair in ais_sentences.encode(sent, frame, names, epoch)
        )
        self._next = next(self._lines, None)
        self._last = -1.0

    def send(self, now: float, epoch: float) -> None:
        """What was heard by the scenario's time now, s."""
        if now < self._last or self._last < 0:
            self.begin(epoch)
        self._last = max(now, 0.0)
        while self._next is not None and self._next[0] <= now:
            lines = self._next[1]
            for line in lines:
                self._topic.publish(String(data=line))
            self._links.send([f'{line}\r\n'.encode('ascii') for line in lines])
            self.sent += len(lines)
            self._next = next(self._lines, None)

    def close(self) -> None:
        """Closes the sockets."""
        self._links.close()
