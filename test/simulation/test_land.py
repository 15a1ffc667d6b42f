import numpy as np
import pytest

from marine_tracker.geometry import own_ship_at, unit_vector
from marine_tracker.simulation.radar import simulate

RADAR = {'range_resolution_m': 15, 'beam_width_deg': 1, 'max_range_nm': 4}
FAR = [{'start': {'range_nm': 20, 'bearing_deg': 0}, 'speed_kn': 0}]


def positions(scan):
    origin, _ = own_ship_at(scan.own_ship, scan.plots.time)
    return origin + scan.plots.range[:, None] * unit_vector(scan.plots.bearing)


def test_shore_gives_cells_along_its_whole_length_in_every_scan(make_scenario):
    loaded = make_scenario(
        duration_s=120,
        radar=RADAR,
        targets=FAR,
        own_ship={'course_deg': 0, 'speed_kn': 12},
        land=[{'corners_m': [[-2000, 1500], [3000, 1500]]}],
    )
    for scan, _ in simulate(loaded, 1):
        east, north = positions(scan).T
        assert np.abs(east - 1500).max() < 60  # within the beam's smear at 3.4 km
        assert north.min() < -1800 and north.max() > 2800
        assert np.diff(np.sort(north)).max() < 200


def test_land_hides_what_is_behind_it(make_scenario):
    islet = {'corners_m': [[1000, 0], [1200, 300], [1500, 100], [1300, -200]], 'closed': True}
    behind = {'corners_m': [[1800, -150], [1800, 250]]}
    beside = {'corners_m': [[1800, -1200], [1800, -900]]}
    loaded = make_scenario(duration_s=60, radar=RADAR, targets=FAR, land=[islet, behind, beside])
    off = np.concatenate([positions(scan) for scan, _ in simulate(loaded, 2)])
    hidden = (off[:, 1] > 1700) & (np.abs(off[:, 0]) < 100)
    assert not hidden.any()
    assert ((off[:, 1] > 1700) & (off[:, 0] < -800)).sum() > 100
    assert not ((off[:, 1] > 1420) & (off[:, 1] < 1600)).any()  # the islet's far shore


@pytest.mark.parametrize(
    'shore, text',
    [
        ({}, r'land\[0\] has none of corners_m or corners_nm'),
        ({'corners_m': [[0, 0]]}, r'land\[0\].corners_m has 1 corners; it must have at least 2'),
        ({'corners_m': [[0, 0], [9, 9]], 'closed': True}, 'must have at least 3'),
        ({'corners_m': [[0, 0], [0, 0]]}, r'corners_m\[0\] is the same as the corner after it'),
        ({'corners_m': [[0, 0], [1, 'x']]}, r"corners_m\[1\] is \[1, 'x'\]; it must be"),
        ({'corners_nm': [[0, 0], [1, 999]]}, 'within 107.991'),
        (
            {'corners_m': [[0, 0], [1, 1]], 'closed': 'yes'},
            "closed is 'yes'; it must be true or false",
        ),
        ({'corners': [[0, 0], [1, 1]]}, 'write corners_m or corners_nm'),
    ],
)
def test_wrong_land_is_refused_with_its_place(make_scenario, shore, text):
    with pytest.raises(ValueError, match=text):
        make_scenario(radar=RADAR, land=[shore])
