"""Settings of simpler filters, found by `marine_tracker tune`."""

from typing import NamedTuple

from ..estimators import cs_kalman
from ..estimators.gwnn.bank_settings import PERIOD
from ..estimators.imm import Modes


class Tuned(NamedTuple):
    """Simpler rivals: two modes CV/CV, one mode CV, CS-Kalman.

    Tuned as the IMM, with equal weight for every kind of motion and phase (`marine_tracker tune
    cv_cv`, `cv` and `cs`).
    """

    cv_cv: Modes
    cv: Modes
    cs: cs_kalman.Manoeuvre


TUNED = {
    'ship': Tuned(
        Modes((4.5312e-08, 1.5243), (0, 0), (0.99628, 0.94436), PERIOD),
        Modes((0.31743,), (0,), (1,), PERIOD),
        cs_kalman.Manoeuvre(2.2385, 7.1334),
    ),
    'small_craft': Tuned(
        Modes((2.03e-4, 2.5317), (0, 0), (0.99129, 0.94325), PERIOD),
        Modes((0.24226,), (0,), (1,), PERIOD),
        cs_kalman.Manoeuvre(3.0764, 19.76),
    ),
}
