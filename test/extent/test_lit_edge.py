import numpy as np
import pytest

from marine_tracker.extent.lit_edge import lit_edge
from marine_tracker.geometry import locate
from marine_tracker.simulation import radar, scenario
from marine_tracker.types import OwnShip, PolarPlots

DEPTH, BEAM = 10.0, np.radians(0.75)


def cells(range_, bearing):
    range_, bearing = np.asarray(range_, float), np.asarray(bearing, float)
    own = OwnShip(np.zeros(1), np.zeros((1, 2)), np.zeros((1, 2)))
    return locate(
        PolarPlots(np.zeros(len(range_)), range_, bearing, np.zeros(len(range_))), own, 1e-3, 1e-6
    )


def test_the_nearest_cell_of_each_beam_is_taken_and_set_back():
    deep = np.array([1000.0, 1010, 1020])
    seen = cells(
        np.concatenate([deep, deep + 10, deep + 500]), np.repeat([0.5, 0.5 + BEAM, 0.9], 3)
    )
    found = lit_edge(seen, np.repeat([0, 0, 1], 3), np.tile(np.eye(2), (2, 1, 1)), DEPTH, BEAM)
    assert found.cluster.tolist() == [0, 0, 1]
    assert np.hypot(*found.position.T) == pytest.approx([1006.05, 1016.05, 1506.05], abs=0.1)
    bearing = np.arctan2(*found.position.T)
    assert bearing[2] == pytest.approx(0.9) and 0 < bearing[1] - bearing[0] < BEAM
    assert found.noise[0] == pytest.approx(0.36 * np.eye(2))


@pytest.mark.parametrize('bearing', [90.0, 0.0])
def test_edge_of_a_simulated_hull_lies_on_her_near_side(bearing):
    """Broadside on at 1 km, over north as well: along the side that faces the radar, on average to
    within 2 m, and no farther than a cell beyond bow and stern."""
    loaded = scenario.build(
        {
            'duration_s': 109,
            'radar': {'range_resolution_m': 10, 'beam_width_deg': 0.75},
            'targets': [
                {
                    'start': {'range_m': 1000, 'bearing_deg': bearing},
                    'speed_kn': 0,
                    'length_m': 200,
                    'hull': {'beam_m': 32, 'heading_deg': bearing + 90},
                }
            ],
        },
        'one',
    )
    toward = np.array([np.sin(np.radians(bearing)), np.cos(np.radians(bearing))])
    ahead = np.array([toward[1], -toward[0]])
    near, along = [], []
    for scan, truth in radar.simulate(loaded, 1):
        seen = locate(scan.plots, scan.own_ship, 1.0, 1e-3)
        edge = lit_edge(seen, np.zeros(len(seen.time), int), np.zeros((1, 2, 2)), DEPTH, BEAM)
        off = edge.position - truth.position[0]
        near.append((off @ toward)[np.abs(off @ ahead) < 50])
        along.append(off @ ahead)
    assert np.concatenate(near).mean() == pytest.approx(-16, abs=2)
    ends = np.mean([[one.min(), one.max()] for one in along], 0)
    assert np.abs(ends) == pytest.approx([100, 100], abs=13)
