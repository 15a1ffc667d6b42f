"""What processes of this package ask of the operating system."""

import contextlib
import ctypes
import os
import signal

PR_SET_PDEATHSIG = 1        # sys/prctl.h
THREADS = ('OMP_NUM_THREADS', 'OPENBLAS_NUM_THREADS', 'MKL_NUM_THREADS')


def end_with_parent() -> None:
    """In a child: be told to end should the parent be killed. Linux only; elsewhere nothing."""
    with contextlib.suppress(AttributeError, OSError):
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


def one_thread() -> None:
    """Linear algebra in one thread, unless the user says otherwise; before numpy is imported.

    The matrices here are small: a second thread doubles the CPU time and saves none (measured).
    """
    for name in THREADS:
        os.environ.setdefault(name, '1')
