import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

CHECKOUT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope='session')
def recordings():
    """The folder of real recordings that may stand beside the checkout."""
    folder = CHECKOUT.parent / 'shared' / 'data'
    if not folder.is_dir():
        pytest.skip(f'no real recordings: {folder} does not exist')
    return folder


@pytest.fixture(scope='session')
def command():
    """Run `python -m marine_tracker ARGUMENTS...` as a process; gives the CompletedProcess."""

    def run(*arguments, timeout=60, **environment):
        return subprocess.run(
            [sys.executable, '-m', 'marine_tracker', *map(str, arguments)],
            text=True,
            capture_output=True,
            timeout=timeout,
            env={**os.environ, 'PYTHONPATH': str(CHECKOUT), **environment},
        )

    return run


@pytest.fixture(scope='session')
def condition():
    """Mean and covariance of the last state of a linear-Gaussian chain, given all its plots.

    The whole trajectory is one Gaussian: x_0 ~ (mean, covariance), x_k = F_k x_{k-1} + u_k + w_k,
    z_k = H x_k + v_k. Its joint covariance is written out and conditioned on all z at once:
    no recursion over plots.
    """

    def solve(mean, covariance, steps, observe, plots):
        """steps: (F, u, Q) per plot; plots: (z, R) per plot."""
        n, m, count = len(mean), len(observe), len(steps)
        # Every state as a linear map of the sources [x_0, w_1, ..., w_K], plus an offset.
        source = np.zeros((n * (count + 1), n * (count + 1)))
        source[:n, :n] = covariance
        weight, offset = np.zeros((n, n * (count + 1))), np.array(mean, float)
        weight[:, :n] = np.eye(n)
        rows, centres = [], []
        for k, (transition, drive, noise) in enumerate(steps, 1):
            at = slice(n * k, n * (k + 1))
            weight, offset = transition @ weight, transition @ offset + drive
            weight[:, at] = np.eye(n)
            source[at, at] = noise
            rows.append(observe @ weight)
            centres.append(observe @ offset)
        seen, centre = np.concatenate(rows), np.concatenate(centres)
        spread = seen @ source @ seen.T
        for k, (_, noise) in enumerate(plots):
            at = slice(m * k, m * (k + 1))
            spread[at, at] += noise
        cross = weight @ source @ seen.T
        gain = np.linalg.solve(spread, cross.T).T
        measured = np.concatenate([z for z, _ in plots])
        return offset + gain @ (measured - centre), weight @ source @ weight.T - gain @ cross.T

    return solve
