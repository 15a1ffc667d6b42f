"""What may be wrong with a message: it cannot be read, or its header cannot be used."""

from collections.abc import Sequence


class ConversionError(ValueError):
    """A message that cannot be read; `reason` is the name of its counter."""

    def __init__(self, reason: str, text: str) -> None:
        super().__init__(f'{reason}: {text}')
        self.reason = reason


MISSING_FIELD = 'clouds with a missing field'
MISTYPED_FIELD = 'clouds with a mistyped field'
BAD_LAYOUT = 'clouds with a wrong layout'
TRUNCATED = 'clouds with a truncated buffer'
WRONG_FRAME = 'messages in a wrong frame'
BAD_STAMP = 'messages with a wrong stamp'


def check_frame(frame: str, allowed: Sequence[str]) -> None:
    """ConversionError unless the frame is one of those allowed; an empty one counts as `map`."""
    if frame and bare(frame) not in allowed:
        may = ' or '.join(dict.fromkeys(allowed))
        raise ConversionError(
            WRONG_FRAME, f'frame_id is {frame[:80]!r}; it must be {may}, or empty'
        )


def bare(frame: str) -> str:
    """The frame without the slash that ROS 1 put before it."""
    return frame.removeprefix('/')
