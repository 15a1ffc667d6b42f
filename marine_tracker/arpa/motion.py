"""Course, speed and position of every track from a memory of its own, for vectors and CPA.

The tracker's estimator extrapolates and associates. The shown motion comes from the same plots
through `plot_noise` and `gaussian.leg_hypotheses`, and does not depend on the estimator.
"""

from typing import NamedTuple

import numpy as np

from ..gaussian import leg_hypotheses, linear_modes
from ..gaussian.linear import invert_2x2, squared_distance
from ..parameters import GLINT_SIGMA
from ..tracking.tracker import Report
from ..types import Array, BoolArray, IntArray, Plots, put, take
from . import plot_noise

STEADY, MANOEUVRING = 0, 1
MEMORY_NAMES = ('steady', 'manoeuvring')
SURE = 0.5  # m/s; a steady target's velocity has at most this deviation


class MotionSettings(NamedTuple):
    """What is expected of targets and their plots.

    glint_sigma  m, deviation of the echoing point from the middle of the target, each axis
    speed_sigma  m/s, deviation of each component of a new target's velocity
    habits       how targets move
    rest_speed   m/s, below which a target may count as stationary ...
    rest_time    s, ... once its velocity has not differed from 0 for this time
    """

    glint_sigma: float = GLINT_SIGMA['ship']
    speed_sigma: float = 12.5
    habits: leg_hypotheses.Habits = leg_hypotheses.Habits(hold=6000.0, manoeuvre=20.0, noise=0.2)
    rest_speed: float = 0.5
    rest_time: float = 60.0


PRESETS = {
    'ship': MotionSettings(),
    'small_craft': MotionSettings(
        GLINT_SIGMA['small_craft'], habits=leg_hypotheses.Habits(600.0, 10.0, 4.0)
    ),
}


class MotionMemory(NamedTuple):
    """The memory of each track, one row a track, by ascending id.

    id          [N]
    first       [N]      s, of the first plot; nan before it
    time        [N]      s, of the last plot
    scatter              rows of `plot_noise.Scatter`, for each radar
    legs                 rows of `leg_hypotheses.Legs`
    shown       [N, 14]  mean and covariance at `time` of the likely hypotheses, as in
    `linear_modes`
    noise       [N]      m^2/s^3, density of acceleration expected from then on
    memory      [N]      STEADY or MANOEUVRING
    since       [N]      s, when that began: see Motion
    still       [N]      s, since when the velocity has not differed from 0; nan: it differs
    stationary  [N]      whether the target counts as at rest
    """

    id: IntArray
    first: Array
    time: Array
    scatter: tuple[plot_noise.Scatter, ...]
    legs: leg_hypotheses.Legs
    shown: Array
    noise: Array
    memory: IntArray
    since: Array
    still: Array
    stationary: BoolArray


class Motion(NamedTuple):
    """Position and motion of N tracks; nan if a track had no plot yet.

    position    [N, 2]     m, east and north
    velocity    [N, 2]     m/s over ground; 0 if the target is stationary
    covariance  [N, 4, 4]  of [position, velocity]
    memory      [N]        STEADY: the target is on a leg that has lasted; MANOEUVRING: it is not
    since       [N]        s: the leg's likeliest beginning; when the manoeuvre first showed
    steady      [N]        whether the target keeps course and speed, and these are well known
    stationary  [N]        whether the target is at rest
    """

    position: Array
    velocity: Array
    covariance: Array
    memory: IntArray
    since: Array
    steady: BoolArray
    stationary: BoolArray


def begin(radars: int = 1) -> MotionMemory:
    """No track yet."""
    return _blank(np.zeros(0, np.int64), radars)


def step(
    memory: MotionMemory, report: Report, plots: Plots, settings: MotionSettings, radar: int = 0
) -> MotionMemory:
    """The memory after one scan of the radar. Its rows are those of `report.tracks`.

    plots  the scan's plots as `geometry.locate` gives them; `report.plot` refers to them

    Plots of two radars can be out of order by up to one revolution. Straight legs do not suffer:
    their fit is the same in any order.
    """
    memory = _follow(memory, report.tracks.id)
    first = np.arange(len(memory.id) - len(report.begun.time), len(memory.id))
    memory = _first_plots(memory, first, report.begun, settings, radar)
    rows = np.flatnonzero(report.plot >= 0)
    plots = take(plots, report.plot[rows])
    blank = np.isnan(memory.time[rows])
    memory = _first_plots(memory, rows[blank], take(plots, blank), settings, radar)
    return _next_plots(memory, rows[~blank], take(plots, ~blank), settings, radar)


def at(memory: MotionMemory, time: float) -> Motion:
    """The motion of every row at `time`, s: [N] or one for all. `types.take` chooses rows first."""
    bank = linear_modes.straight(memory.noise[None])
    mean, covariance = linear_modes.unpack(
        linear_modes.move(bank, memory.shown.T[:, None], time - memory.time)[:, 0].T
    )
    position, velocity = mean[:, :2].copy(), mean[:, 2:].copy()
    position[memory.stationary] = memory.shown[memory.stationary, :2]
    velocity[memory.stationary] = 0.0
    known = np.trace(covariance[:, 2:, 2:], axis1=1, axis2=2) < SURE**2
    return Motion(
        position,
        velocity,
        covariance,
        memory.memory,
        memory.since,
        (memory.memory == STEADY) & known,
        memory.stationary,
    )


def _blank(id_: IntArray, radars: int) -> MotionMemory:
    """Rows of tracks that had no plot yet."""
    count = len(id_)
    nothing = np.full(count, np.nan)
    return MotionMemory(
        id_,
        nothing,
        nothing,
        (plot_noise.begin(count),) * radars,
        leg_hypotheses.begin(
            np.full((count, 2), np.nan), np.full((count, 2, 2), np.nan), nothing, 1.0
        ),
        np.full((count, 14), np.nan),
        nothing,
        np.full(count, STEADY),
        nothing,
        nothing,
        np.zeros(count, bool),
    )


def _follow(memory: MotionMemory, id_: IntArray) -> MotionMemory:
    """The rows of the tracks `id_` [N], ascending; those not known yet are blank."""
    if np.array_equal(memory.id, id_):
        return memory
    known = np.flatnonzero(np.isin(id_, memory.id, assume_unique=True))
    blank = _blank(id_, len(memory.scatter))
    return put(blank, known, take(memory, memory.id.searchsorted(id_[known])))


def _first_plots(
    memory: MotionMemory, rows: IntArray, plots: Plots, settings: MotionSettings, radar: int
) -> MotionMemory:
    """Starts the rows [K], with one plot each."""
    count = len(rows)
    if not count:
        return memory
    scatters = [plot_noise.begin(count)] * len(memory.scatter)
    scatters[radar], covariance, _ = plot_noise.observe(
        scatters[radar], plots, settings.glint_sigma
    )
    hypotheses = leg_hypotheses.begin(plots.position, covariance, plots.time, settings.speed_sigma)
    return put(
        memory,
        rows,
        MotionMemory(
            memory.id[rows],
            plots.time,
            plots.time,
            tuple(scatters),
            hypotheses,
            hypotheses.rows[:, 0],
            np.full(count, settings.habits.noise),
            np.full(count, STEADY),
            plots.time,
            np.full(count, np.nan),
            np.zeros(count, bool),
        ),
    )


def _next_plots(
    memory: MotionMemory, rows: IntArray, plots: Plots, settings: MotionSettings, radar: int
) -> MotionMemory:
    """Adds one more plot to each of the rows [K]."""
    if not len(rows):
        return memory
    before = take(memory, rows)
    scatters = list(before.scatter)
    scatter, covariance, stretch = plot_noise.observe(scatters[radar], plots, settings.glint_sigma)
    scatters[radar] = scatter
    hypotheses, shown = leg_hypotheses.update(
        before.legs,
        plots.time,
        plots.time - before.time,
        plots.position,
        covariance,
        # A fit to plots of several radars cannot scale with one of them.
        stretch if len(scatters) == 1 else None,
        plot_noise.FREEDOM * scatter.plots,
        settings.habits,
    )
    noise = hypotheses.weight[:, 0] * settings.habits.noise
    return put(
        memory,
        rows,
        MotionMemory(
            before.id,
            before.first,
            plots.time,
            tuple(scatters),
            hypotheses,
            shown,
            noise,
            *_manoeuvre(before, hypotheses, plots.time, 2 * settings.habits.manoeuvre),
            *_rest(before, shown, plots.time, settings),
        ),
    )


def _manoeuvre(
    before: MotionMemory, hypotheses: leg_hypotheses.Legs, time: Array, lasting: float
) -> tuple[IntArray, Array]:
    """STEADY or MANOEUVRING [N], and since when [N] s, after the times [N] s.

    In a turn every moment may be the beginning of a new leg. So a leg younger than `lasting` s does
    not count yet. But a new target is not taken as turning for this reason.
    """
    likeliest = hypotheses.weight.argmax(1)
    begun = hypotheses.begun[np.arange(len(time)), likeliest - 1]
    young = (likeliest == 0) | (time - begun < lasting)
    turns = young & (time - before.first > lasting)
    since = np.where(before.memory == MANOEUVRING, before.since, time)
    begun = np.where(likeliest == 0, before.first, begun)
    return np.where(turns, MANOEUVRING, STEADY), np.where(turns, since, begun)


def _rest(
    before: MotionMemory, shown: Array, time: Array, settings: MotionSettings
) -> tuple[Array, BoolArray]:
    """Since when [N] tracks are still, and whether they count as stationary, after the times [N].

    A target comes to rest when for some time its velocity is within 2.4 deviations of 0, and
    certainly low. It gets under way when its velocity is beyond 3 deviations and above half the
    speed limit. The gap between the two prevents flicker.
    """
    mean, covariance = linear_modes.unpack(shown)
    velocity, spread = mean[:, 2:], covariance[:, 2:, 2:]
    inverse, _ = invert_2x2(spread)
    distance = squared_distance(velocity, inverse)
    speed = np.hypot(*velocity.T)
    surely_below = speed + 2 * np.sqrt(np.trace(spread, axis1=1, axis2=2))
    still = (distance < 6.0) & (surely_below < settings.rest_speed)
    since = np.where(still, np.where(np.isnan(before.still), time, before.still), np.nan)
    moves = (distance > 9.0) & (speed > 0.5 * settings.rest_speed)
    rests = still & (time - since >= settings.rest_time)
    return since, (before.stationary & ~moves) | rests
