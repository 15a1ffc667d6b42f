"""Estimators by name. An entry makes the estimator from the tracker's parameters."""

from collections.abc import Callable

from ..parameters import TrackerParameters
from . import cs_kalman, gwnn, gwnn_paper, imm
from .contract import Estimator, Velocity

ESTIMATORS: dict[str, Callable[[TrackerParameters], Estimator]] = {
    'cs_kalman': lambda p: cs_kalman.cs_kalman(cs_kalman.PRESETS[p.vessel_class],
                                                p.max_target_speed_mps),
    'imm': lambda p: imm.imm(imm.PRESETS[p.vessel_class], p.max_target_speed_mps),
    'gwnn': lambda p: gwnn.gwnn(gwnn.weights(p.gwnn_weights), p.max_target_speed_mps,
                                p.scan_period_s),
    'gwnn_paper': lambda p: gwnn_paper.gwnn_paper(
        cs_kalman.PRESETS[p.vessel_class], p.max_target_speed_mps, p.scan_period_s),
}

__all__ = ['ESTIMATORS', 'Estimator', 'Velocity']
