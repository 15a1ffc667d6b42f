"""The scenario of paper 001 and one at sea: one axis, a target that begins to accelerate.

The filters are those of the tracker. They run on tracks whose two axes are independent runs: plots
have the same deviation on both, without correlation. They are compared with the filter of constant
variance F1, and with an IMM of the same two filters.
"""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from ...estimators import cs_kalman, cs_rough_nn
from ...estimators.contract import Velocity
from ...evaluation.result import Progress
from ...geometry import polar_to_position, to_range_bearing, unit_vector
from ...types import Array, Plots, take

CS, BP, ROUGH, IMM = 'CS', 'BP', 'rough', 'IMM of the same two filters'
IMM_NARROW = 0.002  # variance of its calm filter relative to that of F1
IMM_STAY = np.array([[0.98, 0.02], [0.1, 0.9]])
SETTLED = 20  # first scans, left out of all errors


class Setting(NamedTuple):
    """A radar, a kind of target, and its manoeuvres.

    manoeuvre    of the filters
    speed        m/s at the beginning
    period       s
    sigma        m
    change       scan at which the acceleration changes
    scans        in all
    steps        acceleration before and after, m/s^2, by name
    """

    manoeuvre: cs_kalman.Manoeuvre
    speed: float
    period: float
    sigma: float
    change: int
    scans: int
    steps: dict[str, tuple[float, float]]


SETTINGS = {
    'air': Setting(
        cs_kalman.Manoeuvre(60.0, 1 / 20),
        300.0,
        1.0,
        100.0,
        40,
        80,
        {'0 -> 5': (0.0, 5.0), '0 -> 40': (0.0, 40.0), '5 -> 25': (5.0, 25.0)},
    ),
    'sea': Setting(
        cs_kalman.Manoeuvre(1.0, 1 / 60),
        8.0,
        60 / 22,
        20.0,
        60,
        110,
        {
            '0 -> .1': (0.0, 0.1),
            '0 -> .5': (0.0, 0.5),
            '.05 -> .25': (0.05, 0.25),
            '0 -> 1': (0.0, 1.0),
        },
    ),
}


class TrialRadar(NamedTuple):
    """A radar, and a target on a straight course.

    vessel_class   preset of the filters
    period         s
    range_sigma    m
    bearing_sigma  deg
    distance       m, at the beginning
    detection      probability of a plot
    """

    vessel_class: str
    period: float
    range_sigma: float
    bearing_sigma: float
    distance: float
    detection: float


RADARS = {
    '22 rpm, 15 m, 0.5 deg, 3 km': TrialRadar('ship', 60 / 22, 15.0, 0.5, 3000.0, 1.0),
    '22 rpm, 15 m, 0.5 deg, 20 km': TrialRadar('ship', 60 / 22, 15.0, 0.5, 20000.0, 1.0),
    'the same, one plot in five missed': TrialRadar('ship', 60 / 22, 15.0, 0.5, 20000.0, 0.8),
    '12 rpm, 25 m, 0.4 deg, 9 km': TrialRadar('ship', 5.0, 25.0, 0.4, 9000.0, 0.9),
    '48 rpm, 3 m, 0.7 deg, 500 m, small craft': TrialRadar(
        'small_craft', 1.25, 3.0, 0.7, 500.0, 0.9
    ),
}
QUIET_SCANS = 120


class Answer(NamedTuple):
    """A filter's answer to a step of the acceleration.

    delay         s until the mean acceleration has made 63 % of the step; nan if never
    overshoot     maximum of the mean acceleration after the step, relative to the step
    acceleration  RMSE after the first scans, m/s^2; likewise velocity m/s and position m
    quiet_velocity, quiet_position  RMSE before the step
    of_runs       [runs]   mean squared error of the acceleration after the first scans
    mean          [scans]  mean acceleration
    share         [scans]  mean O, or weight of the wide filter; nan where there is none
    """

    delay: float
    overshoot: float
    acceleration: float
    velocity: float
    position: float
    quiet_velocity: float
    quiet_position: float
    of_runs: Array
    mean: Array
    share: Array


def truth(setting: Setting, step: tuple[float, float]) -> Array:
    """[scans, 3] position, velocity and acceleration of an axis."""
    t, x = setting.period, np.zeros((setting.scans, 3))
    x[:, 2] = np.where(np.arange(setting.scans) < setting.change, *step)
    x[0, 1] = setting.speed
    for k in range(1, setting.scans):
        p, v, a = x[k - 1]
        x[k, :2] = p + t * v + 0.5 * t * t * a, v + t * a
    return x


def plots_of(
    setting: Setting, position: Array, runs: int, rng: np.random.Generator
) -> Iterator[Plots]:
    """Scan by scan, the plots of (runs + 1) // 2 tracks."""
    count = (runs + 1) // 2
    nothing = np.zeros(count)
    covariance = np.tile(setting.sigma**2 * np.eye(2), (count, 1, 1))
    for k, x in enumerate(position):
        seen = x + rng.normal(0, setting.sigma, (count, 2))
        yield Plots(
            np.full(count, k * setting.period),
            nothing,
            nothing,
            nothing,
            np.zeros((count, 2)),
            seen,
            covariance,
        )


Filter = Callable[[Setting, Iterator[Plots]], Iterator[tuple[Array, Any]]]


def _states(estimator, setting, scans, of):
    """The value of `of` after every scan. The velocity is known roughly at the start."""
    state = None
    for plots in scans:
        count = len(plots.time)
        if state is None:
            state = estimator.init(
                plots,
                Velocity(
                    np.full((count, 2), setting.speed),
                    np.tile(2 * (setting.sigma / setting.period) ** 2 * np.eye(2), (count, 1, 1)),
                ),
            )
        else:
            state = estimator.update(state, plots, np.arange(count))
        yield of(state)


def run_cs(setting: Setting, scans: Iterator[Plots]) -> Iterator[tuple[Array, Any]]:
    """The plain filter."""
    estimator = cs_kalman.cs_kalman(setting.manoeuvre, 1.0)
    return _states(estimator, setting, scans, lambda s: (s.mean.reshape(-1, 3), np.nan))


def run_parallel(kind: str) -> Filter:
    """The two filters and a network."""

    def go(setting, scans):
        estimator = cs_rough_nn.parallel(setting.manoeuvre, 1.0, cs_rough_nn.weights(kind))
        return _states(
            estimator, setting, scans, lambda s: (s.narrow.mean.reshape(-1, 3), s.share.mean())
        )

    return go


def run_imm(setting: Setting, scans: Iterator[Plots]) -> Iterator[tuple[Array, Any]]:
    """Blom and Bar-Shalom's IMM of F1 and a calm F2, on each axis separately."""
    frequency, limit = setting.manoeuvre.frequency, setting.manoeuvre.max_acceleration
    phi, q = cs_kalman.model(frequency, np.array([setting.period]))
    variance = cs_kalman.RAYLEIGH * limit**2 * np.array([1.0, IMM_NARROW])
    transition = np.array([[1, setting.period, phi[2, 0]], [0, 1, phi[1, 0]], [0, 0, phi[0, 0]]])
    steady = np.array(
        [[1, setting.period, 0.5 * setting.period**2], [0, 1, setting.period], [0, 0, 1.0]]
    )
    noise = 2 * frequency * variance[:, None, None] * q[[[0, 1, 2], [1, 3, 4], [2, 4, 5]], 0]
    first = next(
        _states(
            cs_kalman.cs_kalman(setting.manoeuvre, 1.0), setting, iter([next(scans)]), lambda s: s
        )
    )
    mean = np.stack([first.mean.reshape(-1, 3)] * 2, 1)
    blocks = np.stack([first.covariance[:, :3, :3], first.covariance[:, 3:, 3:]], 1)
    covariance = np.stack([blocks.reshape(-1, 3, 3)] * 2, 1)
    weight = np.full((len(mean), 2), 0.5)
    yield mean[:, 0], 0.5
    stay = IMM_STAY[::-1, ::-1]  # modes: wide, then calm
    for plots in scans:
        joint = weight[:, :, None] * stay
        weight = joint.sum(1)
        share = (joint / weight[:, None]).swapaxes(1, 2)
        centre = share @ mean
        apart = mean[:, None] - centre[:, :, None]
        covariance = np.einsum('nji,niab->njab', share, covariance) + np.einsum(
            'nji,njia,njib->njab', share, apart, apart
        )
        mean = centre @ steady.T
        covariance = transition @ covariance @ transition.T + noise
        off = plots.position.reshape(-1, 1) - mean[..., 0]
        spread = covariance[..., 0, 0] + setting.sigma**2
        gain = covariance[..., 0] / spread[..., None]
        mean = mean + gain * off[..., None]
        covariance = covariance - gain[..., None] * covariance[..., :1, :]
        score = -0.5 * (off * off / spread + np.log(spread))
        weight = weight * np.exp(score - score.max(1, keepdims=True)) + 1e-300
        weight = weight / weight.sum(1, keepdims=True)
        yield (weight[..., None] * mean).sum(1), weight[:, 0].mean()


FILTERS: dict[str, Filter] = {
    CS: run_cs,
    BP: run_parallel('bp'),
    ROUGH: run_parallel('rough'),
    IMM: run_imm,
}


def answer(
    setting: Setting, step: tuple[float, float], filter_: Filter, runs: int, seed: int
) -> Answer:
    """One filter on one step of the acceleration."""
    x = truth(setting, step)
    found = list(filter_(setting, plots_of(setting, x[:, 0], runs, np.random.default_rng(seed))))
    estimates = np.stack([estimate for estimate, _ in found], 1)
    off = estimates - x
    change = setting.change
    mean = estimates[..., 2].mean(0)
    done = (mean[change:] - step[0]) / (step[1] - step[0])
    there = np.flatnonzero(done >= 0.63)
    whole, quiet = off[:, SETTLED:], off[:, SETTLED:change]

    def rms(values):
        return float(np.sqrt(np.mean(values**2)))

    return Answer(
        delay=float(there[0] * setting.period) if len(there) else np.nan,
        overshoot=float(done.max()),
        acceleration=rms(whole[..., 2]),
        velocity=rms(whole[..., 1]),
        position=rms(whole[..., 0]),
        quiet_velocity=rms(quiet[..., 1]),
        quiet_position=rms(quiet[..., 0]),
        of_runs=(whole[..., 2] ** 2).mean(1),
        mean=mean,
        share=np.array([share for _, share in found]),
    )


def answers(runs: int, seed: int, progress: Progress) -> dict[tuple[str, str, str], Answer]:
    """Answers by setting, step and filter. All filters of a step see the same plots."""
    cells = [
        (name, step, rival)
        for name, setting in SETTINGS.items()
        for step in setting.steps
        for rival in FILTERS
    ]
    found = {}
    for done, (name, step, rival) in enumerate(cells):
        progress(done, len(cells))
        setting = SETTINGS[name]
        found[name, step, rival] = answer(setting, setting.steps[step], FILTERS[rival], runs, seed)
    progress(len(cells), len(cells))
    return found


def quiet_share(kind: str, radar: TrialRadar, runs: int, seed: int) -> float:
    """Mean O of a target that keeps its course, over the second half of QUIET_SCANS."""
    rng = np.random.default_rng(seed)
    estimator = cs_rough_nn.parallel(
        cs_kalman.PRESETS[radar.vessel_class], 25.0, cs_rough_nn.weights(kind)
    )
    start = radar.distance * unit_vector(np.full(runs, 0.7))
    sigma = np.radians(radar.bearing_sigma)
    state, shares = None, []
    for k in range(QUIET_SCANS):
        time = np.full(runs, k * radar.period)
        r, b = to_range_bearing(start + np.array([5.0, -3.0]) * time[:, None])
        r, b = r + rng.normal(0, radar.range_sigma, runs), b + rng.normal(0, sigma, runs)
        plots = Plots(
            time,
            r,
            b,
            np.zeros(runs),
            np.zeros((runs, 2)),
            *polar_to_position(r, b, radar.range_sigma, sigma),
        )
        if state is None:
            state = estimator.init(plots)
            continue
        rows = np.flatnonzero(rng.random(runs) < radar.detection)
        state = estimator.update(state, take(plots, rows), rows)
        shares.append(state.share.mean())
    return float(np.mean(shares[QUIET_SCANS // 2 :]))
