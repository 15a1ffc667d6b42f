"""What every estimator of the registry must do, for both vessel classes."""

import numpy as np
import pytest
from scipy.stats import chi2

from marine_tracker.estimators import ESTIMATORS
from marine_tracker.parameters import VESSEL_CLASSES, TrackerParameters
from marine_tracker.types import append, put, take, where

PERIOD = 60 / 22
MAX_SPEED = 25.0
FIELDS = {'time': (), 'position': (2,), 'velocity': (2,), 'covariance': (4, 4)}


@pytest.fixture(
    params=[(name, vessel) for name in ESTIMATORS for vessel in VESSEL_CLASSES],
    ids='-'.join,
    scope='module',
)
def estimator(request):
    name, vessel = request.param
    return ESTIMATORS[name](
        TrackerParameters(estimator=name, vessel_class=vessel, max_target_speed_mps=MAX_SPEED)
    )


@pytest.fixture
def fleet(estimator, plots_at):
    """State of five different tracks of six plots each, with their last position and velocity."""
    rng = np.random.default_rng(8)
    position, velocity = rng.uniform(-5000, 5000, (5, 2)), rng.uniform(-8, 8, (5, 2))
    offset = rng.uniform(0, PERIOD, 5)
    state = None
    for k in range(6):
        time = k * PERIOD + offset
        plots = plots_at(position + velocity * time[:, None], time, rng=rng)
        state = (
            estimator.init(plots) if state is None else estimator.update(state, plots, np.arange(5))
        )
    return state, time, position + velocity * time[:, None], velocity


def leaves(structure):
    """Every array of a nested state, or of plots; what the radar does not tell is left out."""
    if isinstance(structure, tuple):
        return [leaf for part in structure for leaf in leaves(part)]
    return [] if structure is None else [structure]


def frozen(structure):
    for leaf in leaves(structure):
        leaf.setflags(write=False)
    return structure


def same(one, other, exactly=True):
    """Equal, or equal to rounding: other batch sizes may take other code paths in BLAS."""
    for a, b in zip(leaves(one), leaves(other), strict=True):
        if exactly:
            np.testing.assert_array_equal(a, b)
        else:
            np.testing.assert_allclose(a, b, rtol=1e-9, atol=1e-9)


def check_form(found, count):
    for name, tail in FIELDS.items():
        array = getattr(found, name)
        assert array.dtype == np.float64, name
        assert array.shape == (count,) + tail, name
        assert np.isfinite(array).all(), name
    np.testing.assert_allclose(
        found.covariance, found.covariance.swapaxes(1, 2), rtol=1e-9, atol=1e-9
    )
    if count:
        values = np.linalg.eigvalsh(found.covariance)
        assert (values > -1e-9 * values.max(1, keepdims=True)).all()


def test_shapes_and_types(estimator, fleet, plots_at):
    state, time, _, _ = fleet
    check_form(estimator.extrapolate(state, time + 1.0), 5)
    for leaf in leaves(state):
        assert len(leaf) == 5
        assert leaf.dtype == np.float64
    one = estimator.init(plots_at([[100.0, 200.0]], 7.0))
    check_form(estimator.extrapolate(one, np.array([7.0])), 1)
    for a, b in zip(leaves(one), leaves(state), strict=True):
        assert a.shape[1:] == b.shape[1:] and a.dtype == b.dtype


def test_no_tracks_and_no_plots(estimator, fleet, plots_at):
    nothing = plots_at(np.zeros((0, 2)), 0.0)
    empty = estimator.init(nothing)
    check_form(estimator.extrapolate(empty, np.zeros(0)), 0)
    rows = np.zeros(0, np.int64)
    check_form(estimator.extrapolate(estimator.update(empty, nothing, rows), np.zeros(0)), 0)
    state = fleet[0]
    same(estimator.update(state, nothing, rows), state)


def test_arguments_are_never_written_to(estimator, fleet, plots_at):
    state, time, position, _ = fleet
    frozen(state)
    rows = frozen(np.array([3, 1]))
    plots = frozen(plots_at(position[rows] + 20.0, time[rows] + PERIOD))
    before = [leaf.copy() for leaf in leaves(state)]
    copies = [leaf.copy() for leaf in leaves(plots)]
    estimator.init(plots)
    after = estimator.update(state, plots, rows)
    at = frozen(time + 2.0)
    estimator.extrapolate(state, at)
    for leaf, copy in zip(leaves(state) + leaves(plots), before + copies, strict=True):
        np.testing.assert_array_equal(leaf, copy)
    # What comes out can be written to without harm to what went in.
    for leaf in leaves(after):
        leaf[:] = 0
    for leaf, copy in zip(leaves(state), before, strict=True):
        np.testing.assert_array_equal(leaf, copy)


@pytest.mark.parametrize('count', [0, 1, 2])
def test_not_even_those_of_no_or_one_track(estimator, fleet, plots_at, count):
    """Of few rows a transposed array may be the array itself: a copy left out shows."""
    state, time, position, _ = fleet
    few = frozen(take(state, np.arange(count)))
    rows, at = frozen(np.arange(count)), frozen(time[:count] + PERIOD)
    plots = frozen(plots_at(position[:count] + 20.0, at))
    before = [leaf.copy() for leaf in leaves(few)]
    estimator.extrapolate(few, at)
    estimator.update(few, plots, rows)
    for leaf, copy in zip(leaves(few), before, strict=True):
        np.testing.assert_array_equal(leaf, copy)


def test_the_same_arguments_give_the_same_result(estimator, fleet, plots_at):
    state, time, position, _ = fleet
    plots = plots_at(position + 20.0, time + PERIOD)
    rows = np.arange(5)
    same(estimator.update(state, plots, rows), estimator.update(state, plots, rows))


def test_tracks_do_not_depend_on_their_order(estimator, fleet, plots_at):
    state, time, position, _ = fleet
    order = np.array([4, 2, 0, 3, 1])
    plots = plots_at(position + 20.0, time + PERIOD)
    straight = estimator.update(state, plots, np.arange(5))
    shuffled = estimator.update(take(state, order), take(plots, order), np.arange(5))
    same(take(straight, order), shuffled, exactly=False)
    # The rows may be named in any order too.
    same(estimator.update(state, take(plots, order), order), straight, exactly=False)
    same(
        take(estimator.extrapolate(state, time + 3.0), order),
        estimator.extrapolate(take(state, order), time[order] + 3.0),
        exactly=False,
    )


def test_a_track_does_not_depend_on_the_others(estimator, fleet, plots_at):
    state, time, position, _ = fleet
    few = np.array([3, 1])
    plots = plots_at(position + 20.0, time + PERIOD)
    whole = estimator.update(state, plots, np.arange(5))
    part = estimator.update(take(state, few), take(plots, few), np.arange(2))
    same(take(whole, few), part, exactly=False)
    same(
        take(estimator.extrapolate(state, time + 9.0), few),
        estimator.extrapolate(take(state, few), time[few] + 9.0),
        exactly=False,
    )


def test_rows_not_named_are_not_touched(estimator, fleet, plots_at):
    state, time, position, _ = fleet
    rows = np.array([3, 1])
    after = estimator.update(state, plots_at(position[rows] + 20.0, time[rows] + PERIOD), rows)
    rest = np.array([0, 2, 4])
    same(take(after, rest), take(state, rest))
    moved = estimator.extrapolate(after, time + PERIOD)
    still = estimator.extrapolate(state, time + PERIOD)
    assert (np.abs(moved.position - still.position)[rows].max(1) > 0.01).all()


def test_states_are_handled_by_rows(estimator, fleet):
    """What take, append, where and put do to a state they do to its extrapolation."""
    state, time, _, _ = fleet

    def ahead(rows_of):
        return estimator.extrapolate(rows_of, np.full(len(leaves(rows_of)[0]), time.max() + 5.0))

    a, b = take(state, slice(0, 2)), take(state, np.array([False, False, True, True, True]))
    same(ahead(append(a, b)), ahead(state), exactly=False)
    mask = np.array([True, False, True, False, False])
    turned = take(state, np.arange(5)[::-1])
    same(ahead(where(mask, state, turned)), where(mask, ahead(state), ahead(turned)), exactly=False)
    same(
        ahead(put(state, np.array([4]), take(state, np.array([0])))),
        take(ahead(state), np.array([0, 1, 2, 3, 0])),
        exactly=False,
    )


def test_the_first_plot_is_all_that_a_new_track_knows(estimator, plots_at):
    plots = plots_at([[3000.0, -4000.0], [200.0, 100.0]], [5.0, 6.0])
    now = estimator.extrapolate(estimator.init(plots), plots.time)
    np.testing.assert_allclose(now.position, plots.position, atol=1e-6)
    np.testing.assert_allclose(now.velocity, 0.0, atol=1e-9)
    np.testing.assert_allclose(now.covariance[:, :2, :2], plots.covariance, rtol=1e-6)
    # The velocity may be anything up to the fastest target's: neither sure nor boundless.
    sigma = np.sqrt(now.covariance[:, [2, 3], [2, 3]])
    assert (sigma > 0.3 * MAX_SPEED).all() and (sigma < 1.5 * MAX_SPEED).all()


def test_at_the_time_of_the_plot_the_posterior_comes_out(estimator, fleet, plots_at):
    """A plot of no noise pins the position; and the extrapolation is continuous at step 0."""
    state, time, position, _ = fleet
    exact = position + np.array([31.0, -17.0])
    plots = plots_at(exact, time + PERIOD, range_sigma=1e-3, bearing_sigma=1e-7)
    state = estimator.update(state, plots, np.arange(5))
    now = estimator.extrapolate(state, plots.time)
    np.testing.assert_array_equal(now.time, plots.time)
    np.testing.assert_allclose(now.position, exact, atol=1e-2)
    for side in (-1e-6, 1e-6):
        near = estimator.extrapolate(state, plots.time + side)
        np.testing.assert_allclose(near.position, now.position, atol=1e-4)
        np.testing.assert_allclose(near.velocity, now.velocity, atol=1e-4)
        np.testing.assert_allclose(near.covariance, now.covariance, rtol=1e-3, atol=1e-3)


@pytest.mark.parametrize('step', [0.0, 1e-9, PERIOD, 60.0, -1e-9, -3.0, -10.0])
def test_steps_of_any_size_and_sign_stay_sound(estimator, fleet, plots_at, step):
    state, time, position, velocity = fleet
    ahead = estimator.extrapolate(state, time + step)
    check_form(ahead, 5)
    np.testing.assert_allclose(ahead.time, time + step)
    plots = plots_at(position + velocity * step, time + step)
    after = estimator.update(state, plots, np.arange(5))
    check_form(estimator.extrapolate(after, time + step), 5)
    check_form(estimator.extrapolate(after, time + step + PERIOD), 5)


def test_many_plots_at_one_time_do_not_break_a_track(estimator, fleet, plots_at):
    state, time, position, _ = fleet
    for _ in range(50):
        state = estimator.update(state, plots_at(position, time), np.arange(5))
    now = estimator.extrapolate(state, time)
    check_form(now, 5)
    np.testing.assert_allclose(now.position, position, atol=15.0)


def test_steps_of_both_signs_and_none_mix_in_one_batch(estimator, fleet):
    state, time, _, _ = fleet
    step = np.array([60.0, -3.0, 0.0, 1e-3, -1e-3])
    together = estimator.extrapolate(state, time + step)
    for row in range(5):
        one = np.array([row])
        same(
            take(together, one),
            estimator.extrapolate(take(state, one), (time + step)[one]),
            exactly=False,
        )


def test_uncertainty_grows_through_missed_scans(estimator, fleet):
    state, time, _, _ = fleet
    sigma = []
    for k in range(23):
        ahead = estimator.extrapolate(state, time + k * PERIOD)
        sigma.append(np.sqrt(np.trace(ahead.covariance[:, :2, :2], axis1=1, axis2=2)))
    # A plot may know less about one scan later than about its own time, but little.
    assert (np.diff(sigma, axis=0)[1:] > 0).all()


def test_two_gaps_are_one_long_gap(estimator, fleet, gaussian_plots, plots_at):
    """A plot that tells nothing (deviation 10,000 km) is no plot.

    A bank of filters mixes once more by it, so the results agree in a quarter of the deviation,
    and the deviations in a twentieth, not to rounding.
    """
    state, time, position, velocity = fleet
    rows = np.arange(5)
    vague = gaussian_plots(position, np.tile(1e14 * np.eye(2), (5, 1, 1)), time + 1.5 * PERIOD)
    through = estimator.update(state, vague, rows)
    later = time + 3 * PERIOD
    one, two = estimator.extrapolate(state, later), estimator.extrapolate(through, later)
    sigma = np.sqrt(np.diagonal(one.covariance, axis1=1, axis2=2))
    apart = np.concatenate([one.position - two.position, one.velocity - two.velocity], 1)
    assert (np.abs(apart) < 0.25 * sigma).all()
    other = np.sqrt(np.diagonal(two.covariance, axis1=1, axis2=2))
    np.testing.assert_allclose(other, sigma, rtol=0.05)
    # And the next plot is worth the same.
    plots = plots_at(position + velocity * (later - time)[:, None], later)
    a = estimator.extrapolate(estimator.update(state, plots, rows), later)
    b = estimator.extrapolate(estimator.update(through, plots, rows), later)
    np.testing.assert_allclose(a.position, b.position, atol=5.0)
    np.testing.assert_allclose(a.velocity, b.velocity, atol=1.0)


@pytest.mark.parametrize('field', ['position', 'covariance', 'time', 'range', 'all'])
def test_a_plot_that_is_not_a_number_harms_its_own_track_only(estimator, fleet, plots_at, field):
    state, time, position, _ = fleet
    good = plots_at(position + 20.0, time + PERIOD)
    bad = take(good, slice(None))
    told = [name for name in bad._fields if getattr(bad, name) is not None]
    for name in told if field == 'all' else (field,):
        array = getattr(bad, name).copy()
        array[2] = np.nan
        bad = bad._replace(**{name: array})
    rest = np.array([0, 1, 3, 4])
    with np.errstate(invalid='ignore'):
        poisoned = estimator.update(state, bad, np.arange(5))
        ahead = estimator.extrapolate(poisoned, time + 2 * PERIOD)
        begun = estimator.init(bad)
    sound = estimator.update(state, good, np.arange(5))
    same(take(poisoned, rest), take(sound, rest), exactly=False)
    same(take(begun, rest), take(estimator.init(good), rest), exactly=False)
    same(
        take(ahead, rest),
        take(estimator.extrapolate(sound, time + 2 * PERIOD), rest),
        exactly=False,
    )


def test_own_ships_motion_changes_nothing_on_the_ground(estimator, plots_at):
    """The same targets from a ship at rest and from one that steams by and turns: no noise."""
    position = np.array([[2000.0, 1500.0], [-1000.0, 3000.0], [500.0, -2500.0]])
    velocity = np.array([[5.0, -3.0], [0.0, 0.0], [-4.0, 6.0]])

    def track(own):
        state = None
        for k in range(40):
            time = np.full(3, k * PERIOD)
            plots = plots_at(position + velocity * k * PERIOD, time, own(k * PERIOD))
            state = (
                estimator.init(plots)
                if state is None
                else estimator.update(state, plots, np.arange(3))
            )
        return estimator.extrapolate(state, time)

    rest = track(lambda t: np.zeros(2))
    moving = track(lambda t: 800 * np.array([np.sin(t / 80), 1 - np.cos(t / 80)]))
    truth = position + velocity * 39 * PERIOD
    for found in (rest, moving):
        np.testing.assert_allclose(found.position, truth, atol=3.0)
        np.testing.assert_allclose(found.velocity, velocity, atol=0.3)
    np.testing.assert_allclose(moving.position, rest.position, atol=3.0)
    np.testing.assert_allclose(moving.velocity, rest.velocity, atol=0.3)


def test_a_straight_track_is_followed_within_its_own_covariance(estimator, plots_at):
    """300 runs at 5 km: 60 plots of 15 m along and 44 m across.

    The last estimate must beat the plot; its NEES (position) stays below the bound that a
    consistent filter exceeds once in 10,000 tries, and is not that of a filter that knows
    nothing of its own error.
    """
    rng = np.random.default_rng(12)
    runs, scans = 300, 60
    start, velocity = np.array([-3000.0, 4000.0]), np.array([7.0, 2.0])
    state, rows = None, np.arange(runs)
    for k in range(scans):
        truth = start + velocity * k * PERIOD
        plots = plots_at(np.tile(truth, (runs, 1)), k * PERIOD, rng=rng)
        state = estimator.init(plots) if state is None else estimator.update(state, plots, rows)
    now = estimator.extrapolate(state, plots.time)
    plot_rms = np.sqrt(np.mean(np.sum((plots.position - truth) ** 2, 1)))
    error = now.position - truth
    assert np.sqrt(np.mean(np.sum(error**2, 1))) < 0.95 * plot_rms
    off = now.velocity - velocity
    assert np.sqrt(np.mean(np.sum(off**2, 1))) < 8.0
    assert (np.abs(error.mean(0)) < 4 * error.std(0) / np.sqrt(runs)).all(), 'biased position'
    # Modes that turn either way pull the mean velocity in: by less than a twentieth.
    bound = 4 * off.std(0) / np.sqrt(runs) + 0.05 * np.hypot(*velocity)
    assert (np.abs(off.mean(0)) < bound).all(), 'biased velocity'
    for apart, spread in ((error, now.covariance[:, :2, :2]), (off, now.covariance[:, 2:, 2:])):
        nees = np.einsum('ni,ni->n', apart, np.linalg.solve(spread, apart[..., None])[..., 0])
        assert nees.mean() < chi2.ppf(0.9999, 2 * runs) / runs
        assert nees.mean() > 0.1
