"""Own ship at anchor: when she is, and who may be a danger to her there.

She counts as anchored where she surely makes no way: slower than AT_REST, or, swinging to her
anchor, slower than SWINGING all the time and than AT_REST on the whole. The parameter
`own_ship_status` may say so as well, as where wind and stream swing her for minutes; it does not
hold once she makes more than SWINGING, for then the anchor does not hold either.
"""

import numpy as np
from numpy.typing import NDArray

from ..gaussian.linear import invert_2x2, squared_distance
from ..types import OwnShip
from .cpa import OwnMotion
from .motion import Motion
from .yaw import HISTORY

AT_REST = 0.25  # m/s, below which own ship makes no way
SWINGING = 1.0  # m/s, the most that a ship at anchor makes
BY_CHANCE = 11.8  # squared distance of a velocity from 0, of 2 dimensions: 3 sigma
SURELY = 3.0  # deviations of the speed towards own ship
DETECTED, ANCHORED, UNDER_WAY = STATUS = 'detected', 'anchored', 'under_way'


def makes_way(moving: Motion) -> NDArray[np.bool_]:
    """Whether [N] tracks surely move over ground; a new one at anchor shows some speed by noise."""
    inverse, _ = invert_2x2(moving.covariance[:, 2:, 2:])
    return ~moving.stationary & (squared_distance(moving.velocity, inverse) > BY_CHANCE)


def at_anchor(samples: OwnShip, own: OwnMotion, time: float, status: str = DETECTED) -> bool:
    """Whether own ship, with the samples of late and that motion at `time`, s, lies at anchor.

    status  DETECTED, ANCHORED or UNDER_WAY
    """
    if status == UNDER_WAY:
        return False
    lately = samples.velocity[samples.time > time - HISTORY]
    slow = np.hypot(*own.velocity) < AT_REST
    swings = bool(len(lately)) and bool((np.hypot(*lately.T) < SWINGING).all())
    if status == ANCHORED:
        return bool(slow or swings)
    held = time - samples.time[0] >= 0.5 * HISTORY
    return bool(slow or (held and swings and np.hypot(*lately.mean(0)) < AT_REST))


def harmless(moving: Motion, own: OwnMotion) -> NDArray[np.bool_]:
    """Whether [N] targets are no danger to own ship at anchor: they do not surely come nearer.

    moving  over ground
    """
    offset = moving.position - own.position
    towards = -offset / np.maximum(np.hypot(*offset.T), 1e-9)[:, None]
    closing = (moving.velocity * towards).sum(1)
    variance = np.einsum('ni,nij,nj->n', towards, moving.covariance[:, 2:, 2:], towards)
    return ~(makes_way(moving) & (closing > SURELY * np.sqrt(variance)))
