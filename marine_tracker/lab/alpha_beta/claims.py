"""What paper 002 claims for its adaptive alpha-beta filter, and what was found."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...evaluation.report import Claim
from ...evaluation.result import IN_PART, NOT_BORNE_OUT, verdict

SOURCE = 'paper 002'


def claims(found: Mapping[str, Any], faster: Mapping[str, float]) -> list[Claim]:
    """Verdicts from the summaries by filter name, and from the shares lost with a faster crossing
    ship (alpha_beta.py).
    """
    ours, soft, one, two = (found[name] for name in ('hf', 'hf_soft', 'method1', 'method2'))
    kalman = found['polar Kalman']
    km, kmh, deg = 1e3, 1 / 3.6, np.radians(1)
    rates = ', '.join(f'{name} {100 * row.lost:.1f} %' for name, row in found.items())
    harder = ', '.join(f'{name} {100 * share:.0f} %' for name, share in faster.items())
    ok_two, ok_rest = two.lost >= 0.6, max(one.lost, ours.lost) <= 0.02
    better = ours.error < one.error
    return [
        Claim(
            SOURCE,
            "method 2 loses the fifth ship in 77 % of the runs, method 1 and the paper's in 1 %",
            f'lost: {rates}; a ship that crosses changes its radial speed all '
            f'the time, and the shares of method 2 die away. At 40 km/h: {harder}',
            verdict(ok_two and ok_rest, IN_PART if ok_two else NOT_BORNE_OUT),
        ),
        Claim(
            SOURCE,
            'range and bearing are more accurate than those of method 1, the radial speed alike',
            f'hf against method1: {ours.error[0] / km:.2f} / '
            f'{one.error[0] / km:.2f} km, {ours.error[2] / deg:.2f} / {one.error[2] / deg:.2f} '
            f'deg, {ours.error[1] / kmh:.2f} / {one.error[1] / kmh:.2f} km/h; hf_soft '
            f'{soft.error[0] / km:.2f} km, {soft.error[2] / deg:.2f} deg, '
            f'{soft.error[1] / kmh:.2f} km/h',
            verdict(better[0] and better[2], IN_PART if better[0] or better[2] else NOT_BORNE_OUT),
        ),
        Claim(
            SOURCE,
            'its tracks are smoother than those of method 1',
            f'second difference of the place from scan to scan: hf {ours.roughness / km:.2f} km, '
            f'method1 {one.roughness / km:.2f} km, hf_soft {soft.roughness / km:.2f} km',
            verdict(ours.roughness < one.roughness),
        ),
        Claim(
            SOURCE,
            'adaptive shares reach the higher accuracy',
            f'a Kalman filter of the same model on the same plots: lost {100 * kalman.lost:.1f} '
            f'%, {kalman.error[0] / km:.2f} km, {kalman.error[1] / kmh:.2f} km/h, '
            f'{kalman.error[2] / deg:.2f} deg, against {ours.error[0] / km:.2f} km, '
            f'{ours.error[1] / kmh:.2f} km/h, {ours.error[2] / deg:.2f} deg of hf',
            verdict((ours.error < kalman.error).all()),
        ),
    ]
