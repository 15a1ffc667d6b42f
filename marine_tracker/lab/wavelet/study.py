"""Paper 003's scenario and the filters that are compared on it.

Two radars with range deviations of 200 and 100 m and 0.3 deg, a plot each second for 800 s. With
the constant acceleration of the paper's initial state the target would move 3,800 km. So here the
acceleration decays (`singer`), or it ends after 20 s and turns follow (`manv`).
"""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...estimators import cs_kalman, imm, wavelet_block, wavelet_cs
from ...estimators.contract import Velocity
from ...estimators.cs_kalman import POSITION, Manoeuvre
from ...estimators.wavelet_block import SIZE
from ...gaussian.linear import kalman_update, weighted_fusion
from ...geometry import polar_to_position, to_range_bearing
from ...types import Array, Plots
from .. import marine_table

SCANS, SETTLED = 800, 40
MANOEUVRE = Manoeuvre(100.0, 1 / 60)
RANGE_SIGMAS, BEARING_SIGMA = (200.0, 100.0), float(np.radians(0.3))
START = np.array([10000.0, 34, 10, 30000, 55, 6])
START_COVARIANCE = np.diag([100.0, 10, 1, 100, 10, 1])
SCENES = ('singer', 'manv')
# Begin and end, s, and acceleration to the left of the course, m/s^2. One more brakes.
TURNS = ((200, 240, 20.0), (350, 400, -15.0), (650, 700, 25.0))
BRAKES = (550, 560, -12.0)
MAX_SPEED = 1500.0
SEA = Manoeuvre(1.0, 1 / 60)
MODES = imm.Modes((1.0, 300.0), (0.0, 0.0), (0.98, 0.95), 1.0)


class Case(NamedTuple):
    """What B runs see of one scene of K seconds.

    truth [K, 6]; plots: of each radar, position [B, K, 2] m and noise [B, K, 2, 2] m^2;
    position, noise: both fused; mean [B, 6], covariance [B, 6, 6]: known at the start.
    """

    truth: Array
    plots: list[tuple[Array, Array]]
    position: Array
    noise: Array
    mean: Array
    covariance: Array


class Filtered(NamedTuple):
    """Kalman filter [B, K, ..] after and before each plot."""

    mean: Array
    covariance: Array
    expected: Array
    spread: Array


def truth(scene: str) -> Array:
    """States [SCANS, 6], one a second after START."""
    state = START
    out: list[Array] = []
    for second in range(SCANS):
        velocity = state[[1, 4]]
        ahead = velocity / np.hypot(*velocity)
        acceleration = START[[2, 5]] * np.exp(-second / 60)
        if scene == 'manv':
            acceleration = START[[2, 5]] * (second < 20)
            for begin, end, size in TURNS:
                if begin <= second < end:
                    acceleration = size * np.array([-ahead[1], ahead[0]])
            if BRAKES[0] <= second < BRAKES[1]:
                acceleration = BRAKES[2] * ahead
        state = np.empty(6)
        place = (START if not out else out[-1])[[0, 3]]
        state[[0, 3]] = place + velocity + 0.5 * acceleration
        state[[1, 4]], state[[2, 5]] = velocity + acceleration, acceleration
        out.append(state)
    return np.array(out)


def case(scene: str, runs: int, rng: np.random.Generator) -> Case:
    """The scene as both radars see it."""
    path = truth(scene)
    distance, bearing = to_range_bearing(path[:, POSITION])
    plots = [
        polar_to_position(
            distance + rng.normal(0, sigma, (runs, SCANS)),
            bearing + rng.normal(0, BEARING_SIGMA, (runs, SCANS)),
            sigma,
            BEARING_SIGMA,
        )
        for sigma in RANGE_SIGMAS
    ]
    position, noise = weighted_fusion(*plots[0], *plots[1])
    return Case(
        path,
        plots,
        position,
        noise,
        np.tile(START, (runs, 1)),
        np.tile(START_COVARIANCE, (runs, 1, 1)),
    )


def sea_case(runs: int, rng: np.random.Generator) -> Case:
    """The turns of `marine_table`. Each run begins with its first plot."""
    position, velocity = marine_table.truth(marine_table.TRACKS['turns'])
    distance, bearing = to_range_bearing(position)
    sigmas = marine_table.RANGE_SIGMA, marine_table.BEARING_SIGMA
    seen, noise = polar_to_position(
        distance + rng.normal(0, sigmas[0], (runs, len(position))),
        bearing + rng.normal(0, sigmas[1], (runs, len(position))),
        *sigmas,
    )
    path = np.zeros((len(position), 6))
    path[:, ::3], path[:, 1::3] = position, velocity
    first = cs_kalman.cs_kalman(SEA, 30.0).init(_plots(0.0, seen[:, 0], noise[:, 0]))
    last = 1 + (len(position) - 1) // SIZE * SIZE
    return Case(path[1:last], [], seen[:, 1:last], noise[:, 1:last], first.mean, first.covariance)


def kalman(
    on: Case,
    manoeuvre: Manoeuvre,
    plots: Sequence[tuple[Array, Array]] | None = None,
    hold: int = 1,
) -> Filtered:
    """CS-Kalman with the plots of each second one after another, by default the fused one.

    hold  number of plots for which mean and variance of the acceleration are kept, as within a
    block
    """
    plots = plots or [(on.position, on.noise)]
    mean, covariance = on.mean, on.covariance
    step = np.ones(len(mean))
    move = wavelet_block.transition(manoeuvre.frequency, step)
    drive = np.array([0.5, 1, 1])[None] - move[0, :3, 2]  # U: F + U e3' is constant a
    out = Filtered(
        *(np.empty((len(mean), plots[0][0].shape[1], 6) + tail) for tail in ((), (6,), (), (6,)))
    )
    for k in range(out.mean.shape[1]):
        if k % hold == 0:
            limit = manoeuvre.max_acceleration
            held = np.clip(mean[:, 2::3], -limit, limit)
            _, noise = cs_kalman.predict(mean, np.zeros_like(covariance), step, manoeuvre)
        mean = (move @ mean[..., None])[..., 0] + (held[:, :, None] * drive).reshape(-1, 6)
        covariance = move @ covariance @ move.swapaxes(1, 2) + noise
        out.expected[:, k], out.spread[:, k] = mean, covariance
        for position, noise_of in plots:
            innovation = position[:, k] - mean[:, POSITION]
            mean, covariance, _, _ = kalman_update(
                mean, covariance, innovation, noise_of[:, k], POSITION
            )
        out.mean[:, k], out.covariance[:, k] = mean, covariance
    return out


def smoothed(found: Filtered, frequency: float) -> Array:
    """Rauch-Tung-Striebel smoother inside each block of SIZE plots: means [B, K, 6]."""
    move = wavelet_block.transition(frequency, np.ones(1))[0]
    mean = found.mean.copy()
    for k in range(mean.shape[1] - 2, -1, -1):
        if (k + 1) % SIZE:
            gain = found.covariance[:, k] @ move.T @ np.linalg.inv(found.spread[:, k + 1])
            more = mean[:, k + 1] - found.expected[:, k + 1]
            mean[:, k] += (gain @ more[..., None])[..., 0]
    return mean


def late(on: Case, manoeuvre: Manoeuvre, **how: Any) -> Array:
    """`wavelet_block.smooth`: means [B, K, 6]."""
    time = np.tile(np.arange(1.0 + on.position.shape[1]), (len(on.mean), 1))
    return wavelet_block.smooth(
        on.mean, on.covariance, time, on.position, on.noise, manoeuvre, **how
    ).mean


def causal(on: Case, manoeuvre: Manoeuvre) -> Array:
    """`wavelet_cs`: means [B, K, 6]."""
    filter_ = wavelet_cs.wavelet_cs(manoeuvre, MAX_SPEED)
    state = wavelet_cs.begin(np.zeros(len(on.mean)), on.mean, on.covariance)
    out = []
    for plots in each_second(on):
        state = filter_.update(state, plots, np.arange(len(on.mean)))
        out.append(wavelet_cs.newest(state).mean)
    return np.stack(out, 1)


def interacting(on: Case) -> Array:
    """An IMM of two constant velocities: positions and velocities as means [B, K, 6]."""
    filter_ = imm.imm(MODES, MAX_SPEED)
    known = _plots(0.0, on.mean[:, POSITION], on.covariance[:, ::3, ::3])
    state = filter_.init(known, Velocity(on.mean[:, 1::3], on.covariance[:, 1::3, 1::3]))
    out = np.zeros(on.position.shape[:2] + (6,))
    for k, plots in enumerate(each_second(on)):
        state = filter_.update(state, plots, np.arange(len(on.mean)))
        now = filter_.extrapolate(state, plots.time)
        out[:, k, ::3], out[:, k, 1::3] = now.position, now.velocity
    return out


def each_second(on: Case) -> Iterator[Plots]:
    """The fused plots in the form an estimator takes."""
    return (_plots(1.0 + k, on.position[:, k], on.noise[:, k]) for k in range(on.position.shape[1]))


def _plots(time, position, noise):
    count = len(position)
    distance, bearing = to_range_bearing(position)
    return Plots(
        np.full(count, time),
        distance,
        bearing,
        np.zeros(count),
        np.zeros((count, 2)),
        position,
        noise,
    )


class Literal(NamedTuple):
    """means [B, K, 6]; broken: share of the first two blocks whose P is not a covariance; deviation
    m of the last east position according to P.
    """

    mean: Array
    broken: float
    deviation: float


def literal(on: Case, manoeuvre: Manoeuvre, low_pass_only: bool, period: float = 1.0) -> Literal:
    """Eq 13 to 15 as printed: P - H' K S K' H; eq 14 without details if low_pass_only; period s."""
    rows = wavelet_block.coarse('haar', wavelet_block.COARSEST)
    states = np.kron(rows, np.eye(6))
    mean, covariance = on.mean, on.covariance
    steps = np.full((len(mean), SIZE), period)
    out, broken = [], []
    for at in range(0, on.position.shape[1], SIZE):
        part = slice(at, at + SIZE)
        block = wavelet_block.predict(mean, covariance, steps, manoeuvre)
        noise = on.noise[:, part].sum(1) / SIZE
        own = states @ block.covariance @ states.T  # P_1
        expected = own[:, ::3, ::3] + noise
        gain = np.linalg.solve(expected, own[:, ::3]).swapaxes(1, 2)
        shift = (rows @ (on.position[:, part] - block.mean[..., POSITION]))[:, 0]
        flat = block.mean.reshape(len(mean), -1) + (gain @ shift[..., None])[..., 0] @ states
        if low_pass_only:
            flat = flat @ states.T @ states
        whole = block.covariance - states.T @ gain @ expected @ gain.swapaxes(1, 2) @ states
        covariance = whole[:, -6:, -6:]
        broken.append(np.mean(np.linalg.eigvalsh(covariance)[:, 0] < 0))
        out.append(flat.reshape(block.mean.shape))
        mean = out[-1][:, -1]
    return Literal(
        np.concatenate(out, 1),
        float(np.mean(broken[:2])),
        float(np.sqrt(covariance[:, 0, 0].mean())),
    )
