"""Parts of `imo` and of experiments on the workers of a dask cluster: two real ones, here."""

import contextlib
import os
import socket
import sys
import time

import pytest

from marine_tracker.cli import main
from marine_tracker.commands import worker_options
from marine_tracker.conformance.ring_of_ships import SHIPS
from marine_tracker.evaluation import parallel
from marine_tracker.evaluation.result import silent
from marine_tracker.processes import THREADS


@pytest.fixture(scope='module')
def scheduler():
    """The address of a scheduler with two workers, which are told to use three threads each."""
    dask = pytest.importorskip(
        'dask', reason='dask.distributed (extra cluster) is not installed: no cluster is tried'
    )
    distributed = pytest.importorskip('distributed')
    environment = dict.fromkeys(THREADS, 3)
    with (
        pytest.MonkeyPatch.context() as patch,
        dask.config.set({'distributed.nanny.pre-spawn-environ': environment}),
        contextlib.ExitStack() as stack,
    ):
        for name in THREADS:  # what is set here would hold there too
            patch.delenv(name, raising=False)
        cluster = stack.enter_context(
            distributed.LocalCluster(
                n_workers=2, threads_per_worker=1, host='127.0.0.1', dashboard_address=':0'
            )
        )
        yield cluster.scheduler_address


@pytest.fixture
def options():
    """What the parser makes of a command line."""
    import argparse

    parser = argparse.ArgumentParser()
    worker_options.add_arguments(parser)
    return lambda *words: parser.parse_args(words)


def same_figures(command, scheduler, folder):
    codes = [
        main([*command, *where, '--json', str(folder / name)])
        for name, where in (('here', ('--processes', '1')), ('there', ('--scheduler', scheduler)))
    ]
    return (
        codes[0] == codes[1] and (folder / 'here').read_bytes() == (folder / 'there').read_bytes()
    )


def test_figures_of_a_cluster_are_those_of_one_process(scheduler, tmp_path):
    command = ['imo', '--part', 'loss', '--estimator', 'cs_kalman', '--runs', str(2 * SHIPS)]
    assert same_figures(command, scheduler, tmp_path)


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_an_experiment_has_the_same_figures_on_a_cluster(scheduler, tmp_path):
    assert same_figures(['experiments', 'two_radars', '--runs', '2'], scheduler, tmp_path)


def test_both_workers_take_part_in_one_thread_each(scheduler, options):
    from threadpoolctl import threadpool_info

    with worker_options.workers(options('--scheduler', scheduler)) as executor:
        # Whoever sleeps leaves the next job to the other worker.
        jobs = 20 * [parallel.Job(time.sleep, (0.05,)), parallel.Job(os.getpid, ())]
        told, *rest = parallel.run(
            [parallel.Job(os.getenv, (THREADS[0],)), *jobs], executor, silent
        )
        pids = [pid for pid in rest if pid]
        infos = parallel.run([parallel.Job(threadpool_info, ())] * 4, executor, silent)
    assert told == '3', 'the workers were not started as this test needs them'
    assert len(set(pids)) == 2 and os.getpid() not in pids
    assert all(infos) and {one['num_threads'] for info in infos for one in info} == {1}


def test_what_a_part_raises_on_a_worker_is_raised_here(scheduler, options):
    with (
        worker_options.workers(options('--scheduler', scheduler)) as executor,
        pytest.raises(ZeroDivisionError),
    ):
        parallel.run([parallel.Job(divmod, (7, 0))], executor, silent)


def refused(capsys, *words):
    """The one line with which a command is refused."""
    assert main([*words]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    return line


@pytest.mark.parametrize('listens', [False, True], ids=['nobody', 'not a scheduler'])
def test_scheduler_that_does_not_answer(capsys, monkeypatch, listens):
    pytest.importorskip('distributed')
    monkeypatch.setattr(worker_options, 'CONNECT_S', 1.5)
    with socket.socket() as other:
        other.bind(('127.0.0.1', 0))
        if listens:
            other.listen()
        address = f'tcp://127.0.0.1:{other.getsockname()[1]}'
        line = refused(capsys, 'imo', '--scheduler', address)
    assert f'--scheduler {address}: no dask scheduler answers there within 1.5 s' in line


def test_scheduler_without_workers(capsys, monkeypatch):
    distributed = pytest.importorskip('distributed')
    monkeypatch.setattr(worker_options, 'CONNECT_S', 1.5)
    with distributed.LocalCluster(n_workers=0, host='127.0.0.1', dashboard_address=':0') as cluster:
        line = refused(capsys, 'imo', '--scheduler', cluster.scheduler_address)
    assert f'{cluster.scheduler_address}: it has no worker, for 1.5 s now' in line


@pytest.mark.parametrize('address', ['127.0.0.1:harbour', 'http://127.0.0.1:80', ''])
def test_address_that_is_none(capsys, address):
    pytest.importorskip('distributed')
    line = refused(capsys, 'experiments', 'two_radars', '--scheduler', address)
    assert f'--scheduler {address} is no address of a scheduler'.replace('  ', ' ') in line


def test_without_dask_the_extra_is_named(capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, 'distributed', None)
    line = refused(capsys, 'imo', '--scheduler', 'tcp://127.0.0.1:8786')
    assert line.endswith('pip install "marine_tracker[cluster]"')


@pytest.mark.parametrize('command', [('imo',), ('experiments', 'extended')])
def test_no_processes_are_refused(capsys, command):
    assert '--processes is -2; it must be at least 1' in refused(
        capsys, *command, '--processes', '-2'
    )
