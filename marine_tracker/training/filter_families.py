"""The filters that a search may tune: which of their settings, and within which bounds."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..estimators import cs_kalman, imm
from ..estimators.contract import Estimator
from ..types import Numbers
from . import training_tracks

PERIOD = 60 / 22  # s, to which the settings refer

# Least and most of what is searched, by its logarithm. Noises are deviations, m/s^2, of the
# acceleration over a scan; a mode is left with the chance stated in a scan.
BOUNDS = {
    'quiet_noise': (1e-4, 0.1),
    'loud_noise': (0.03, 5.0),
    'noise': (1e-3, 5.0),  # of the only mode
    'turn_noise': (1e-4, 1.0),
    'turn_rate': (0.003, 0.45),  # rad/s
    'leave_quiet': (1e-4, 0.3),
    'leave_loud': (0.01, 0.45),
    'leave_turn': (0.01, 0.45),
    'max_acceleration': (0.05, 5.0),  # m/s^2, of CS-Kalman
    'frequency': (1 / 300, 20.0),  # 1/s, likewise
}

Settings = imm.Modes | cs_kalman.Manoeuvre


class Family(NamedTuple):
    """Filters of one form: what is searched, names of BOUNDS, and the settings of such values."""

    searched: tuple[str, ...]
    settings: Callable[..., Settings]

    def at(self, point: Numbers) -> Settings:
        """The settings at a point of the search, each coordinate 0 to 1 over its bounds."""
        low, high = np.log(np.array([BOUNDS[name] for name in self.searched])).T
        return self.settings(*map(float, np.exp(low + np.clip(point, 0, 1) * (high - low))))


def _four_modes(quiet, loud, turn, rate, leave_quiet, leave_loud, leave_turn) -> imm.Modes:
    return _modes(
        (quiet, loud, turn, turn),
        (0.0, 0.0, rate, -rate),
        (leave_quiet, leave_loud, leave_turn, leave_turn),
    )


def _modes(acceleration, turn_rate, leave) -> imm.Modes:
    return imm.Modes(
        tuple(PERIOD * one**2 for one in acceleration),
        turn_rate,
        tuple(1 - one for one in leave),
        PERIOD,
    )


FAMILIES = {
    'imm': Family(
        (
            'quiet_noise',
            'loud_noise',
            'turn_noise',
            'turn_rate',
            'leave_quiet',
            'leave_loud',
            'leave_turn',
        ),
        _four_modes,
    ),
    'cv_cv': Family(
        ('quiet_noise', 'loud_noise', 'leave_quiet', 'leave_loud'),
        lambda quiet, loud, *leave: _modes((quiet, loud), (0.0, 0.0), leave),
    ),
    'cv': Family(('noise',), lambda noise: _modes((noise,), (0.0,), (0.0,))),
    'cs': Family(('max_acceleration', 'frequency'), cs_kalman.Manoeuvre),
}
IMM = FAMILIES['imm']


def filter_of(settings: Settings) -> Estimator:
    """The filter with these settings."""
    if isinstance(settings, cs_kalman.Manoeuvre):
        return cs_kalman.cs_kalman(settings, training_tracks.SPEED)
    return imm.imm(settings, training_tracks.SPEED)


def as_text(settings: Settings) -> str:
    """The settings as Python, to paste."""

    def value_text(value):
        if isinstance(value, tuple):
            return f'({", ".join(f"{one:.5g}" for one in value)}{"," * (len(value) == 1)})'
        return '60 / 22' if value == PERIOD else f'{value:.5g}'

    values = ', '.join(f'{name}={value_text(value)}' for name, value in settings._asdict().items())
    return f'{type(settings).__name__}({values})'
