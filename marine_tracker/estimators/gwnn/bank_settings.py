"""Settings of the filters that `gwnn` fuses, by vessel class, and of its strongest rivals."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...gaussian.leg_hypotheses import Habits
from .. import cs_kalman, imm
from ..imm import Modes

PERIOD = 60 / 22  # s, to which the settings refer


class BankSettings(NamedTuple):
    """What tells the bank of one vessel class from that of another.

    base       the IMM [4] that a silent network leaves: straight, any, turns right and left
    nine       the richer IMM [9]: three that go straight, then turns right and left by turns
    entered    [9] how readily each of the nine is entered when another is left
    second     another IMM [4]
    habits     of the straight legs
    manoeuvre  of CS-Kalman
    """

    base: Modes
    nine: Modes
    entered: tuple[float, ...]
    second: Modes
    habits: Habits
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
        second=TUNED_FOR_MANOEUVRE,
        habits=Habits(hold=1500.0, manoeuvre=20.0, noise=0.2),
        manoeuvre=cs_kalman.Manoeuvre(1.0, 1 / 60),
    ),
    # The product's own filters, so that the network begins where they are.
    'small_craft': BankSettings(
        base=imm.PRESETS['small_craft'],
        nine=_modes((0.005, 0.2, 1.5) + (0.1,) * 6, _turns(4, 10, 22), (0.97,) + (0.85,) * 8),
        entered=(1, 1, 0.5, 1, 1, 1, 1, 0.5, 0.5),
        second=STRONGEST['small_craft']['training'],
        habits=Habits(hold=600.0, manoeuvre=10.0, noise=4.0),
        manoeuvre=cs_kalman.PRESETS['small_craft'],
    ),
}
