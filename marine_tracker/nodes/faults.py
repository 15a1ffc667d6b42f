"""What may be wrong with a message: it cannot be read, or its header cannot be used."""

from ..recording.message_faults import (  # noqa: F401
    BAD_LAYOUT,
    BAD_STAMP,
    MISSING_FIELD,
    MISTYPED_FIELD,
    TRUNCATED,
    WRONG_FRAME,
    ConversionError,
    bare,
    check_frame,
)
from ..tracking.scan_input import NO_STAMP

HEADER_REASONS = (WRONG_FRAME, BAD_STAMP, NO_STAMP)
