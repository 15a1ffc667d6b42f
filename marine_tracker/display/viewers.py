"""What each viewer still has to get: one bounded queue for each, in which the newest state wins."""

import asyncio
from collections import deque

MOST_ANSWERS = 16  # that wait for one viewer


class Mailbox:
    """Of one viewer; to be used in one thread, that of the event loop.

    There is room for one message of each kind: a newer one takes the place of one that still
    waits. So a viewer that reads slowly gets the state of now, whole, and never an old one; its
    connection stays. Answers to its commands wait in order, the oldest falls out.

    replaced  how many messages a newer one has replaced
    wants     kinds that come on demand, and that this viewer asked for
    """

    def __init__(self) -> None:
        self._newest: dict[str, str] = {}
        self._answers: deque[str] = deque(maxlen=MOST_ANSWERS)
        self._filled = asyncio.Event()
        self.replaced = 0
        self.wants: set[str] = set()

    def put(self, kind: str, text: str) -> None:
        """A state of this kind, to be sent."""
        # Taken out first: what is new goes to the end, or one that changes often would hold
        # its place before the others.
        self.replaced += self._newest.pop(kind, None) is not None
        self._newest[kind] = text
        self._filled.set()

    def answer(self, text: str) -> None:
        """What came of a command of this viewer."""
        self.replaced += len(self._answers) == MOST_ANSWERS
        self._answers.append(text)
        self._filled.set()

    async def take(self) -> str:
        """The next message, waited for: answers first."""
        await self._filled.wait()
        if self._answers:
            text = self._answers.popleft()
        else:
            text = self._newest.pop(next(iter(self._newest)))
        if not self._answers and not self._newest:
            self._filled.clear()
        return text

    def __len__(self) -> int:
        return len(self._newest) + len(self._answers)
