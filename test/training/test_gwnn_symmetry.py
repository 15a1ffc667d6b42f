"""The eight ways to see the same picture."""

import numpy as np

from marine_tracker.estimators.gwnn import bank, gwnn, inputs
from marine_tracker.training import gwnn_symmetry, ship_tracks

PERIOD = 60 / 22


def test_there_are_eight_and_they_are_a_group():
    ways = gwnn_symmetry.symmetries()
    marks = {tuple(way.state) + tuple(way.state_sign) for way in ways}
    assert len(marks) == 8
    probe = np.arange(1.0, inputs.COUNT + 1)
    images = {tuple(probe[way.inputs] * way.sign) for way in ways}
    assert len(images) == 8
    for one in ways:
        for other in ways:
            twice = (probe[one.inputs] * one.sign)[other.inputs] * other.sign
            assert tuple(twice) in images


def test_tracks_mirrored_give_the_inputs_mirrored():
    """Mirrored at the north axis, what lies across the line of sight changes sign."""
    count, scans, every = 20, 30, np.ones(20)
    rng = np.random.default_rng(6)
    ships = ship_tracks.sail(
        ['sharp'] * count, np.full(count, 5000.0), np.full((count, scans), PERIOD), rng
    )
    radar = ship_tracks.RunRadar(15 * every, 0.006 * every, every, 0 * every, every, PERIOD * every)
    plots, _ = ship_tracks.observe(ships, radar, rng)
    mirror = np.diag([-1.0, 1.0])

    def seen(plots):
        ship = bank.BANKS['ship']
        state, memory = bank.begin(ship, plots[0], 25.0), inputs.begin(plots[0])
        for one in plots[1:]:
            state, memory, _ = gwnn.advance(ship, state, memory, one)
        return inputs.inputs(ship, state, memory, PERIOD)

    mirrored = [
        p._replace(position=p.position @ mirror, covariance=mirror @ p.covariance @ mirror)
        for p in plots
    ]
    way = gwnn_symmetry._symmetry(np.array([1, -1]), False)
    np.testing.assert_allclose(
        seen(mirrored), seen(plots)[:, way.inputs] * way.sign, rtol=1e-6, atol=1e-6
    )
