"""Runs the parts of an experiment in parallel. The result does not depend on where they run."""

import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from typing import Any, NamedTuple

from ..processes import THREADS, end_with_parent, keep_freed_memory
from .result import Progress

# Number of processes on this machine (None: one for each processor), or an executor that runs the
# parts.
Workers = int | Executor | None


class Job(NamedTuple):
    """A function of a module, and its arguments. Both must be picklable."""

    function: Callable[..., Any]
    arguments: tuple[Any, ...]


def run(jobs: Sequence[Job], workers: Workers, progress: Progress) -> list[Any]:
    """Returns the result of each job, in order. An exception of a job is raised here; the other
    jobs are cancelled.

    An executor given by the caller stays open. Its owner decides how many threads its workers use.
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
                process.terminate()  # it would run on for minutes
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
    """In each process: Ctrl-C ends it silently; the main process reports it."""
    end_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    keep_freed_memory()


@contextmanager
def _one_thread_each() -> Iterator[None]:
    """Processes started inside use one thread each. The library reads the setting when it is
    loaded.
    """
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
