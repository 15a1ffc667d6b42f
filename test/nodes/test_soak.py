"""Half an hour of `marine_tracker soak`, of which the full run takes eight hours."""

import pytest

pytest.importorskip('rclpy')
from marine_tracker.nodes import soak


@pytest.fixture(scope='module')
def found(domain):
    return soak.run(0.6, 3, True, lambda done, whole: None)


@pytest.mark.slow
def test_ships_are_held_again_soon_after_each_fault(found):
    assert {one.fault for one in found.incidents} >= {*soak.FAULTS, soak.SIMULATOR}
    assert all(one.held > 20 for one in found.incidents)
    assert {one.fault: one.scans for one in found.incidents if one.scans > 5} == {}


@pytest.mark.slow
def test_no_callback_fails(found):
    assert found.exceptions == []


@pytest.mark.slow
def test_memory_is_measured(found):
    assert len(found.memory) and (found.memory[:, 1] > 50).all()


def test_without_faults_nothing_happens_but_the_scenario():
    calm = soak.run(0.1, 1, False, lambda done, whole: None)
    assert calm.incidents == [] and calm.held > 20
