"""The experiment of alarms: short scenes, and how alarms are counted."""

import numpy as np
import pytest

from marine_tracker.geometry import KNOT
from marine_tracker.lab.alarms import alarms, yawing
from marine_tracker.lab.alarms.watch import NOBODY, Watch, keep

MINUTE = 60.0


def test_ships_that_pass_a_yawing_own_ship_sound_once_and_none_is_missed():
    sounded, missed = alarms.under_yaw(9.0, 43.0, 1, 41).T
    assert sounded.max() <= 2 and not missed.any()
    assert (sounded[:3] >= 1).all()  # inside the limit
    assert sounded[4:].sum() == 0  # 1.2 times the limit and more


def test_the_yawing_own_ship_makes_good_a_straight_course():
    scene = yawing.passing(8.0, 50.0, 0)
    times = np.arange(100.0, 1400.0, 50.0)
    made = np.diff(scene.own_ship_at(times).position, axis=0) / 50.0
    share = np.sin(np.radians(8.0)) / np.radians(8.0)
    np.testing.assert_allclose(made, [[0.0, 12 * KNOT * share]] * len(made), atol=0.01)
    turned = scene.own_ship_at(np.arange(100.0, 200.0, 1.0)).velocity
    assert np.degrees(np.arctan2(*turned.T)).max() == pytest.approx(8.0, abs=0.4)


def counted(dangers, sounded, ship=0, alarmed=True):
    """A watch of 100 min with one ship, dangerous from and to the minutes given."""
    time = np.arange(0.0, 100 * MINUTE, 5.0)
    dangerous = np.zeros((len(time), 1), bool)
    for begin, end in dangers:
        dangerous[(time >= begin * MINUTE) & (time <= end * MINUTE)] = True
    return alarms.tally(
        Watch(
            time,
            dangerous,
            np.zeros(dangerous.shape),
            dangerous & alarmed,
            MINUTE * np.array(sounded, float),
            np.full(len(sounded), ship),
        )
    )


def test_alarms_are_counted_by_what_they_were_for():
    found = counted([(10, 20), (40, 41.5)], [9.5, 15, 42, 70])
    assert found[1:] == (2, 0, 2, 1, 1)
    assert found.hours == pytest.approx(100 / 60, abs=0.01)
    assert counted([(10, 20)], [], alarmed=False)[1:] == (1, 1, 0, 0, 0)
    assert counted([(10, 10.5)], [10.2])[1:] == (0, 0, 1, 0, 0)  # of a moment
    assert counted([], [5], ship=NOBODY)[1:] == (0, 0, 0, 0, 1)


def test_a_folder_without_ais_is_refused(tmp_path):
    (tmp_path / 'somewhere').mkdir()
    with pytest.raises(ValueError, match='--data .* has no folder with an ais.csv'):
        alarms.run(1, 1, data=str(tmp_path))


@pytest.mark.slow
@pytest.mark.timeout(3600)
def test_all_figures_are_met():
    found = alarms.run(2, 5)
    assert not [figure for figure in found.figures if figure.ok is False]


def test_a_watch_knows_what_truly_is_a_danger():
    scene = yawing.passing(0.0, 0.0, 2)
    watch = keep(scene, 3)
    inside = np.array(yawing.shares(2)) < 1
    assert (watch.dangerous.any(0) == inside).all()
    least = np.nanmin(np.where(watch.dangerous, watch.cpa, np.nan), 0)[inside]
    limit = np.array(yawing.shares(2))[inside] * yawing.LIMIT * 1852
    np.testing.assert_allclose(least, limit, rtol=0.02)
