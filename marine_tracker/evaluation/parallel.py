"""Parts of an experiment at the same time; what comes out does not depend on where they run."""

import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from typing import Any, NamedTuple

from ..processes import THREADS, end_with_parent, keep_freed_memory
from .result import Progress

# How many processes on this machine (None: one for each processor), or who runs the parts instead.
Workers = int | Executor | None


class Job(NamedTuple):
    """A function of a module, and its arguments: both must pickle."""

    function: Callable[..., Any]
    arguments: tuple[Any, ...]


def run(jobs: Sequence[Job], workers: Workers, progress: Progress) -> list[Any]:
    """What each job returns, in order; what one raises is raised here, and the rest is cancelled.

    An executor that is handed in stays open. How many threads its workers use, its owner decides.
    """
    if isinstance(workers, Executor):
        return _run(jobs, workers, progress)
    others = set(multiprocessing.active_children())
    with (
        _one_thread_each(),
        ProcessPoolExecutor(
            min(workers or os.cpu_count() or 1, len(jobs)),
            multiprocessing.get_context('spawn'),
            _begin,
        ) as pool,
    ):
        try:
            return _run(jobs, pool, progress)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for process in set(multiprocessing.active_children()) - others:
                process.terminate()  # would go on for minutes
            raise


def _run(jobs: Sequence[Job], executor: Executor, progress: Progress) -> list[Any]:
    progress(0, len(jobs))
    futures = [executor.submit(job.function, *job.arguments) for job in jobs]
    try:
        for done, future in enumerate(as_completed(futures), 1):
            future.result()
            progress(done, len(jobs))
    except BaseException:
        for future in futures:
            future.cancel()
        raise
    return [future.result() for future in futures]


def _begin() -> None:
    """In each process: Ctrl-C ends it without a word, the first process speaks for all."""
    end_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    keep_freed_memory()


@contextmanager
def _one_thread_each() -> Iterator[None]:
    """Processes begun within use one thread each; the library reads that when it is loaded."""
    before = {name: os.environ.get(name) for name in THREADS}
    os.environ.update(dict.fromkeys(THREADS, '1'))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
