"""How close the hulls of targets come to own ship, should all go straight on: an advisory.

CPA counts from a target's middle; the hull of a large ship comes nearer by up to half her length.
"""

import numpy as np

from ..types import Array, BoolArray

STEPS = 4  # points on each side of an outline, between which the distance hardly bends


def hull_clearance(outline: Array, position: Array, velocity: Array) -> Array:
    """Least distance [T] m of own ship to the outlines from now on, 0 where she runs into one.

    outline   [T, K, 2]  m, corners of each hull from the target's middle, in order
    position  [T, 2]     m, of the middle from own ship
    velocity  [T, 2]     m/s, relative to own ship's
    Own ship is a point; nan where the motion is not known.
    """
    share = np.arange(STEPS) / STEPS
    following = np.roll(outline, -1, 1)
    points = outline[:, :, None] + share[:, None] * (following - outline)[:, :, None]
    points = points.reshape(len(outline), STEPS * outline.shape[1], 2) + position[:, None]
    speed = np.hypot(*velocity.T)
    way = velocity / np.maximum(speed, 1e-9)[:, None]
    # Own ship lies at the origin; each point passes it along `way`, from where it is now.
    run = np.maximum(-(points * way[:, None]).sum(-1), 0.0)
    distance = np.hypot(*np.moveaxis(points + run[..., None] * way[:, None], -1, 0)).min(1)
    across = points[..., 0] * way[:, None, 1] - points[..., 1] * way[:, None, 0]
    ahead = np.maximum(-(points * way[:, None]).sum(-1), 0.0).max(1) > 0
    through = (across.min(1) < 0) & (across.max(1) > 0) & ahead & (speed > 0)
    return np.where(through | _inside(points), 0.0, distance)


def _inside(points: Array) -> BoolArray:
    """Whether the origin lies inside the polygons [T, P, 2]: the angles to corners go round it."""
    angle = np.arctan2(points[..., 0], points[..., 1])
    turn = np.mod(np.diff(angle, axis=1, append=angle[:, :1]) + np.pi, 2 * np.pi) - np.pi
    found: BoolArray = np.abs(turn.sum(1)) > np.pi
    return found
