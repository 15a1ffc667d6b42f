"""Parts of an experiment in several processes."""

import operator
import os
import threading
from concurrent.futures import ThreadPoolExecutor

import pytest

from marine_tracker.evaluation import parallel
from marine_tracker.evaluation.parallel import Job


def test_results_come_in_order_whatever_the_number_of_processes():
    planned = [Job(pow, (2, k)) for k in range(5)] + [Job(os.getpid, ())]
    told = []
    found = [
        parallel.run(planned, processes, lambda done, whole: told.append((done, whole)))
        for processes in (1, 2)
    ]
    assert found[0][:-1] == found[1][:-1] == [2**k for k in range(5)]
    assert os.getpid() not in (found[0][-1], found[1][-1])
    once = [(done, 6) for done in range(7)]
    assert told == once + once


def test_processes_use_one_thread_each_and_the_setting_is_put_back(monkeypatch):
    monkeypatch.setenv(parallel.THREADS[0], '7')
    monkeypatch.delenv(parallel.THREADS[1], raising=False)
    found = parallel.run([Job(os.getenv, (name,)) for name in parallel.THREADS], 1, lambda *_: None)
    assert found == ['1'] * len(parallel.THREADS)
    assert os.environ[parallel.THREADS[0]] == '7' and parallel.THREADS[1] not in os.environ


def test_what_a_part_raises_is_raised():
    with pytest.raises(ZeroDivisionError):
        parallel.run([Job(operator.truediv, (1, 0)), Job(pow, (2, 3))], 1, lambda *_: None)


def test_any_executor_runs_the_parts_and_stays_open():
    told = []
    with ThreadPoolExecutor(3) as executor:
        found = parallel.run(
            [Job(divmod, (k, 4)) for k in range(9)] + [Job(threading.get_ident, ())],
            executor,
            lambda done, whole: told.append((done, whole)),
        )
        with pytest.raises(ZeroDivisionError):
            parallel.run([Job(divmod, (1, 0)), Job(divmod, (1, 2))], executor, lambda *_: None)
        assert executor.submit(abs, -3).result() == 3
    assert found[:-1] == [divmod(k, 4) for k in range(9)]
    assert found[-1] != threading.get_ident()
    assert told == [(done, 10) for done in range(11)]
