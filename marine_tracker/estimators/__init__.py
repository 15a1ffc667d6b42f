"""Estimators by name. An entry makes the estimator from the tracker's parameters."""

from collections.abc import Callable

from ..parameters import TrackerParameters
from . import alpha_beta, cs_kalman, cs_rough_nn, imm, wavelet_cs
from .contract import Account, Estimator, Velocity
from .gwnn import gwnn, gwnn_paper

ESTIMATORS: dict[str, Callable[[TrackerParameters], Estimator]] = {
    'cs_kalman': lambda p: cs_kalman.cs_kalman(
        cs_kalman.PRESETS[p.vessel_class], p.max_target_speed_mps
    ),
    'imm': lambda p: imm.imm(imm.PRESETS[p.vessel_class], p.max_target_speed_mps),
    'gwnn': lambda p: gwnn.gwnn(
        gwnn.weights(p.gwnn_weights, p.vessel_class),
        p.max_target_speed_mps,
        p.scan_period_s,
        learning=p.gwnn_learning,
        vessel_class=p.vessel_class,
    ),
    'cs_rough_nn': lambda p: cs_rough_nn.parallel(
        cs_kalman.PRESETS[p.vessel_class], p.max_target_speed_mps, cs_rough_nn.weights('rough')
    ),
    'cs_bp_nn': lambda p: cs_rough_nn.parallel(
        cs_kalman.PRESETS[p.vessel_class], p.max_target_speed_mps, cs_rough_nn.weights('bp')
    ),
    'gwnn_paper': lambda p: gwnn_paper.gwnn_paper(
        cs_kalman.PRESETS[p.vessel_class], p.max_target_speed_mps, p.scan_period_s
    ),
    'wavelet_cs': lambda p: wavelet_cs.wavelet_cs(wavelet_cs.MANOEUVRE, p.max_target_speed_mps),
    'alpha_beta': lambda p: alpha_beta.alpha_beta(
        p.alpha_beta_mode,
        p.max_target_speed_mps,
        p.radial_speed_sigma_mps,
        alpha_beta.NOISE[p.vessel_class],
        p.scan_period_s if p.radars else 0.0,
    ),
}


# Estimators that are of little use where plots tell no radial speed: users are warned.
WANT_DOPPLER = ('alpha_beta',)

__all__ = ['ESTIMATORS', 'WANT_DOPPLER', 'Account', 'Estimator', 'Velocity']
