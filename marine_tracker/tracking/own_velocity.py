"""Own ship's velocity over ground: as it is told, and as her positions tell it.

Odometry may lack a velocity (a GPS alone), have one that cannot be turned to east and north (no
heading), in wrong axes, or through the water. Her positions then go elsewhere than the velocity
says, and they are right: it is from them that plots are placed.
"""

from typing import NamedTuple

import numpy as np

from ..geometry import AT_REST
from ..types import Array, append, take

WINDOW, SPAN, LEAST = 10.0, 5.0, 5  # s of positions, s and number of those that suffice
LONGEST = 60.0  # s; samples that lie farther apart tell nothing of a velocity now
MOST = 60  # positions that are looked at
APART, SURE = 0.5, 4.0  # m/s that both may differ, and deviations
TURNS = 4.0  # deviations of an acceleration that is real
AUTO, TWIST, POSITIONS = 'auto', 'twist', 'positions'


class Samples(NamedTuple):
    """K samples in time order.

    time      [K]     s
    position  [K, 2]  m, east and north
    told      [K, 2]  m/s over ground, as told; nan where it is not
    fitted    [K, 2]  m/s, from the positions up to each; nan while they are too few
    heading   [K]     rad, true, as told; nan where it is not
    """

    time: Array
    position: Array
    told: Array
    fitted: Array
    heading: Array


def no_samples() -> Samples:
    """K = 0."""
    return Samples(np.empty(0), *(np.empty((0, 2)),) * 3, np.empty(0))


def follow(samples: Samples, sample: Samples, off: float) -> tuple[Samples, float]:
    """The samples and one more, fitted; and how far, m/s, what is told is off the positions.

    off  before; 0: they agree. Once they did not, they must agree under way to be believed again.
    """
    samples = append(samples, sample)
    recent = _recent(samples)
    if recent is None:
        return samples, off
    time = recent.time - recent.time[-1]
    samples.fitted[-1] = _slope_now(time, recent.position)
    step = np.diff(time)[:, None]
    if np.isnan(recent.told).any():
        return samples, off
    # What the positions do beyond the path that is told.
    beyond = np.diff(recent.position, axis=0) - 0.5 * step * (recent.told[1:] + recent.told[:-1])
    found, sigma = _speed(time, beyond)
    limit = APART + SURE * sigma
    if found > limit:
        beyond[np.hypot(*beyond.T).argmax()] = 0.0  # one jump of the positions tells nothing
        if _speed(time, beyond)[0] > limit:
            return samples, found
    slow = np.hypot(*recent.told.T).max() < 4 * AT_REST
    return samples, off if off and (slow or found > 0.5 * limit) else 0.0


def chosen(samples: Samples, off: float, trust: str) -> tuple[Array, bool]:
    """Velocity [K, 2] m/s of the samples; whether it is known of them all, else it is 0.

    trust  AUTO: what is told, where it agrees with the positions; TWIST or POSITIONS: this
           wherever it is there
    """
    first, second = samples.told, samples.fitted
    if trust == POSITIONS or (trust == AUTO and off):
        first, second = second, first if trust == POSITIONS else np.full_like(first, np.nan)
    velocity = np.where(np.isnan(first), second, first)
    return np.nan_to_num(velocity), not np.isnan(velocity).any()


def _recent(samples: Samples) -> Samples | None:
    """Those that tell of the velocity at the last of them; None where they are too few."""
    now = samples.time[-1]
    first = min(np.searchsorted(samples.time, now - WINDOW), max(len(samples.time) - LEAST, 0))
    count = len(samples.time) - first
    if count < LEAST or not SPAN <= now - samples.time[first] <= LONGEST:
        return None
    rows = np.linspace(first, len(samples.time) - 1, min(count, MOST)).astype(int)
    return take(samples, rows)


def _speed(time: Array, steps: Array) -> tuple[float, float]:
    """m/s of a path of steps [K - 1, 2] between the times [K], and its deviation."""
    slope, sigma = _line(time, np.concatenate([np.zeros((1, 2)), steps.cumsum(0)]))
    return float(np.hypot(*slope)), sigma


def _line(time: Array, position: Array) -> tuple[Array, float]:
    """Slope [2] of a straight line in time, and its deviation."""
    centred = time - time.mean()
    square = centred @ centred
    slope = centred @ position / square
    rest = position - position.mean(0) - centred[:, None] * slope
    return slope, float(np.sqrt((rest**2).sum() / (2 * (len(time) - 2)) / square))


def _slope_now(time: Array, position: Array) -> Array:
    """Velocity [2] at the last time: of a straight line, or a parabola where she surely turns."""
    design = np.stack([np.ones_like(time), time, time * time], 1)
    inverse = np.linalg.inv(design.T @ design)
    bent = inverse @ design.T @ position
    rest = position - design @ bent
    sigma = np.sqrt((rest**2).sum() / (2 * max(len(time) - 3, 1)) * inverse[2, 2])
    return bent[1] if np.hypot(*bent[2]) > TURNS * sigma else _line(time, position)[0]
