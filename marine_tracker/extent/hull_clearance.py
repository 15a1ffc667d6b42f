"""How close the hulls of targets will come to own ship if all keep course and speed. An advisory.

CPA is counted from a target's middle. The hull of a large ship comes nearer, by up to half its
length.
"""

import numpy as np

from ..types import Array, BoolArray

STEPS = 4  # points on each side of an outline; the distance is almost linear between them


def hull_clearance(outline: Array, position: Array, velocity: Array) -> Array:
    """Least distance [T] m from now on between own ship and the outlines; 0 if she runs into one.

    outline   [T, K, 2]  m, corners of each hull from the target's middle, in order
    position  [T, 2]     m, of the middle from own ship
    velocity  [T, 2]     m/s, relative to own ship's
    Own ship is a point. nan if the motion is unknown.
    """
    share = np.arange(STEPS) / STEPS
    following = np.roll(outline, -1, 1)
    points = outline[:, :, None] + share[:, None] * (following - outline)[:, :, None]
    points = points.reshape(len(outline), STEPS * outline.shape[1], 2) + position[:, None]
    speed = np.hypot(*velocity.T)
    way = velocity / np.maximum(speed, 1e-9)[:, None]
    # Own ship is at the origin. Each point moves past it along `way`, from its present place.
    run = np.maximum(-(points * way[:, None]).sum(-1), 0.0)
    distance = np.hypot(*np.moveaxis(points + run[..., None] * way[:, None], -1, 0)).min(1)
    across = points[..., 0] * way[:, None, 1] - points[..., 1] * way[:, None, 0]
    ahead = np.maximum(-(points * way[:, None]).sum(-1), 0.0).max(1) > 0
    through = (across.min(1) < 0) & (across.max(1) > 0) & ahead & (speed > 0)
    return np.where(through | _inside(points), 0.0, distance)


def _inside(points: Array) -> BoolArray:
    """Whether the origin lies inside the polygons [T, P, 2]: then the angles to the corners go once
    around it.
    """
    angle = np.arctan2(points[..., 0], points[..., 1])
    turn = np.mod(np.diff(angle, axis=1, append=angle[:, :1]) + np.pi, 2 * np.pi) - np.pi
    found: BoolArray = np.abs(turn.sum(1)) > np.pi
    return found
