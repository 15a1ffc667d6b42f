"""Estimators by name. An entry makes the estimator from the tracker's parameters."""

from collections.abc import Callable

from ..parameters import TrackerParameters
from . import cs_kalman, imm
from .contract import Estimator

ESTIMATORS: dict[str, Callable[[TrackerParameters], Estimator]] = {
    'cs_kalman': lambda p: cs_kalman.cs_kalman(cs_kalman.PRESETS[p.vessel_class],
                                                p.max_target_speed_mps),
    'imm': lambda p: imm.imm(imm.PRESETS[p.vessel_class], p.max_target_speed_mps),
}

__all__ = ['ESTIMATORS', 'Estimator']
