import numpy as np
import pytest

from marine_tracker.tracking import clutter_map


def sea(rng, density, reach, sectors=(0.0, 2 * np.pi)):
    """Range and bearing of Poisson clutter of `density` 1/m^2 out to `reach` m."""
    width = sectors[1] - sectors[0]
    count = rng.poisson(density * width / 2 * reach**2)
    return reach * np.sqrt(rng.random(count)), rng.uniform(*sectors, count)


def learnt(rng, scans, before=None, **about):
    clutter = clutter_map.empty() if before is None else before
    for _ in range(scans):
        clutter = clutter_map.learn(clutter, *sea(rng, **about))
    return clutter


@pytest.mark.parametrize('density', [2e-6, 2e-5])
def test_the_density_of_an_even_sea_is_learnt(density):
    """On average over the places of new plots. A small cell is known by a few plots only, so it may
    tell a half to three times as much, and more in few.
    """
    rng = np.random.default_rng(1)
    clutter = learnt(rng, 120, density=density, reach=6000.0)
    found = clutter_map.density(clutter, *sea(rng, density, 4500.0)) / density
    assert 0.9 < found.mean() < 1.1
    assert np.mean(found > 3) < 0.05


def test_a_few_scans_tell_the_order_of_magnitude():
    rng = np.random.default_rng(2)
    clutter = learnt(rng, 3, density=1e-5, reach=6000.0)
    found = clutter_map.density(clutter, *sea(rng, 1e-5, 5000.0)) / 1e-5
    assert 0.3 < np.median(found) < 3.0 and 0.5 < found.mean() < 2.0


def test_clutter_near_own_ship_is_told_from_the_clear_sea_outside():
    rng = np.random.default_rng(3)
    clutter = learnt(rng, 100, density=2e-5, reach=2000.0)
    bearing = np.linspace(0, 6.2, 50)
    near = clutter_map.density(clutter, np.full(50, 1200.0), bearing)
    outside = clutter_map.density(clutter, np.full(50, 4000.0), bearing)
    assert 0.7 * 2e-5 < near.mean() < 1.4 * 2e-5
    assert (outside < 0.01 * 2e-5).all()


def test_clutter_on_one_side_weighs_most_there():
    rng = np.random.default_rng(4)
    clutter = learnt(rng, 150, density=2e-5, reach=5000.0, sectors=(np.pi, 2 * np.pi))
    inside = clutter_map.density(clutter, *sea(rng, 1e-6, 4500.0, (3.6, 5.8)))
    elsewhere = clutter_map.density(clutter, *sea(rng, 1e-6, 4500.0, (0.5, 2.6)))
    assert 0.85 * 2e-5 < inside.mean() < 1.4 * 2e-5
    assert elsewhere.mean() < 0.1 * inside.mean()


def test_clutter_that_has_gone_is_forgotten():
    rng = np.random.default_rng(5)
    clutter = learnt(rng, 60, density=2e-5, reach=5000.0)
    nothing = np.zeros(0), np.zeros(0)
    for _ in range(150):
        clutter = clutter_map.learn(clutter, *nothing)
    assert (clutter_map.density(clutter, *sea(rng, 1e-6, 4000.0)) < 0.01 * 2e-5).all()


def test_an_empty_sea_has_a_small_positive_density_everywhere():
    where = np.array([0.0, 1e-9, 10.0, 50.0, 3e3, 4.4e4, 2e5, 1e6])
    nothing = np.zeros(0), np.zeros(0)
    for clutter in (clutter_map.empty(), clutter_map.learn(clutter_map.empty(), *nothing)):
        found = clutter_map.density(clutter, where, np.linspace(0, 2 * np.pi, 8))
        assert np.isfinite(found).all() and (found > 0).all()
        # Much less than one false plot in the gate of a track, 1 / (pi (3 x 60 m)^2).
        assert (found[4:] < 1e-6).all()


def test_learning_leaves_the_map_before_it_alone():
    clutter = clutter_map.empty()
    clutter_map.learn(clutter, np.array([100.0]), np.array([1.0]))
    assert not clutter.plots.any() and clutter.scans == 0


def test_a_crowd_in_one_cell_says_nothing_of_the_other_side_of_the_ring():
    """4,000 plots a scan within 200 m at 5 km: there they are false, abeam the sea is clear."""
    rng = np.random.default_rng(9)
    clutter = clutter_map.empty()
    for _ in range(40):
        crowd = 5000 + rng.uniform(-100, 100, 4000), 1.0 + rng.uniform(-0.02, 0.02, 4000)
        clutter = clutter_map.learn(clutter, *crowd)
    there, abeam = clutter_map.density(clutter, np.full(2, 5000.0), np.array([1.0, 3.0]))
    assert there > 3e-4
    assert abeam < 5e-6


def test_a_shore_is_known_in_its_small_cells():
    """Two plots a scan at one place, among few that are anywhere."""
    rng = np.random.default_rng(10)
    clutter = clutter_map.empty()
    for _ in range(32):
        shore = 700 + rng.normal(0, 3, 2), 2.0 + rng.normal(0, 0.004, 2)
        found = np.concatenate([shore, sea(rng, 2e-7, 3000.0)], 1)
        clutter = clutter_map.learn(clutter, *found)
    range_, bearing = np.array([700.0, 700.0, 1400.0]), np.array([2.0, 2.6, 2.0])
    there, beside, behind = clutter_map.density(clutter, range_, bearing)
    assert there > 30 * max(beside, behind)
    # Two plots a scan in a cell of 69 m by 63 m.
    assert 0.7 * 2 / (69 * 63) < there < 1.1 * 2 / (69 * 63)


def test_the_first_scan_is_forgotten_with_the_second():
    """In the first all plots are lone; in the second those of targets are not."""
    rng = np.random.default_rng(11)
    first = clutter_map.learn(clutter_map.empty(), *sea(rng, 5e-5, 3000.0))
    clutter = clutter_map.learn(first, *sea(rng, 8e-6, 3000.0))
    where = sea(rng, 1e-5, 2500.0)
    assert clutter_map.density(first, *where).mean() == pytest.approx(5e-5, rel=0.2)
    assert clutter_map.density(clutter, *where).mean() == pytest.approx(8e-6, rel=0.3)


def test_an_empty_sea_has_the_least_density():
    range_ = np.array([80.0, 900.0, 30000.0])
    found = clutter_map.density(clutter_map.empty(), range_, np.full(3, 5.0))
    assert found == pytest.approx(clutter_map.least(range_), rel=0.01)  # rings are not quite even
