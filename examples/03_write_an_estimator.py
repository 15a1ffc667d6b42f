"""Write an estimator of your own: a constant-velocity Kalman filter.

    python examples/03_write_an_estimator.py

An estimator is three pure functions over any number of tracks at once (estimators/contract.py):
init makes a state row of each plot, extrapolate tells where tracks will be, update takes plots.
"""

from typing import NamedTuple

import numpy as np

from marine_tracker import Estimator, Service, TrackerParameters
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking.lifecycle import COASTING, CONFIRMED
from marine_tracker.types import Array, Extrapolation, put

NOISE = 0.05  # m^2/s^3: density of the white acceleration that a target may show
FIRST_SPEED = 10.0  # m/s: standard deviation of a velocity nothing is known of
H = np.eye(2, 4)  # the position in the state [east, north, v east, v north]


class State(NamedTuple):
    """time [N] s; mean [N, 4] and covariance [N, 4, 4] of position and velocity."""

    time: Array
    mean: Array
    covariance: Array


def init(plots, velocity=None):
    """One row a plot: its position, and its velocity where it is known, else anything."""
    count = len(plots.time)
    mean, covariance = np.zeros((count, 4)), np.zeros((count, 4, 4))
    mean[:, :2], covariance[:, :2, :2] = plots.position, plots.covariance
    covariance[:, 2:, 2:] = FIRST_SPEED**2 * np.eye(2)
    if velocity is not None:
        mean[:, 2:], covariance[:, 2:, 2:] = velocity.mean, velocity.covariance
    return State(plots.time, mean, covariance)


def predict(state, time):
    """The state at the times [N] s."""
    step = time - state.time
    move = np.tile(np.eye(4), (len(step), 1, 1))
    move[:, 0, 2] = move[:, 1, 3] = step
    t = np.abs(step)[:, None, None]
    noise = NOISE * np.block(
        [[t**3 / 3 * np.eye(2), t**2 / 2 * np.eye(2)], [t**2 / 2 * np.eye(2), t * np.eye(2)]]
    )
    return State(
        time,
        (move @ state.mean[..., None])[..., 0],
        move @ state.covariance @ move.swapaxes(1, 2) + noise,
    )


def extrapolate(state, time):
    """Every track at its own time [N] s."""
    ahead = predict(state, time)
    return Extrapolation(time, ahead.mean[:, :2], ahead.mean[:, 2:], ahead.covariance)


def update(state, plots, rows):
    """The named rows take one plot each."""
    ahead = predict(State(*(column[rows] for column in state)), plots.time)
    spread = H @ ahead.covariance @ H.T + plots.covariance
    gain = ahead.covariance @ H.T @ np.linalg.inv(spread)
    innovation = plots.position - ahead.mean[:, :2]
    return put(
        state,
        rows,
        State(
            plots.time,
            ahead.mean + (gain @ innovation[..., None])[..., 0],
            ahead.covariance - gain @ H @ ahead.covariance,
        ),
    )


def typical_error(service, chosen):
    """m: median over all scans of the distance from a track on display to the nearest target."""
    memory, errors = service.start(), []
    for scan, truth in radar.simulate(chosen, seed=1):
        memory, output = service.step(memory, scan)
        report, estimate = output.report, output.estimate
        for row in np.flatnonzero(np.isin(report.tracks.status, (CONFIRMED, COASTING))):
            really = truth.position + (report.time[row] - truth.time)[:, None] * truth.velocity
            errors.append(np.linalg.norm(really - estimate.position[row], axis=1).min())
    return np.median(errors)


encounters = scenario.load('encounters')
parameters = encounters.tracker_parameters()
shipped = Service(TrackerParameters(estimator='cs_kalman', **parameters))
own = Service(TrackerParameters(**parameters), estimator=Estimator(init, extrapolate, update))
print(f'cs_kalman          {typical_error(shipped, encounters):5.1f} m')
print(f'your own estimator {typical_error(own, encounters):5.1f} m')
