import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from marine_tracker.types import OwnShip, Spokes

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


AT_REST = OwnShip(np.array([0.0]), np.zeros((1, 2)), np.zeros((1, 2)), np.array([0.0]))
DB_STEP = {4: 3.5, 8: 0.35, 16: 0.0015}


def make_video(
    echoes=(),
    spokes=900,
    samples=400,
    range_step=12.0,
    beam=2.4,
    pulse=30.0,
    bits=8,
    floor=0.25,
    period=2.5,
    seed=5,
    noise=None,
):
    """A revolution of spokes with point echoes (range m, bearing deg, peak SNR dB).

    floor  of the scale, where the mean of the noise lies; noise: its power, else exponential
    """
    random = np.random.default_rng(seed)
    angle = np.arange(spokes) * (2 * np.pi / spokes)
    middle = (np.arange(samples) + 0.5) * range_step
    shape = (spokes, samples)
    field = random.standard_normal(shape) + 1j * random.standard_normal(shape)
    field *= np.sqrt(0.5)
    for range_, bearing, snr in echoes:
        off = np.mod(angle - np.radians(bearing) + np.pi, 2 * np.pi) - np.pi
        two_way = 2.0 ** (-4 * (off / np.radians(beam)) ** 2)
        gate = 2.0 ** (-2 * ((middle - range_) / pulse) ** 2)
        phase = np.exp(2j * np.pi * random.random(spokes))
        field += 10 ** (snr / 20) * (two_way * phase)[:, None] * gate
    power = np.abs(field) ** 2
    if noise is not None:
        power = power - 0.0 + (noise(random, shape) - 1.0).clip(0)
    full = 2**bits - 1
    value = floor * full + 10 * np.log10(power) / DB_STEP[bits]
    strength = np.clip(np.floor(value), 0, full).astype(np.uint8 if bits <= 8 else np.uint16)
    time = np.arange(spokes) * (period / spokes)
    return Spokes(time, angle, np.full(spokes, range_step), strength, AT_REST)


def cut(spokes, size):
    """The spokes in sectors of this many."""
    for first in range(0, len(spokes.time), size):
        part = slice(first, first + size)
        yield Spokes(
            spokes.time[part],
            spokes.bearing[part],
            spokes.range_step[part],
            spokes.strength[part].copy(),
            spokes.own_ship,
        )


def turned(spokes, revolutions, period=2.5):
    """The same revolution again and again."""
    return Spokes(
        np.concatenate([spokes.time + k * period for k in range(revolutions)]),
        np.tile(spokes.bearing, revolutions),
        np.tile(spokes.range_step, revolutions),
        np.tile(spokes.strength, (revolutions, 1)),
        spokes.own_ship,
    )


@pytest.fixture(scope='session')
def pictures():
    """Radar video: make a revolution, cut it into sectors, turn it again and again."""
    return SimpleNamespace(make=make_video, cut=cut, turned=turned)
