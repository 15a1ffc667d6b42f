"""The paper's own form: a wavelet network for each track, trained on line by its plots.

Paper 000, sections 2, 3 and 5. The input is z(k) = [R, theta, v, gamma]: range, bearing, speed and
course of the target at plot k. The network outputs the difference to one scan later:

    z(k+1) = z(k) + D net(z(k))

Every plot trains it by the rules of variable step and momentum. The paper uses the plots as inputs.
With a real radar's noise, every difference would then have the noise of two plots. So z(k) is here
the posterior of a CS-Kalman filter, which also gives the covariance. Between plots, and within the
scan ahead, the track is straight. The filter alone is used while the network is new, for times
before the last plot, and when the network's output is not a number or is too far from the filter. A
network that is very far off starts again at the next plot.
"""

from typing import NamedTuple

import numpy as np

from ...gaussian.linear import invert_2x2, squared_distance
from ...geometry import to_range_bearing, unit_vector, wrap_angle
from ...networks.backpropagation import Rule, Weights, draw, forward, gwnn, learn
from ...types import Array, Extrapolation, IntArray, Plots, put, take, where
from ..contract import Estimator, Velocity
from ..cs_kalman import POSITION_VELOCITY, CsState, Manoeuvre, cs_kalman

LEVELS, TRANSLATIONS, WIDTH = 1, 5, 1.2
RULE = Rule(step=0.02, rounds=3)
SEED = 1  # every track begins with the same weights

# D: the meaning of an output of 1: m in range and across, m/s, rad.
POSITION_UNIT, SPEED_UNIT, COURSE_UNIT = 60.0, 0.2, np.radians(5)
# The meaning of an input of 1, and the scale of the inputs' distance from their slow mean.
INPUT_UNIT = np.array([1000.0, 1000.0, 2.0, np.radians(20)])
INPUT_LIMIT, INPUT_GAIN = 3.0, 2.0
CENTRE_RATE = 0.05
WANTED_LIMIT = 3.0  # in D; the course of a ship at rest may change completely in a scan

# E1 and E2 follow "from the accuracy" (paper, below eq 10): the paper's values for its noise of 0.3
# m, or a share of the posterior's deviation.
FINEST, FAR_TO_NEAR = 1.852, 5.0  # m
NEAR_SHARE = 0.5
LEAST_GAIN = 0.01  # a plot with less gain is ignored: z(k) does not change
SHORTEST, LONGEST = 0.3, 3.0  # scans between plots from which a difference can be learnt
WARM_UP = 5  # plots
# Squared distances from the filter, in its own covariance. Up to the first the network is used;
# beyond the second it starts again. In between, the filter may be the one that lags.
BELIEVED, HOPELESS = 2.0, 100.0


class PaperState(NamedTuple):
    """base: the CS-Kalman filter's state; weights of the tracks' networks, [N, ...] each.

    time    [N]     s, of the last plot that told anything
    mean    [N, 4]  position m and velocity m/s then: z(k) in east and north
    centre  [N, 4]  slow mean of z: m, rad, m/s, rad
    origin  [N, 2]  m, the antenna at the last plot, where R and theta count from
    taught  [N]     plots that have taught the network
    """

    base: CsState
    time: Array
    mean: Array
    weights: Weights
    centre: Array
    origin: Array
    taught: Array


class Lesson(NamedTuple):
    """What plots teach: inputs [N, 4]; wanted [N, 4] outputs; speed [N] m/s; deviation [N] m."""

    inputs: Array
    wanted: Array
    speed: Array
    deviation: Array


def polar(mean: Array, origin: Array) -> Array:
    """z [N, 4]: range m, bearing rad, speed m/s and course rad (0 at rest)."""
    distance, bearing = to_range_bearing(mean[:, :2] - origin)
    speed, course = to_range_bearing(mean[:, 2:])
    return np.stack([np.maximum(distance, 1.0), bearing, speed, course], 1)


def difference(after: Array, before: Array) -> Array:
    """after - before of two z [N, 4], angles by the shorter way."""
    out = after - before
    out[:, 1::2] = wrap_angle(out[:, 1::2])
    return out


def output_unit(z: Array) -> Array:
    """D [N, 4] at z [N, 4]; across as along, in metres."""
    unit = np.empty_like(z)
    unit[:, 0], unit[:, 2], unit[:, 3] = POSITION_UNIT, SPEED_UNIT, COURSE_UNIT
    unit[:, 1] = POSITION_UNIT / z[:, 0]
    return unit


def network_inputs(z: Array, centre: Array) -> Array:
    """The network's inputs [N, 4] for z [N, 4]."""
    off = difference(z, centre)
    off[:, 1] *= z[:, 0]
    found: Array = INPUT_GAIN * np.clip(off / INPUT_UNIT, -INPUT_LIMIT, INPUT_LIMIT)
    return found


def deviation(base: CsState) -> Array:
    """Standard deviation [N] m of the filter's position, the mean of both axes."""
    return np.sqrt((base.covariance[:, 0, 0] + base.covariance[:, 3, 3]) / 2)


def gain(base: CsState, plots: Plots) -> Array:
    """How far [N] the plots have moved the filter, 0 to 1: half the trace of P R^-1."""
    inverse, _ = invert_2x2(plots.covariance)
    spread = base.covariance
    return 0.5 * (
        spread[:, 0, 0] * inverse[:, 0, 0]
        + spread[:, 3, 3] * inverse[:, 1, 1]
        + 2 * spread[:, 0, 3] * inverse[:, 0, 1]
    )


def distance(apart: Array, covariance: Array) -> Array:
    """Squared distance [N] of offsets [N, 2] by their covariance [N, 2, 2]."""
    return squared_distance(apart, invert_2x2(covariance)[0])


def gwnn_paper(manoeuvre: Manoeuvre, max_speed: float, period: float) -> Estimator:
    """The paper's estimator over a CS-Kalman filter.

    manoeuvre, max_speed m/s: the filter's; period s: of one scan, the network's step ahead.
    """
    filter_ = cs_kalman(manoeuvre, max_speed)
    design = gwnn(4, 4, LEVELS, TRANSLATIONS, WIDTH)
    fresh = draw(design, 1, np.random.default_rng(SEED))

    def init(plots: Plots, velocity: Velocity | None = None) -> PaperState:
        count = len(plots.time)
        base = filter_.init(plots, velocity)
        weights = take(fresh, np.zeros(count, int))
        return PaperState(
            base,
            plots.time.copy(),
            base.mean[:, POSITION_VELOCITY],
            weights,
            np.zeros((count, 4)),
            plots.origin.copy(),
            np.zeros(count),
        )

    def ahead(
        state: PaperState, time: Array, base: Extrapolation
    ) -> tuple[IntArray, Extrapolation, Array]:
        """Rows whose networks are warm, what they extrapolate, its squared distance from base."""
        rows = np.flatnonzero((state.taught >= WARM_UP) & (time > state.base.time))
        mine = take(state, rows)
        here, now = mine.mean[:, :2], mine.mean[:, 2:]
        scans = ((time[rows] - mine.time) / period)[:, None]
        # A network that has gone wrong may overflow. Its output is then not used.
        with np.errstate(all='ignore'):
            z = polar(mine.mean, mine.origin)
            output = forward(design, mine.weights, network_inputs(z, mine.centre)).output
            z = z + output_unit(z) * output
            there = mine.origin + z[:, :1] * unit_vector(z[:, 1])
            position = here + scans * (there - here)
            velocity = now + np.minimum(scans, 1) * (z[:, 2:3] * unit_vector(z[:, 3]) - now)
            base = take(base, rows)
            off = distance(position - base.position, base.covariance[:, :2, :2]) + distance(
                velocity - base.velocity, base.covariance[:, 2:, 2:]
            )
        return rows, base._replace(position=position, velocity=velocity), off

    def extrapolate(state: PaperState, time: Array) -> Extrapolation:
        base = filter_.extrapolate(state.base, time)
        rows, told, off = ahead(state, time, base)
        believed = off <= BELIEVED
        return put(base, rows[believed], take(told, believed))

    def update(state: PaperState, plots: Plots, rows: IntArray) -> PaperState:
        old = take(state, rows)
        warm, _, off = ahead(old, plots.time, filter_.extrapolate(old.base, plots.time))
        old = renew(old, warm[~(off <= HOPELESS)])
        base = filter_.update(old.base, plots, np.arange(len(rows)))
        mean = base.mean[:, POSITION_VELOCITY]
        before, after = polar(old.mean, plots.origin), polar(mean, plots.origin)
        # The first course is that of the second plot.
        centre = np.where((old.taught == 0)[:, None], after, old.centre)
        scans = (plots.time - old.time) / period
        a_scan = difference(after, before) / np.maximum(scans, SHORTEST)[:, None]
        lesson = Lesson(
            network_inputs(before, centre),
            a_scan / output_unit(before),
            after[:, 2],
            deviation(base),
        )
        told = gain(base, plots) >= LEAST_GAIN
        teaching = np.flatnonzero(told & (scans >= SHORTEST) & (scans <= LONGEST))
        old = put(old, teaching, teach(take(old, teaching), take(lesson, teaching)))
        centre = centre + CENTRE_RATE * difference(after, centre)
        centre[:, 1::2] = wrap_angle(centre[:, 1::2])
        new = PaperState(base, plots.time, mean, old.weights, centre, plots.origin, old.taught)
        return put(state, rows, where(told, new, old._replace(base=base)))

    def renew(state: PaperState, rows: IntArray) -> PaperState:
        """The state with new networks in the named rows."""
        return put(
            state,
            rows,
            take(state, rows)._replace(
                weights=take(fresh, np.zeros(len(rows), int)), taught=np.zeros(len(rows))
            ),
        )

    def teach(state: PaperState, lesson: Lesson) -> PaperState:
        """The rows with their networks trained; one that overflows starts again."""
        wanted = np.clip(lesson.wanted, -WANTED_LIMIT, WANTED_LIMIT)
        near = np.maximum(FINEST, NEAR_SHARE * lesson.deviation)
        with np.errstate(all='ignore'):
            weights = learn(
                design,
                state.weights,
                lesson.inputs,
                wanted,
                lesson.speed,
                RULE,
                POSITION_UNIT,
                near,
                FAR_TO_NEAR * near,
            )
        sound = np.isfinite(weights.outer).all((1, 2)) & np.isfinite(weights.inner).all((1, 2))
        return renew(
            state._replace(weights=weights, taught=state.taught + 1), np.flatnonzero(~sound)
        )

    return Estimator(init, extrapolate, update)
