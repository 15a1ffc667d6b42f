"""What processes of this package ask of the operating system."""

import contextlib
import ctypes
import os
import resource
import signal

PR_SET_PDEATHSIG = 1  # sys/prctl.h
M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3  # malloc.h of the GNU C library
KEEP = 64 * 1024 * 1024  # bytes
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


def keep_freed_memory() -> bool:
    """Ask the C library to keep up to 64 MB of freed memory for reuse; False where it cannot.

    A scan frees a few megabytes of arrays and the next one asks for them again. Given back to the
    kernel in between, and faulted in anew, they double the time of a scan of 1,000 tracks
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
