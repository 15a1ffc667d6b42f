"""The options that say where the parts of an experiment run."""

import asyncio
import os
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator
from contextlib import contextmanager

from ..evaluation.parallel import Workers
from ..processes import keep_freed_memory, one_thread

CONNECT_S = 10.0  # s for a scheduler to answer, and then for a first worker


def add_arguments(parser: ArgumentParser) -> None:
    """Adds --processes and --scheduler."""
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        '--processes',
        type=int,
        default=os.cpu_count() or 1,
        metavar='N',
        help='number of processes; the results do not depend on it (default %(default)s)',
    )
    where.add_argument(
        '--scheduler',
        metavar='ADDRESS',
        help='run on the workers of the dask scheduler there instead, e.g. tcp://10.0.0.7:8786 '
        '(needs marine_tracker[cluster] on both sides); the results do not depend on it',
    )


@contextmanager
def workers(args: Namespace) -> Iterator[Workers]:
    """The workers that run the parts, while the context lasts. ValueError says what is wrong."""
    if args.scheduler is None:
        if args.processes < 1:
            raise ValueError(f'--processes is {args.processes}; it must be at least 1')
        yield args.processes
        return
    with _client(args.scheduler) as client:
        yield client.get_executor(pure=False)


@contextmanager
def _client(address: str) -> Iterator:
    """A client of the scheduler, with at least one worker that is ready for a part."""
    try:
        from distributed import Client
        from distributed.comm import connect
    except ModuleNotFoundError as error:
        raise ValueError(
            '--scheduler needs dask.distributed: pip install "marine_tracker[cluster]"'
        ) from error

    async def knock():
        await (await connect(address, timeout=CONNECT_S)).close()

    try:
        asyncio.run(
            asyncio.wait_for(knock(), CONNECT_S)
        )  # a client that finds no scheduler is not cleaned up completely
        client = Client(address, timeout=CONNECT_S, set_as_default=False)
    except OSError as error:
        raise ValueError(
            f'--scheduler {address}: no dask scheduler answers there within {CONNECT_S:g} s'
        ) from error
    except ValueError as error:
        raise ValueError(f'--scheduler {address} is no address of a scheduler: {error}') from error
    with client:
        try:
            client.wait_for_workers(1, CONNECT_S)
        except TimeoutError as error:
            raise ValueError(
                f'--scheduler {address}: it has no worker, for {CONNECT_S:g} s now'
            ) from error
        try:
            client.register_worker_callbacks(settle)
        except Exception as error:
            raise ValueError(
                f'--scheduler {address}: a worker cannot run marine_tracker: {error}'
            ) from error
        yield client


def settle() -> None:
    """In each worker: linear algebra in one thread, whatever its environment says."""
    one_thread()
    import scipy.linalg  # noqa: F401  (brings the libraries whose threads are to be limited)
    from threadpoolctl import threadpool_limits

    threadpool_limits(1)
    keep_freed_memory()
