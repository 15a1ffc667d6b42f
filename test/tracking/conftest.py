import numpy as np
import pytest

from marine_tracker.geometry import to_range_bearing, wrap_bearing
from marine_tracker.types import OwnShip, PolarPlots, Scan

PERIOD = 60 / 22


@pytest.fixture(scope='session')
def revolution():
    """One antenna revolution over targets on straight courses: a Scan.

    position [T, 2] m at time 0 and velocity [T, 2] m/s of the targets, likewise own ship's;
    seen: mask of the targets that give a plot; false: number of plots that lie anywhere within
    `reach`; rng draws noise of the given sigmas, none without it. The plots are shuffled when
    there is an rng. Every plot carries the time the beam passed it, starting from `bearing0`.
    """

    def make(
        k,
        position,
        velocity,
        own_position=(0.0, 0.0),
        own_velocity=(0.0, 0.0),
        rng=None,
        seen=None,
        false=0,
        bearing0=0.0,
        range_sigma=15.0,
        bearing_sigma=0.0087,
        reach=6000.0,
        period=PERIOD,
    ):
        position, velocity = (
            np.reshape(np.asarray(a, float), (-1, 2)) for a in (position, velocity)
        )
        own_position, own_velocity = np.asarray(own_position, float), np.asarray(own_velocity)
        start = k * period
        time = np.full(len(position), start + 0.5 * period)
        for _ in range(12):  # the beam meets the target: a fixed point
            offset = (
                position + time[:, None] * velocity - own_position - time[:, None] * own_velocity
            )
            distance, bearing = to_range_bearing(offset)
            time = start + period * np.mod(bearing - bearing0, 2 * np.pi) / (2 * np.pi)
        if seen is not None:
            time, distance, bearing = time[seen], distance[seen], bearing[seen]
        if rng is not None:
            distance = distance + rng.normal(0, range_sigma, len(time))
            bearing = bearing + rng.normal(0, bearing_sigma, len(time))
        if false:
            where = rng.uniform(0, 2 * np.pi, false)
            distance = np.r_[distance, reach * np.sqrt(rng.uniform(0.001, 1, false))]
            bearing = np.r_[bearing, where]
            time = np.r_[time, start + period * np.mod(where - bearing0, 2 * np.pi) / (2 * np.pi)]
        order = np.arange(len(time)) if rng is None else rng.permutation(len(time))
        plots = PolarPlots(
            time[order],
            np.abs(distance[order]),
            wrap_bearing(bearing[order]),
            np.full(len(time), 10.0),
        )
        samples = np.array([start, start + period])
        own = OwnShip(
            samples,
            own_position + samples[:, None] * own_velocity,
            np.tile(own_velocity, (2, 1)).astype(float),
        )
        return Scan(start, start + period, plots, own)

    return make
