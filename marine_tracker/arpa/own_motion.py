"""Own ship's smoothed motion, and sea or ground stabilisation of all motion."""

import numpy as np

from ..geometry import own_ship_at
from ..types import Array, OwnShip, append, take
from .cpa import OwnMotion
from .motion import Motion
from .yaw import HISTORY, mean_velocity

WINDOW = 10.0  # s; own ship's velocity is smoothed over this time while she manoeuvres
LEAST_SIGMA = 0.01  # m/s, of own velocity, because few samples may agree by chance


def lately(before: OwnShip, now: OwnShip, end: float) -> OwnShip:
    """The samples to use at the time `end`, s: those of the scan, and of scans before it."""
    before = take(before, (before.time > end - HISTORY) & (before.time < now.time[0]))
    return append(before, now._replace(heading=None))  # the heading is known by another way


def own_motion(samples: OwnShip, time: float, heading: float, window: float = WINDOW) -> OwnMotion:
    """Own ship over ground at `time`, s, from the samples of the `window` s before.

    If she continues as before, the velocity is the mean without her yaw (see `yaw`). If she
    manoeuvres, it is a straight-line fit in time, so a steady turn does not lag; its covariance
    comes from the scatter of the samples about the fit. Plots are placed from the same position, so
    it has no error of its own. heading rad, true. ValueError if there is no sample.
    """
    if not len(samples.time):
        raise ValueError('own ship has no sample; at least one is needed')
    position, velocity = own_ship_at(samples, time)
    near = (samples.time > time - window) & (samples.time <= time)
    covariance = np.zeros((4, 4))
    covariance[2:, 2:] = LEAST_SIGMA**2 * np.eye(2)
    on_the_whole = mean_velocity(samples, time)
    if on_the_whole is not None:
        velocity = on_the_whole[0]
        covariance[2:, 2:] += on_the_whole[1]
    elif near.sum() >= 4:
        ahead = samples.time[near] - time
        design = np.stack([np.ones_like(ahead), ahead], 1)
        inverse = np.linalg.pinv(design.T @ design)
        fit = inverse @ design.T @ samples.velocity[near]
        rest = samples.velocity[near] - design @ fit
        velocity = fit[0]
        covariance[2:, 2:] += inverse[0, 0] * rest.T @ rest / (len(ahead) - 2)
    return OwnMotion(position, velocity, heading, covariance)


def sea_stabilised(motion: Motion, own: OwnMotion, drift: Array) -> tuple[Motion, OwnMotion]:
    """Motion of targets and own ship through water that moves with `drift` [2] m/s.

    Relative values (CPA, TCPA, bow crossing) do not change. Courses and speeds are then those
    through the water. Aspect and the rules of the road are judged by these.
    """
    return (
        motion._replace(velocity=motion.velocity - drift),
        own._replace(velocity=own.velocity - drift),
    )


def vectors(motion: Motion, own: OwnMotion, duration: float, relative: bool) -> Array:
    """Ends [N, 2] m of the targets' vectors: where they will be in `duration` s.

    relative  as seen from own ship, which stays in place; else true
    """
    return motion.position + duration * (motion.velocity - own.velocity * relative)
