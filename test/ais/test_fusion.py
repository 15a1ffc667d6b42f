"""AIS as another sensor of tracks: the weighted mean, and only of those that are trusted."""

import numpy as np
import pytest

from marine_tracker.ais import fusion, registration, ships
from marine_tracker.ais.reports import positions
from marine_tracker.ais.ship_motion import at
from marine_tracker.ais.ship_table import none
from marine_tracker.types import Extrapolation

OWN = np.array([300.0, -200.0])


@pytest.fixture
def scene():
    """Two ships that report at 20 s, seen by radar 40 m to the east; errors known to be none."""
    count = np.zeros(2)
    told = positions(
        np.array([211000001, 211000002]), count + 20, count, count, count + 6, count,
        timed=True, size=np.full((2, 4), 5.0), heading=count,
    )  # fmt: skip
    place = np.array([[2000.0, 3000.0], [-1500.0, 900.0]])
    known, _ = ships.hear(none(), told, place, 7)
    covariance = np.stack([np.diag([900.0, 900, 4, 4])] * 2)
    moment = np.array([22.0, 23.0])
    seen = Extrapolation(
        moment, at(known, moment).position + [40.0, 0.0], np.zeros((2, 2)), covariance
    )
    errors = registration.begin()._replace(covariance=np.zeros((4, 4)))
    return seen, known, errors


def test_place_and_velocity_lie_between_both_by_their_covariances(scene):
    seen, known, errors = scene
    trusted = np.array([[known.id[0], 51]])
    both = fusion.fused(seen, np.array([51, 52]), trusted, known, errors, OWN)
    # As the joint Gaussian says, from both inverse covariances.
    ais = at(known._replace(accurate=~known.coarse), seen.time)
    weight = [np.linalg.inv(one.covariance[0]) for one in (seen, ais)]
    values = [np.concatenate([one.position[0], one.velocity[0]]) for one in (seen, ais)]
    covariance = np.linalg.inv(weight[0] + weight[1])
    mean = covariance @ (weight[0] @ values[0] + weight[1] @ values[1])
    assert np.concatenate([both.position[0], both.velocity[0]]) == pytest.approx(mean)
    assert both.covariance[0] == pytest.approx(covariance)
    for name in both._fields:  # who is not trusted stays as radar says
        assert np.array_equal(getattr(both, name)[1], getattr(seen, name)[1])


def test_who_is_lost_or_unknown_changes_nothing(scene):
    seen, known, errors = scene
    lost = known._replace(lost=np.array([True, True]))
    ids = np.array([51, 52])
    pairs = np.array([[known.id[0], 51]])
    for fleet, trusted in ((lost, pairs), (known, pairs + [[0, 9]]), (known, pairs + [[90, 0]])):
        both = fusion.fused(seen, ids, trusted, fleet, errors, OWN)
        assert np.array_equal(both.position, seen.position)


def test_a_ship_is_laid_where_the_radar_would_see_her(scene):
    seen, known, errors = scene
    wrong = errors._replace(value=np.array([70.0, np.radians(1.4), 3.0, -5.0]))
    offset = at(known, seen.time).position - OWN
    back = registration.corrected(wrong, registration.as_seen(wrong, offset))
    assert back == pytest.approx(offset)
