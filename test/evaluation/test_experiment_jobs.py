"""Parts of an experiment in several processes."""

import operator
import os

import pytest

from marine_tracker.evaluation.experiments import jobs
from marine_tracker.evaluation.experiments.jobs import Job


def test_results_come_in_order_whatever_the_number_of_processes():
    planned = [Job(pow, (2, k)) for k in range(5)] + [Job(os.getpid, ())]
    told = []
    found = [jobs.run(planned, processes, lambda done, whole: told.append((done, whole)))
             for processes in (1, 2)]
    assert found[0][:-1] == found[1][:-1] == [2 ** k for k in range(5)]
    assert os.getpid() not in (found[0][-1], found[1][-1])
    once = [(done, 6) for done in range(7)]
    assert told == once + once


def test_processes_use_one_thread_each_and_the_setting_is_put_back(monkeypatch):
    monkeypatch.setenv(jobs.THREADS[0], '7')
    monkeypatch.delenv(jobs.THREADS[1], raising=False)
    found = jobs.run([Job(os.getenv, (name,)) for name in jobs.THREADS], 1, lambda *_: None)
    assert found == ['1'] * len(jobs.THREADS)
    assert os.environ[jobs.THREADS[0]] == '7' and jobs.THREADS[1] not in os.environ


def test_what_a_part_raises_is_raised():
    with pytest.raises(ZeroDivisionError):
        jobs.run([Job(operator.truediv, (1, 0)), Job(pow, (2, 3))], 1, lambda *_: None)
