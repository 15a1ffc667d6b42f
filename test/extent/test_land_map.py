import numpy as np

from marine_tracker.extent import land_map
from marine_tracker.extent.land_map import KEEPS, MEMORY, learn, on_land


def echoes(start, end, step=20.0):
    start, end = np.asarray(start, float), np.asarray(end, float)
    count = int(np.hypot(*(end - start)) / step) + 1
    return np.linspace(start, end, count)


def after(scans, echoes_of, width=(20.0, 0.0)):
    land = land_map.empty()
    for k in range(scans):
        position = echoes_of(k)
        land = learn(land, position, np.tile(width, (len(position), 1)))
    return land


def test_a_coast_is_land_from_the_first_scan_on_and_beside_it_too():
    coast = echoes([1000, 0], [1000, 3000])
    land = after(1, lambda k: coast)
    assert on_land(land, coast).all()
    assert on_land(land, coast + [60.0, 0.0]).all()
    assert not on_land(land, coast + [150.0, 0.0]).any()


def test_a_coast_that_shows_in_changing_shreds_is_land():
    rng = np.random.default_rng(1)
    coast = echoes([1000, 0], [1000, 3000])
    land = after(12, lambda k: coast[rng.random(len(coast)) < 0.5])
    assert on_land(land, coast).mean() > 0.95


def test_a_ship_at_anchor_is_too_short_for_land():
    ship = echoes([0, 0], [250, 180])
    assert not on_land(after(60, lambda k: ship), ship).any()


def test_the_wake_of_a_ship_under_way_is_no_land():
    """7 m/s: 19 m a scan, so that 60 scans are 1,100 m, each square of which echoed for a while."""
    ship = echoes([0, 0], [0, 200])
    land = after(60, lambda k: ship + [0, 19.0 * k])
    everywhere = echoes([0, 0], [0, 1400])
    assert not on_land(land, everywhere).any()


def test_land_that_is_seen_no_more_is_forgotten():
    coast = echoes([1000, 0], [1000, 3000])
    seen = after(MEMORY, lambda k: coast)
    scans = int(np.ceil(np.log(KEEPS / 2) / np.log(1 - 1 / MEMORY)))
    for _ in range(scans):
        seen = learn(seen, np.empty((0, 2)), np.empty((0, 2)))
    assert not on_land(seen, coast).any()
    for _ in range(200):
        seen = learn(seen, np.empty((0, 2)), np.empty((0, 2)))
    assert not len(seen.share)


def test_a_far_shore_has_no_gaps_though_beams_are_wide_apart():
    """At 8 km a beam of 1 degree is 140 m wide."""
    shore = echoes([0, 8000], [2800, 8000], 140.0)
    assert on_land(after(1, lambda k: shore, width=(140.0, 0.0)), shore).all()
