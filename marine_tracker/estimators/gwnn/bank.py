"""The banks of filters that `gwnn` fuses: three IMMs, four slow CV filters and CS-Kalman.

All take the same plots. They give 13 experts, each with its own estimate of the target:

    0-3    the modes of the base IMM: straight, any, turning right, turning left
    4-6    the nine-mode IMM: its mean, that of its right turns, that of its left turns
    7-10   constant velocity with little to much noise
    11     CS-Kalman, also the fallback of `gwnn`
    12     a second IMM, good where the base is not

With a network output of 0, the track is at the mean of the base IMM. There is one bank for each
vessel class (`BANKS`). They differ in data only (`BankSettings`).
"""

import hashlib
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...gaussian import linear_modes
from ...gaussian.linear import kalman_update
from ...types import Array, Plots
from .. import cs_kalman, imm
from ..contract import Velocity, first_velocity
from ..imm import Modes

PERIOD = 60 / 22  # s, to which the settings refer
EXPERTS = 13
BASE, RICH, SLOW, SECOND = slice(0, 4), slice(4, 13), slice(13, 17), slice(17, 21)
CS, SECOND_IMM = 11, 12  # experts
TURNS = ((2, 3), (5, 6))  # experts right and left


class BankSettings(NamedTuple):
    """What tells the bank of one vessel class from that of another.

    base       the IMM [4] that a silent network leaves: straight, any, turns right and left
    nine       the richer IMM [9]: three that go straight, then turns right and left by turns
    entered    [9] how readily each of the nine is entered when another is left
    slow       [4] m/s^2, deviation over a scan of the white acceleration of the CV filters
    second     another IMM [4]
    manoeuvre  of CS-Kalman
    """

    base: Modes
    nine: Modes
    entered: tuple[float, ...]
    slow: tuple[float, ...]
    second: Modes
    manoeuvre: cs_kalman.Manoeuvre


def _modes(
    acceleration: Sequence[float], turn_rate: Sequence[float], stay: tuple[float, ...]
) -> Modes:
    """Modes by the deviation, m/s^2, of their white acceleration over a scan."""
    return Modes(tuple(PERIOD * a * a for a in acceleration), tuple(turn_rate), stay, PERIOD)


def _turns(*degrees: float) -> tuple[float, ...]:
    """Turn rates of nine modes, the last six turning right and left by turns; degrees a second."""
    return (0, 0, 0, *np.radians([side * rate for rate in degrees for side in (1, -1)]).tolist())


# The strongest four-mode IMMs that `marine_tracker tune imm` finds, by what they are tuned for:
# every kind of motion and phase of the training tracks alike, or manoeuvres only.
TUNED_ON_ALL = Modes(
    noise=(2.7961e-06, 2.7429, 2.9895e-05, 2.9895e-05),
    turn_rate=(0, 0, 0.021336, -0.021336),
    stay=(0.99417, 0.95174, 0.91282, 0.91282),
    period=PERIOD,
)
TUNED_FOR_MANOEUVRE = Modes(
    noise=(1.8237e-06, 4.3522, 1.926e-05, 1.926e-05),
    turn_rate=(0, 0, 0.023911, -0.023911),
    stay=(0.93942, 0.98487, 0.93031, 0.93031),
    period=PERIOD,
)
STRONGEST = {
    'ship': {'training': TUNED_ON_ALL, 'manoeuvre': TUNED_FOR_MANOEUVRE},
    'small_craft': {
        'training': Modes(
            noise=(8.5223e-06, 0.12801, 0.48679, 0.48679),
            turn_rate=(0, 0, 0.20941, -0.20941),
            stay=(0.99492, 0.9547, 0.55, 0.55),
            period=PERIOD,
        ),
        'manoeuvre': Modes(
            noise=(5.6615e-05, 2.2873, 0.0091991, 0.0091991),
            turn_rate=(0, 0, 0.32648, -0.32648),
            stay=(0.9055, 0.90073, 0.75464, 0.75464),
            period=PERIOD,
        ),
    },
}

SETTINGS = {
    'ship': BankSettings(
        base=TUNED_ON_ALL,
        nine=_modes((0.0005, 0.05, 0.6) + (0.03,) * 6, _turns(1, 2.5, 6), (0.992,) + (0.85,) * 8),
        entered=(1, 1, 0.5, 1, 1, 1, 1, 0.5, 0.5),
        slow=(0.0005, 0.006, 0.03, 0.12),
        second=TUNED_FOR_MANOEUVRE,
        manoeuvre=cs_kalman.Manoeuvre(1.0, 1 / 60),
    ),
    # The product's own filters, so that the network begins where they are.
    'small_craft': BankSettings(
        base=imm.PRESETS['small_craft'],
        nine=_modes((0.005, 0.2, 1.5) + (0.1,) * 6, _turns(4, 10, 22), (0.97,) + (0.85,) * 8),
        entered=(1, 1, 0.5, 1, 1, 1, 1, 0.5, 0.5),
        slow=(0.002, 0.02, 0.1, 0.4),
        second=STRONGEST['small_craft']['training'],
        manoeuvre=cs_kalman.PRESETS['small_craft'],
    ),
}


class Filters(NamedTuple):
    """A bank, built of its settings.

    modes  all 21 with the three chains over them
    base   the base IMM alone
    start  [21]    mode probabilities of a track of one plot
    sides  [2, 9]  which of the nine modes turn right, and left
    mark   of the settings: weights belong to the filters that they were trained over
    """

    settings: BankSettings
    modes: linear_modes.Bank
    base: linear_modes.Bank
    start: Array
    sides: Array
    mark: str


def build(settings: BankSettings) -> Filters:
    """The bank with these settings."""
    slow = _modes(settings.slow, (0,) * 4, (1,) * 4)
    groups = (settings.base, settings.nine, slow, settings.second)
    chains = [
        linear_modes.Chain(at, linear_modes.transition_power(modes.stay, modes.period, entered))
        for at, modes, entered in (
            (BASE, settings.base, None),
            (RICH, settings.nine, settings.entered),
            (SECOND, settings.second, None),
        )
    ]
    modes = linear_modes.bank(
        sum((m.noise for m in groups), ()), sum((m.turn_rate for m in groups), ()), chains
    )
    start = np.ones(len(modes.noise))
    for chain in chains:
        start[chain.modes] = linear_modes.stationary(chain)
    turn_rate = modes.turn_rate[RICH, 0]
    base = linear_modes.bank(settings.base.noise, settings.base.turn_rate, chains[:1])
    return Filters(
        settings,
        modes,
        base,
        start,
        np.stack([turn_rate > 0, turn_rate < 0]).astype(float),
        _mark(settings),
    )


def _mark(settings: BankSettings) -> str:
    numbers = [
        number
        for modes in (settings.base, settings.nine, settings.second)
        for number in (*modes.noise, *modes.turn_rate, *modes.stay, modes.period)
    ]
    numbers += [*settings.entered, *settings.slow, *settings.manoeuvre]
    return hashlib.sha256(' '.join(f'{number:.9g}' for number in numbers).encode()).hexdigest()[:16]


BANKS = {name: build(settings) for name, settings in SETTINGS.items()}


class BankState(NamedTuple):
    """All filters' states.

    time           [N]         s, last plot
    weight         [N, 21]     mode probabilities, summing to 1 in each IMM
    rows           [N, 21, 14] means and packed covariances of the modes (`linear_modes`)
    cs_mean        [N, 6]      of CS-Kalman
    cs_covariance  [N, 6, 6]
    """

    time: Array
    weight: Array
    rows: Array
    cs_mean: Array
    cs_covariance: Array


class Ahead(NamedTuple):
    """What the filters expect at some time, axes last to first as in `linear_modes`.

    mean          [4, N]      of the base IMM: position m, velocity m/s
    experts       [4, 13, N]
    weight        [21, N]     mode probabilities
    acceleration  [2, N]      m/s^2, of CS-Kalman
    """

    mean: Array
    experts: Array
    weight: Array
    acceleration: Array


def begin(
    bank: Filters, plots: Plots, max_speed: float, velocity: Velocity | None = None
) -> BankState:
    """States of one plot each; max_speed m/s of the targets; what else is known of velocities."""
    count, j = len(plots.time), len(bank.start)
    velocity = first_velocity(velocity, count, max_speed)
    rows = np.zeros((count, j, 14))
    rows[..., :2], rows[..., 2:4] = plots.position[:, None], velocity.mean[:, None]
    rows[..., [4, 5, 8]] = linear_modes.packed_noise(plots.covariance).T[:, None]
    rows[..., 11:] = linear_modes.packed_noise(velocity.covariance).T[:, None]
    cs = cs_kalman.cs_kalman(bank.settings.manoeuvre, max_speed).init(plots, velocity)
    return BankState(
        plots.time.copy(), np.tile(bank.start, (count, 1)), rows, cs.mean, cs.covariance
    )


def look(bank: Filters, state: BankState, step: Array) -> Ahead:
    """What the filters expect after steps [N] s, or [1] for all; means only, which is cheap."""
    mean, weight = linear_modes.mix_means(bank.modes, state.rows[..., :4], state.weight, step)
    columns = linear_modes.move_means(bank.modes, linear_modes.columns_of(mean), step)
    cs = cs_kalman.predict_mean(state.cs_mean, step, bank.settings.manoeuvre)
    return _ahead(bank, columns, np.ascontiguousarray(weight.T), cs)


def base(bank: Filters, state: BankState, time: Array) -> Array:
    """Columns [14, N] of the base IMM at the times [N] s: mean and packed covariance."""
    step = time - state.time
    columns, weight = linear_modes.mix(bank.base, state.rows[:, BASE], state.weight[:, BASE], step)
    columns = linear_modes.move(bank.base, columns, step)
    return linear_modes.combine(columns, weight.T)


def _ahead(bank: Filters, columns: Array, weight: Array, cs: Array) -> Ahead:
    mean = (columns[:, BASE] * weight[BASE]).sum(1)
    experts = np.empty((4, EXPERTS, len(cs)))
    experts[:, :4] = columns[:, BASE]
    experts[:, 4] = (columns[:, RICH] * weight[RICH]).sum(1)
    for k in (0, 1):
        side = weight[RICH] * bank.sides[k][:, None]
        experts[:, 5 + k] = (columns[:, RICH] * (side / side.sum(0))).sum(1)
    experts[:, 7:11] = columns[:, SLOW]
    experts[:, CS] = cs[:, cs_kalman.POSITION_VELOCITY].T
    experts[:, SECOND_IMM] = (columns[:, SECOND] * weight[SECOND]).sum(1)
    return Ahead(mean, experts, weight, cs[:, [2, 5]].T)


class Expected(NamedTuple):
    """The filters just before a plot, and how well it fits.

    ahead    what they expect at the plot's time
    columns  [14, 21, N]  the modes
    cs       CS-Kalman's mean [N, 6] and covariance [N, 6, 6]
    nis      [N]  squared Mahalanobis distance of the plot by the base IMM
    """

    ahead: Ahead
    columns: Array
    cs: tuple[Array, Array]
    nis: Array


def expect(bank: Filters, state: BankState, plots: Plots) -> Expected:
    """The filters of N rows moved to the times of one plot each."""
    step = plots.time - state.time
    columns, weight = linear_modes.mix(bank.modes, state.rows, state.weight, step)
    columns = linear_modes.move(bank.modes, columns, step)
    weight = np.ascontiguousarray(weight.T)
    cs = cs_kalman.predict(state.cs_mean, state.cs_covariance, step, bank.settings.manoeuvre)
    mixture = linear_modes.combine(columns[:, BASE], weight[BASE])
    _, nis, _ = linear_modes.innovate(
        mixture, plots.position.T, linear_modes.packed_noise(plots.covariance)
    )
    return Expected(_ahead(bank, columns[:4], weight, cs[0]), columns, cs, nis)


def correct(bank: Filters, expected: Expected, plots: Plots) -> BankState:
    """The filters after the plots that `expect` was given."""
    columns, score = linear_modes.correct(
        expected.columns, plots.position.T, linear_modes.packed_noise(plots.covariance)
    )
    weight = expected.ahead.weight.copy()
    for chain in bank.modes.chains:
        weight[chain.modes] = linear_modes.reweigh(weight[chain.modes], score[chain.modes])
    mean, covariance = expected.cs
    mean, covariance, _, _ = kalman_update(
        mean,
        covariance,
        plots.position - mean[:, cs_kalman.POSITION],
        plots.covariance,
        cs_kalman.POSITION,
    )
    return BankState(
        plots.time, np.ascontiguousarray(weight.T), linear_modes.rows_of(columns), mean, covariance
    )
