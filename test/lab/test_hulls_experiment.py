"""The experiment `hulls`, short: what it measures, and that it draws."""

import numpy as np
import pytest

from marine_tracker.lab.hulls import traffic
from marine_tracker.lab.hulls.at_sea import BEAMS, COARSE, FINE, Case, run, scene
from marine_tracker.lab.hulls.pictures import paint


@pytest.mark.parametrize('cell, limit', [(FINE, 12.0), (COARSE, 28.0)])
def test_length_and_course_of_a_ship_at_two_km(cell, limit):
    """The demands are on the RMS; a single run is given twice that."""
    found = run(Case(200, 2000.0, 45.0, cell), 'random_matrix', 21)
    assert abs(found.length) < 2 * limit and abs(np.degrees(found.course)) < 4
    assert found.beam > 0 and found.outlined == 0


def test_ship_passes_her_distance_half_way_on_the_bearing_of_the_aspect():
    loaded = scene(Case(300, 1500.0, 90.0, FINE))
    half = loaded.truth_at(0.5 * loaded.duration)
    assert np.hypot(*half.position[0]) == pytest.approx(1500, abs=10)
    assert half.velocity[0] @ half.position[0] == pytest.approx(0, abs=100)
    assert loaded.fleet.hulls.beam == [BEAMS[300]]


@pytest.mark.slow
def test_outline_halves_the_bias_close_by():
    case = Case(200, 1000.0, 45.0, FINE)
    plain, outlined = (
        np.mean([run(case, extent, seed).centre for seed in (31, 32, 33)], 0)
        for extent in ('random_matrix', 'gp')
    )
    assert np.hypot(*outlined) <= 0.5 * np.hypot(*plain)


@pytest.mark.slow
def test_traffic_is_tracked_and_painted():
    from matplotlib.figure import Figure

    hulls, coast = (traffic.track(name, 'random_matrix', 3) for name in ('hulls', 'coast'))
    assert hulls.confirmed <= 7 and hulls.held.min() > 0.95
    canvas = Figure(figsize=(11, 5.5), layout='constrained')
    paint(canvas, hulls.snapshot, coast.snapshot)
    assert len(canvas.subfigs[1].axes) == 5
