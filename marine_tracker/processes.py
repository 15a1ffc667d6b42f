"""The requests of this package's processes to the operating system."""

import contextlib
import ctypes
import faulthandler
import fcntl
import os
import resource
import signal
import sys
from typing import NoReturn

PR_SET_PDEATHSIG = 1  # sys/prctl.h
M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3  # malloc.h of the GNU C library
KEEP = 64 * 1024 * 1024  # bytes
GRACE_S = 10  # s to close in order, after a signal
LATE = int(signal.SIGALRM)  # exit code of a process that did not close in time
THREADS = ('OMP_NUM_THREADS', 'OPENBLAS_NUM_THREADS', 'MKL_NUM_THREADS')


def end_with_parent() -> None:
    """In a child process: end it if the parent is killed. Linux only; elsewhere no effect."""
    with contextlib.suppress(AttributeError, OSError):
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


def end_in_time() -> None:
    """From now on the process ends within GRACE_S of a signal that a Python handler takes.

    It ends with the exit code LATE, and stderr shows where each thread was. No line of Python runs
    for that. A call into a library that never returns may hold the interpreter's lock, and then no
    handler and no thread of Python runs. Python's own handler, in C, writes the signal's number
    into a pipe. The kernel answers with signal number 10, which has no other use (SIGUSR1). Its
    handler is `alarm` of the C library. Called with that 10, it asks for SIGALRM in 10 s. That
    signal shows the threads and calls `_exit` with its own number, 14.

    If SIGUSR1 has another number, as on macOS, Python's handler must run and call `closing`.
    """
    library = ctypes.CDLL(None)
    library.signal.argtypes = ctypes.c_int, ctypes.c_void_p
    library.signal(signal.SIGALRM, ctypes.cast(library._exit, ctypes.c_void_p))
    if sys.stderr is not None:
        faulthandler.register(signal.SIGALRM, chain=True)
    if signal.SIGUSR1 != GRACE_S:
        return
    library.signal(GRACE_S, ctypes.cast(library.alarm, ctypes.c_void_p))
    read, write = os.pipe()
    fcntl.fcntl(read, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(read, fcntl.F_SETSIG, GRACE_S)
    fcntl.fcntl(read, fcntl.F_SETFL, os.O_ASYNC)
    os.set_blocking(write, False)
    signal.set_wakeup_fd(write, warn_on_full_buffer=False)


def leave(code: int) -> NoReturn:
    """Ends the process at once, with this exit code. All must be closed by now.

    What Python does at its end, above all to collect 90,000 objects, takes as long as all the
    closing before it (.25 s of a processor). On a machine with ten times the work that it can do
    that alone took longer than GRACE_S.
    """
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(AttributeError, OSError, ValueError):  # none, or nobody reads it
            stream.flush()
    os._exit(code)


def stop_on_sigterm() -> None:
    """From now on SIGTERM raises SystemExit, so that everything is cleaned up."""

    def stop(*_: object) -> NoReturn:
        raise SystemExit(128 + signal.SIGTERM)

    signal.signal(signal.SIGTERM, stop)


def closing() -> None:
    """Call this when the process is about to end, by a signal or by itself.

    From here on another signal gives no more time. If no signal came, the time starts now.
    """
    signal.set_wakeup_fd(-1)
    left = signal.alarm(GRACE_S)
    if left:
        signal.alarm(left)


def one_thread() -> None:
    """Linear algebra in one thread, unless the user sets something else. Call before importing
    numpy.

    The matrices here are small: a second thread doubles the CPU time and saves nothing (measured).
    """
    for name in THREADS:
        os.environ.setdefault(name, '1')


def return_freed_memory() -> None:
    """Give memory that is freed but kept back to the kernel, so that what is left is in use."""
    with contextlib.suppress(AttributeError, OSError):  # not the GNU C library
        ctypes.CDLL(None).malloc_trim(0)


def keep_freed_memory() -> bool:
    """Asks the C library to keep up to 64 MB of freed memory for reuse. False if it cannot.

    A scan frees a few megabytes of arrays, and the next scan asks for them again. If they go back
    to the kernel in between and must be mapped again, a scan of 1,000 tracks takes twice the time
    (measured). Every process that runs trackers calls this once.
    """
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (AttributeError, OSError):  # not the GNU C library
        return False
    return bool(mallopt(M_TRIM_THRESHOLD, KEEP) and mallopt(M_MMAP_THRESHOLD, KEEP // 2))


def peak_memory_mb() -> float:
    """MB: the most memory that this process has had so far. Linux counts in kB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
