"""Processes that this package starts end with it."""

import contextlib
import ctypes
import signal

PR_SET_PDEATHSIG = 1        # sys/prctl.h


def end_with_parent() -> None:
    """In a child: be told to end should the parent be killed. Linux only; elsewhere nothing."""
    with contextlib.suppress(AttributeError, OSError):
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
