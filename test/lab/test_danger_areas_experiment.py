"""The experiment of danger areas: one scene, and how its courses are judged."""

import numpy as np
import pytest

from marine_tracker.arpa.danger_areas import DangerAreas
from marine_tracker.lab.danger_areas import danger_areas
from marine_tracker.lab.registry import EXPERIMENTS


def test_courses_of_a_scene_agree_with_ships_that_are_sailed():
    targets, areas, agree, ring, safe, inside = danger_areas.judge('imazu_13', 240.0, 8)
    assert targets == 3 and areas >= 3 and 0.3 < safe < 1
    assert agree >= 0.985 and ring >= 0.985  # three of 200 may stand at the very edge
    assert inside > 0.95


def test_a_course_is_inside_where_it_lies_between_the_edges_also_through_north():
    edges = np.radians([[350.0, 358.0, 366.0], [80.0, 90.0, 100.0]])
    way = np.array([[1.0, 3.0, 5.0], [10.0, 10.0, 10.0]])
    areas = DangerAreas(np.array([1, 0]), edges, way, way + 1, way)
    crossed, near, far = danger_areas.crossing(areas, np.radians([2.0, 95.0, 200.0, 349.0]), 3)
    assert crossed.tolist() == [[0, 1, 0], [1, 0, 0], [0, 0, 0], [0, 0, 0]]
    assert near[0, 1] == pytest.approx(4.0) and far[0, 1] == pytest.approx(5.0)
    assert np.isnan(near[2:]).all()


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_all_figures_are_met():
    found = EXPERIMENTS['danger_areas'].run(1, 9)
    assert not [figure for figure in found.figures if figure.ok is False]
