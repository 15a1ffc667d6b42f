"""Whether the network of `gwnn` is used: its expectations are compared with CS-Kalman's.

J is the mean squared residual of a filter's expectations, in the plots' own sigmas, over about the
last twelve plots. A track falls back on CS-Kalman when the J of its network exceeds that of
CS-Kalman by more than `Trust.fall`, or that of the base IMM, which the network only corrects, by
more than `Trust.excess`, or when the network's output is not a number. It returns when the network
has been better than CS-Kalman, and not worse than the base, often enough in a row.
"""

from typing import NamedTuple

import numpy as np

from ...types import Array, Plots
from ..contract import Account
from . import bank as filters
from . import inputs

WARM = 8  # plots before the network is used
KEEP, KEEP_LATELY = 0.9, 0.7  # of J, a plot: to fall back; to return
WORST = 25.0  # largest squared residual that counts
EXPECTED = 2.2  # squared residual of a good filter, sigma^2: where J starts
WARMUP, GWNN, FALLBACK = 0.0, 1.0, 2.0
STATUS = ('WARMUP', 'GWNN', 'FALLBACK')
REASONS = (
    '',
    'expectations worse than those of CS-Kalman',
    'network output is not a number',
    'network output out of all proportion',
    'expectations worse than those of its own filters',
)
OWN_FILTERS = 4.0  # the last of these


class Trust(NamedTuple):
    """When a track falls back on CS-Kalman, and when it returns to the network.

    fall    J of the network over J of CS-Kalman above which the track falls back
    excess  J of the network less J of the base above which it falls back, sigma^2
    back    J of the network over J of CS-Kalman of the last few plots, below which the network
            counts as the better one, if it is not above the base's by half the excess either
    times   plots in a row at which it must be the better one to be heard again
    """

    fall: float = 2.0
    excess: float = 3.0
    back: float = 1.0
    times: int = 3


TRUST = Trust()


class Monitor(NamedTuple):
    """The state of the network, [N] each.

    status      WARMUP, GWNN or FALLBACK
    network     J of the network, used or not: mean squared residual of its expectations, sigma^2
    cs          J of CS-Kalman
    base        J of the base IMM
    lately      all three again, [N, 3], over fewer plots
    better      plots in a row at which an unused network was the better one
    reason      of FALLBACK: index into REASONS
    """

    status: Array
    network: Array
    cs: Array
    base: Array
    lately: Array
    better: Array
    reason: Array


def begin(count: int) -> Monitor:
    """Monitors of new tracks."""
    zero, usual = np.zeros(count), np.full(count, EXPECTED)
    lately = np.full((count, 3), EXPECTED)
    return Monitor(zero, usual, usual, usual, lately, zero, zero)


def account(monitor: Monitor) -> Account:
    """The state of the network, compared with CS-Kalman."""
    status = monitor.status.astype(np.int8)
    unknown = status == WARMUP
    rho, network, cs = (
        np.where(unknown, np.nan, one)
        for one in (monitor.network / monitor.cs, monitor.network, monitor.cs)
    )
    return Account(STATUS, status, rho, network, cs, REASONS, monitor.reason.astype(np.int8))


def judge(
    monitor: Monitor,
    plots: Plots,
    ahead: filters.Ahead,
    shift: Array,
    memory: inputs.ResidualMemory,
    wrong: Array,
    trust: Trust = TRUST,
) -> Monitor:
    """The monitor after one plot each.

    shift   [4, N]  the network's correction of the base, m
    memory  after the plots
    wrong   [N]     the flaw of the network's new output: index into REASONS
    """
    sigma = inputs.frame_of(plots)[:, 2:].T

    def residual(position: Array) -> Array:
        off = inputs.turn(memory.frame, plots.position.T - position) / sigma
        size = (off * off).sum(0)
        return np.where(size < WORST, size, WORST)  # nan counts as worst

    speaking = memory.plots > WARM  # before, its output was still empty
    base = ahead.mean[:2]
    places = base + shift[:2], ahead.experts[:2, filters.CS], base
    residuals = np.stack([residual(place) for place in places], 1)

    def averaged(j: Array, keep: float) -> Array:
        return np.where(speaking[:, None], keep * j + (1 - keep) * residuals, j)

    network, cs, own = averaged(np.stack([monitor.network, monitor.cs, monitor.base], 1), KEEP).T
    lately = averaged(monitor.lately, KEEP_LATELY)
    rho = network / cs
    sound = wrong == 0
    fallen = monitor.status == FALLBACK
    off = network - own > trust.excess
    fit = sound & (lately[:, 0] < trust.back * lately[:, 1])
    fit &= lately[:, 0] < lately[:, 2] + 0.5 * trust.excess
    better = np.where(fallen & fit, monitor.better + 1, 0.0)
    away = np.where(fallen, better < trust.times, (rho > trust.fall) | off) | ~sound
    status = np.where(memory.plots < WARM, WARMUP, np.where(away, FALLBACK, GWNN))
    reason = np.where(
        status != FALLBACK,
        0.0,
        np.where(
            ~sound,
            wrong,
            np.where(
                fallen,
                np.maximum(monitor.reason, 1.0),
                np.where(rho > trust.fall, 1.0, OWN_FILTERS),
            ),
        ),
    )
    return Monitor(status, network, cs, own, lately, better, reason)
