"""Parts of an experiment on all processors; what comes out does not depend on their number."""

import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from typing import Any, NamedTuple

from ..processes import THREADS, end_with_parent, keep_freed_memory
from .result import Progress


class Job(NamedTuple):
    """A function of a module, and its arguments: both must pickle."""

    function: Callable[..., Any]
    arguments: tuple[Any, ...]


def run(jobs: Sequence[Job], processes: int, progress: Progress) -> list[Any]:
    """What each job returns, in order; what one raises is raised here."""
    done = 0
    progress(done, len(jobs))
    others = set(multiprocessing.active_children())
    with (
        _one_thread_each(),
        ProcessPoolExecutor(
            min(processes, len(jobs)), multiprocessing.get_context('spawn'), _begin
        ) as pool,
    ):
        try:
            futures = [pool.submit(job.function, *job.arguments) for job in jobs]
            for future in as_completed(futures):
                future.result()
                done += 1
                progress(done, len(jobs))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for process in set(multiprocessing.active_children()) - others:
                process.terminate()  # would go on for minutes
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
