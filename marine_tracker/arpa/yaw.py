"""Own ship's mean course and speed while she yaws.

In a seaway own ship's course swings by some degrees about every half minute. Extrapolated over the
TCPA limit, each swing would move the CPA of every target by a large part of a mile. So her velocity
is averaged over the longest time, up to HISTORY, in which

    it stayed within SWING times its own RMS deviation of its mean (no leg with another course),
    a straight line in time explains at most TREND of its variance (no turn, no slow drift),
    that deviation is at most WIDE of the speed (no deliberate zigzag).

A manoeuvre breaks the first two conditions as soon as it leaves the range of the yaw so far. The
averaging then stops at once. It starts again after LEAST without a manoeuvre. For a ship that does
not yaw, a change of course of one or two degrees is enough.

The average has Hann's weights. They leave less than 3 % of any swing of which two fit in.
"""

import numpy as np

from ..types import Array, OwnShip

HISTORY, LEAST = 120.0, 30.0  # s
STEP = 2.0  # s that one mean of samples covers
SWING, TREND, WIDE = 2.0, 0.15, 0.3
SMALL = 0.05  # m/s; smaller deviations are noise, not a swing
GAP = 5  # steps without a sample; after a longer gap, older samples are not used
FEW = 10  # means of samples; fewer cannot show a yaw


def mean_velocity(samples: OwnShip, time: float) -> tuple[Array, Array] | None:
    """Mean velocity [2] m/s of own ship at `time`, s, and its covariance [2, 2]."""
    velocity, age = _means(samples, time)
    count = np.arange(1, len(age) + 1)
    some = (count >= FEW) & (age >= LEAST - STEP)
    if not some.any():
        return None
    # A row for each number of means, the latest first; what lies before them is masked.
    within = np.tri(len(age), dtype=bool)[some]
    count = count[some]
    mean = np.cumsum(velocity, 0)[some] / count[:, None]
    off = np.where(within[..., None], velocity - mean[:, None], 0.0)
    variance = np.square(off).sum((1, 2)) / count
    ahead = np.where(within, age - (within @ age / count)[:, None], 0.0)
    slope = (ahead[..., None] * off).sum(1) / np.square(ahead).sum(1)[:, None]
    explained = np.square(slope).sum(1) * np.square(ahead).sum(1) / count
    rms, most = np.sqrt(variance), np.sqrt(np.square(off).sum(2).max(1))
    fit = (
        (most <= SWING * rms + SMALL)
        & ((explained <= TREND * variance) | (rms <= SMALL))
        & (rms <= WIDE * np.hypot(*mean.T) + SMALL)
    )
    if not fit.any():
        return None
    last = int(fit.nonzero()[0][-1])
    number = int(count[last])
    weight = np.square(np.sin(np.pi * (np.arange(number) + 0.5) / number))
    spread: Array = off[last, :number] / number
    return (
        weight @ velocity[:number] / weight.sum(),
        1.5 * (spread.T @ spread),  # as of independent means, with these weights
    )


def _means(samples: OwnShip, time: float) -> tuple[Array, Array]:
    """Means [K, 2] m/s of the velocities of every STEP s, the latest first, and their ages [K] s.

    They go back as far as HISTORY or the last gap.
    """
    step = np.floor((time - samples.time) / STEP)
    counts = (step >= 0) & (step < HISTORY / STEP) & np.isfinite(samples.velocity).all(1)
    step = step[counts].astype(np.int64)
    number = np.bincount(step)
    there = number.nonzero()[0]
    total = np.stack([np.bincount(step, column) for column in samples.velocity[counts].T], 1)
    gap = (np.diff(there, prepend=0) > GAP).nonzero()[0]
    there = there[: gap[0]] if len(gap) else there
    age = STEP * there.astype(np.float64) + STEP / 2
    return total[there] / number[there, None], age
