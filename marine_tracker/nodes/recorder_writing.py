"""The recorder's thread that writes: nothing that a disk does delays what is heard."""

import threading
import time
from collections import Counter, deque
from collections.abc import Callable
from operator import itemgetter

from ..recording.mcap_write import McapLog, Message, NoRoomError

EVERY_S = 0.4  # between two writes: a second is on disk at the latest
HELD_S = 0.05  # messages that came at about the same time are put in order
QUEUE = 128 << 20  # bytes that may wait for a slow disk
BACK_NS = 1_000_000_000  # simulated time that goes back by more begins again


class Writing:
    """Puts messages into a McapLog, from a queue of bounded size.

    written  messages on disk, by topic
    lost     messages for which there was no room in the queue, by topic
    ended    why the recording has ended by itself; '' while it goes on
    """

    def __init__(self, log: McapLog) -> None:
        self.log = log
        self.written: Counter[str] = Counter()
        self.lost: Counter[str] = Counter()
        self.ended = ''
        self.at = time.monotonic()  # of the last write
        self._queue: deque[tuple[int, Message]] = deque()
        self._bytes = 0
        self._settings: dict[str, str] = {}
        self._lock = threading.Lock()
        self._last_ns = 0
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name='recorder', daemon=True)
        self._thread.start()

    @property
    def waiting(self) -> int:
        """Messages that are not on disk."""
        return len(self._queue)

    def put(self, came_ns: int, message: Message) -> None:
        """A message, and when it came by the wall's clock."""
        with self._lock:
            if self.ended or self._bytes > QUEUE:
                self.lost[message.topic.name] += 1
                return
            self._queue.append((came_ns, message))
            self._bytes += len(message.data)

    def settings(self, values: dict[str, str]) -> None:
        """Texts to keep beside the messages."""
        with self._lock:
            self._settings.update(values)

    def close(self) -> None:
        """All that waits on disk, and the file's end."""
        self._stop.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._stop.wait(EVERY_S):
            self._guarded(lambda: self._write(time.time_ns() - round(HELD_S * 1e9)))
            if self.ended:
                return
        self._guarded(lambda: self._write(None))
        if not self.ended:
            self._guarded(self.log.close)

    def _guarded(self, work: Callable[[], None]) -> None:
        try:
            work()
        except NoRoomError as error:
            self.ended = error.args[0]
        except Exception as error:  # whatever it is, it is told, and the node goes on
            self.ended = f'{type(error).__name__}: {error}'

    def _write(self, until_ns: int | None) -> None:
        with self._lock:
            settings, self._settings = self._settings, {}
            waiting = sorted(self._queue, key=itemgetter(0))
            count = len(waiting)
            if until_ns is not None:
                count = sum(came_ns <= until_ns for came_ns, _ in waiting)
            self._queue = deque(waiting[count:])
            self._bytes = sum(len(message.data) for _, message in self._queue)
        if settings:
            self.log.settings(settings)
        messages = [self._in_order(message) for _, message in waiting[:count]]
        self.log.write(messages)
        self.log.flush()
        self.written.update(message.topic.name for message in messages)
        self.at = time.monotonic()

    def _in_order(self, message: Message) -> Message:
        """Its log time not before that of the one before, which simulated time may have passed."""
        behind = self._last_ns - message.log_ns
        self._last_ns = self._last_ns if 0 < behind < BACK_NS else message.log_ns
        return message._replace(log_ns=self._last_ns)
