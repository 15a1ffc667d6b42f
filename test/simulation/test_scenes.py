"""The shipped scenes by which existence, association and stationary places are judged."""

import numpy as np
import pytest

from marine_tracker.simulation import crossings, scenario


def along(name):
    """Position [T, targets, 2] m of every target, every second."""
    loaded = scenario.load(name)
    truths = [loaded.truth_at(time) for time in np.arange(0.0, loaded.duration)]
    return loaded, np.stack([truth.position for truth in truths])


def test_ships_of_the_harbour_stop_anchor_and_leave():
    loaded, position = along('busy_harbour')
    speed = np.linalg.norm(np.diff(position, axis=0), axis=2)
    name = loaded.fleet.names
    first, last = speed[:60].mean(0), speed[-60:].mean(0)
    for stops in ('coaster that stops at the west quay', 'ship that anchors'):
        assert first[name.index(stops)] > 2 and last[name.index(stops)] < 0.01
    for leaves in ('tug that leaves the inner quay', 'ship that weighs anchor'):
        assert first[name.index(leaves)] < 0.01 and last[name.index(leaves)] > 2
    anchored = name.index('ship at anchor')
    assert speed[:, anchored].max() == 0 and loaded.fleet.pd[anchored] == 0.6
    assert len(loaded.fixed.place) > 200


def test_banks_of_the_canal_are_30_to_100_m_apart():
    loaded = scenario.load('canal')
    east = loaded.fixed.place[:, 0]
    bank = np.hypot(*np.diff(loaded.fixed.place, axis=0).T) < 21  # neighbours on one line
    west_end = int(np.flatnonzero(~bank)[0])
    east_end = int(np.flatnonzero(~bank)[1])
    west, other = (
        loaded.fixed.place[: west_end + 1],
        loaded.fixed.place[west_end + 1 : east_end + 1],
    )
    width = np.abs(
        np.interp(np.arange(-500, 500, 10), other[:, 1], other[:, 0])
        - np.interp(np.arange(-500, 500, 10), west[:, 1], west[:, 0])
    )
    assert 25 <= width.min() <= 40 and 90 <= width.max() <= 105
    assert east.min() > -30


def test_pairs_of_boats_are_10_to_20_m_apart_for_a_while():
    loaded, position = along('two_boats')
    for first in (0, 2, 4, 6):
        apart = np.linalg.norm(position[:, first] - position[:, first + 1], axis=1)
        assert 5 < apart.min() < 20
        assert apart.max() > 60


def test_the_agile_boat_turns_by_25_degrees_in_a_second_and_stays_in_range():
    loaded, position = along('agile_boat')
    velocity = np.diff(position[:, 0], axis=0)
    course = np.unwrap(np.arctan2(*velocity.T))
    assert 23 < np.degrees(np.abs(np.diff(course))).max() < 26
    own = loaded.own_ship_at(np.arange(0.0, loaded.duration)).position
    distance = np.linalg.norm(position[:, 0] - own, axis=1)
    assert 50 < distance.min() and distance.max() < loaded.radar.max_range


@pytest.mark.parametrize('angle', [5, 12.5, 37, 90, 150])
def test_crossing_ships_meet_in_the_middle_with_the_angle_asked_for(angle):
    loaded = scenario.build(crossings.crossing(angle), 'crossing')
    middle = loaded.truth_at(0.5 * loaded.duration)
    assert np.linalg.norm(np.diff(middle.position, axis=0)) < 0.01
    first, second = np.arctan2(*middle.velocity.T)
    assert np.degrees(second - first) == pytest.approx(angle)
    for time in (0.0, loaded.duration):
        assert np.linalg.norm(np.diff(loaded.truth_at(time).position, axis=0)) > 399


def test_twenty_ships_among_five_hundred_false_plots():
    loaded, position = along('false_plots')
    own = loaded.own_ship_at(np.arange(0.0, loaded.duration)).position
    distance = np.linalg.norm(position - own[:, None], axis=2)
    assert position.shape[1] == 20 and loaded.clutter.uniform == 500
    assert distance.max() < loaded.radar.max_range and distance.min() > loaded.radar.blind_range


def test_crowds_of_the_strait_stay_in_range():
    loaded, position = along('crowded_strait')
    own = loaded.own_ship_at(np.arange(0.0, loaded.duration)).position
    distance = np.linalg.norm(position - own[:, None], axis=2)
    assert position.shape[1] == 46 and (distance.min(0) < loaded.radar.max_range).all()
    assert (np.ptp(position, axis=0).max(1) < 1).sum() == 13  # at anchor
