import numpy as np
import pytest

from marine_tracker.types import OwnShip, Sweep
from marine_tracker.video import placing

REST = OwnShip(np.array([0.0]), np.zeros((1, 2)), np.zeros((1, 2)))


def sweep(count=64, first=0, per_turn=720, heading=0.3, samples=32, range_=4000.0, period=2.4):
    number = np.arange(first, first + count)
    return Sweep(
        number * (period / per_turn),
        np.mod(number * (2 * np.pi / per_turn), 2 * np.pi),
        np.full(count, heading),
        np.full(count, range_),
        np.ones((count, samples), np.uint8),
    )


def placed(*sweeps, own_ship=REST):
    known, spokes, total = placing.start(), [], {}
    for one in sweeps:
        known, good, counts = placing.place(known, one, own_ship)
        spokes.append(good)
        for reason, count in counts.items():
            total[reason] = total.get(reason, 0) + count
    return spokes, total


def test_bearing_is_angle_and_heading_and_the_scale_comes_from_the_spoke():
    (spokes,), counts = placed(sweep(count=8, first=715, heading=0.5))
    expected = np.mod(np.arange(715, 723) * (2 * np.pi / 720) + 0.5, 2 * np.pi)
    assert np.allclose(spokes.bearing, expected) and not counts
    assert np.allclose(spokes.range_step, 4000.0 / 32)


@pytest.mark.parametrize('rate', [6.0, -4.0])
def test_a_buoy_does_not_swing_in_a_turn_with_a_heading_once_a_second(rate):
    """Own ship turns; the heading that comes with the spokes is up to a second old."""
    parts, errors = [], []
    for first in range(0, 720 * 8, 64):
        one = sweep(first=first)
        true = np.radians(30.0 + rate * one.time)
        told = np.radians(30.0 + rate * np.floor(one.time))
        parts.append(one._replace(heading=np.mod(told, 2 * np.pi)))
        errors.append(true)
    spokes, _ = placed(*parts)
    for one, part, true in zip(spokes[30:], parts[30:], errors[30:]):
        wrong = np.mod(one.bearing - part.angle - true + np.pi, 2 * np.pi) - np.pi
        assert np.abs(np.degrees(wrong)).max() < 0.1


def test_own_ships_heading_counts_where_spokes_tell_none_and_is_prolonged():
    time = np.arange(-1.0, 4.0)
    own = OwnShip(time, np.zeros((5, 2)), np.zeros((5, 2)), np.radians(350.0 + 5.0 * time))
    one = sweep(count=80, first=1080, heading=np.nan)  # 3.6 to 3.87 s, beyond her last sample
    (spokes,), counts = placed(one, own_ship=own)
    wrong = spokes.bearing - one.angle - np.radians(350.0 + 5.0 * one.time)
    assert np.abs(np.mod(wrong + np.pi, 2 * np.pi) - np.pi).max() < 1e-6 and not counts


def test_without_a_heading_there_is_no_bearing_and_the_reason_is_counted():
    (spokes,), counts = placed(sweep(heading=np.nan))
    assert np.isnan(spokes.bearing).all() and counts == {placing.NO_HEADING: 64}


def test_an_old_heading_of_own_ship_is_none():
    own = REST._replace(heading=np.array([1.0]))
    _, counts = placed(sweep(first=1500, heading=np.nan), own_ship=own)
    assert counts == {placing.NO_HEADING: 64}


def test_a_heading_that_jumps_places_nothing_until_it_stays():
    one = sweep(count=600)
    heading = one.heading.copy()
    heading[100:104] += 1.2
    heading[300:] += 0.9
    (spokes,), counts = placed(one._replace(heading=heading))
    assert np.isnan(spokes.bearing[100:104]).all() and np.isfinite(spokes.bearing[104:300]).all()
    assert np.isfinite(spokes.bearing[-1]) or counts[placing.JUMPED] == 304
    later, _ = placed(one._replace(heading=heading), sweep(first=600, heading=1.2))
    assert np.allclose(np.mod(later[1].bearing - sweep(first=600).angle, 2 * np.pi), 1.2)


def test_doubled_missing_and_backward_spokes_are_counted_and_the_others_stay():
    one = sweep(count=40)
    order = np.r_[0:10, 9, 9, 10:20, 24:30, 27, 30:40]
    messy = Sweep(*(column[order] for column in one))._replace(time=np.arange(len(order)) * 3e-3)
    (spokes,), counts = placed(messy)
    assert counts == {placing.DOUBLED: 2, placing.BACK: 1, placing.MISSING: 4}
    assert (np.diff(spokes.bearing) > 0).all() and len(spokes.time) == 36


@pytest.mark.parametrize('lost', [1, 5, 360, 650])
def test_a_gap_over_north_is_a_gap(lost):
    spokes, counts = placed(sweep(first=700), sweep(first=764 + lost))
    assert counts == {placing.MISSING: lost}
    assert all(len(one.time) == 64 for one in spokes)


@pytest.mark.parametrize('lost', [719, 720, 721])
def test_a_lost_revolution_is_no_exception_and_loses_no_spoke(lost):
    spokes, counts = placed(sweep(), sweep(first=64 + lost))
    assert len(spokes[1].time) == 64 and set(counts) <= {placing.MISSING}


@pytest.mark.parametrize('range_', [0.0, -5.0, np.nan, np.inf, 118e6])
def test_a_range_that_is_none_is_refused_by_name(range_):
    one = sweep()
    one.range[10:13] = range_
    (spokes,), counts = placed(one)
    assert counts[placing.BAD_RANGE] == 3 and len(spokes.time) == 61


def test_a_range_that_is_new_nearly_every_spoke_is_a_header_misread():
    one = sweep(count=256)
    random = np.random.default_rng(3)
    (spokes,), counts = placed(one._replace(range=random.uniform(6.0, 150e3, 256)))
    assert not len(spokes.time) and counts[placing.CHANGING] == 256
    few = one.range.copy()
    few[::12] = random.uniform(6.0, 150e3, len(few[::12]))
    (spokes,), counts = placed(one._replace(range=few))
    assert len(spokes.time) == 256 - 22 and counts[placing.CHANGING] == 22
    assert np.unique(spokes.range_step) == pytest.approx([4000.0 / 32])


@pytest.mark.parametrize('column', ['time', 'angle'])
def test_spokes_with_numbers_that_are_none_are_left_out(column):
    one = sweep()
    getattr(one, column)[5] = np.nan
    (spokes,), counts = placed(one)
    assert len(spokes.time) == 63 and sum(counts.values()) in (1, 2)


@pytest.mark.parametrize('shape', [(0, 32), (64, 0)])
def test_a_sweep_without_spokes_or_samples_is_counted(shape):
    one = sweep(count=shape[0])._replace(strength=np.ones(shape, np.uint8))
    (spokes,), counts = placed(one)
    assert not len(spokes.time) and counts == {placing.NO_SPOKES: 1}


def test_a_clock_set_back_begins_again():
    late = sweep(first=720 * 50)
    spokes, counts = placed(late, sweep())
    assert len(spokes[1].time) == 64 and placing.BACK not in counts


def test_one_late_spoke_is_out_of_order():
    one = sweep()
    one.time[20] = one.time[3]
    _, counts = placed(one)
    assert counts[placing.BACK] == 1
