"""Crowds of plots: one case of the experiment, and the whole table as a slow test."""

import numpy as np
import pytest

from marine_tracker.evaluation import parallel
from marine_tracker.evaluation.result import silent
from marine_tracker.lab.dense import dense
from marine_tracker.lab.dense.patterns import PATTERNS


@pytest.mark.parametrize('name', PATTERNS)
def test_a_pattern_has_as_many_plots_as_asked(name):
    one, two = (PATTERNS[name](777, np.random.default_rng(seed)) for seed in (1, 2))
    assert one.shape == two.shape == (777, 2)
    assert np.isfinite(one).all()


@pytest.mark.parametrize(('name', 'extent'), [('two clouds', 'none'), ('ball', 'gp')])
def test_ten_thousand_plots_fit_into_memory_and_targets_elsewhere_are_kept(name, extent):
    """In a process of its own, whose memory is measured; all pairs would take 18 GB and 1.6 GB."""
    job = parallel.Job(dense.measure, (name, 10000, 3, 'imm', extent, 2))
    (case,) = parallel.run([job], 1, silent)
    assert case.memory_mb <= dense.MOST_MB
    assert case.kept == dense.SHIPS
    assert case.left_out > 1_000_000


def test_without_a_crowd_nothing_is_left_out():
    assert dense.measure('rain cell', 60, 3, 'imm').left_out == 0


@pytest.mark.slow
@pytest.mark.timeout(1800)
@pytest.mark.parametrize('extent', ['none', 'gp'])
def test_all_figures_are_met(extent):
    found = dense.run(1, 2, extent=extent)
    assert not [figure for figure in found.figures if figure.ok is False]
