"""Own ship at anchor: whether she is, and which targets are a danger to her there.

She counts as anchored if her speed is certainly below AT_REST. She also counts as anchored if she
swings: her speed is always below SWINGING, and below AT_REST on average. The parameter
`own_ship_status` may state it as well, for example when wind and stream swing her for minutes. That
does not apply above SWINGING, because then the anchor is not holding.
"""

import numpy as np

from ..gaussian.linear import invert_2x2, squared_distance
from ..geometry import AT_REST
from ..types import BoolArray, OwnShip
from .cpa import OwnMotion
from .motion import Motion
from .yaw import HISTORY

SWINGING = 1.0  # m/s; maximum speed of a ship at anchor
BY_CHANCE = 11.8  # squared distance of a velocity from 0, of 2 dimensions: 3 sigma
SURELY = 3.0  # deviations of the speed towards own ship
DETECTED, ANCHORED, UNDER_WAY = STATUS = 'detected', 'anchored', 'under_way'


def makes_way(moving: Motion) -> BoolArray:
    """Whether [N] tracks certainly move over ground. A new track at anchor shows some speed from
    noise.
    """
    inverse, _ = invert_2x2(moving.covariance[:, 2:, 2:])
    return ~moving.stationary & (squared_distance(moving.velocity, inverse) > BY_CHANCE)


def at_anchor(samples: OwnShip, own: OwnMotion, time: float, status: str = DETECTED) -> bool:
    """Whether own ship is at anchor, from her recent samples and her motion at `time`, s.

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


def harmless(moving: Motion, own: OwnMotion) -> BoolArray:
    """Whether [N] targets are no danger to own ship at anchor: they do not certainly come nearer.

    moving  over ground
    """
    offset = moving.position - own.position
    towards = -offset / np.maximum(np.hypot(*offset.T), 1e-9)[:, None]
    closing = (moving.velocity * towards).sum(1)
    variance = np.einsum('ni,nij,nj->n', towards, moving.covariance[:, 2:, 2:], towards)
    surely: BoolArray = closing > SURELY * np.sqrt(variance)
    return ~(makes_way(moving) & surely)
