import numpy as np
import pytest

from marine_tracker.geometry import to_range_bearing
from marine_tracker.simulation import radar

QUIET = {'range_sigma_m': 0, 'bearing_sigma_deg': 0, 'range_resolution_m': 0, 'max_range_m': 5000}
FAR = [{'start': {'range_m': 4900, 'bearing_deg': 300}, 'speed_kn': 0, 'pd': 0.0}]


@pytest.fixture
def shore(make_scenario):
    """The scans of a scene with nothing but these reflectors."""

    def make(*items, seed=1, **more):
        values = {'radar': QUIET, 'targets': FAR, **more, 'reflectors': list(items)}
        return list(radar.simulate(make_scenario(**values), seed))

    return make


def test_points_of_a_line_are_as_far_apart_as_stated_and_its_ends_are_among_them(make_scenario):
    line = {'corners_m': [[100, -200], [100, 160], [340, 160]], 'spacing_m': 40}
    place = make_scenario(reflectors=[line]).fixed.place
    assert place[[0, -1]] == pytest.approx(np.array([[-200, 100], [160, 340]]))
    assert np.hypot(*np.diff(place, axis=0).T) == pytest.approx(40)
    assert len(place) == 16


def test_plots_lie_where_the_reflector_is_when_the_beam_meets_it_also_from_a_moving_ship(shore):
    at = np.array([700.0, -350.0])
    scans = shore(
        {'places_m': [[-350, 700]], 'pd': 1},
        own_ship={'course_deg': 70, 'speed_kn': 24},
        duration_s=300,
    )
    for scan, truth in scans:
        assert len(scan.plots.range) == 1 and len(truth.time) == 1
        own = np.array(
            [np.interp(scan.plots.time, scan.own_ship.time, x)[0] for x in scan.own_ship.position.T]
        )
        distance, bearing = to_range_bearing(at - own)
        assert scan.plots.range[0] == pytest.approx(distance, abs=0.05)
        assert scan.plots.bearing[0] == pytest.approx(bearing, abs=1e-4)


def test_part_of_the_revolutions_with_a_plot_is_the_probability_of_detection(shore):
    # 218 revolutions of 40 points: the standard error of the share is .005
    scans = shore({'corners_m': [[900, -900], [900, 900]], 'spacing_m': 46, 'pd': 0.65})
    counts = [len(scan.plots.range) for scan, _ in scans]
    assert np.mean(counts) / 41 == pytest.approx(0.65, abs=0.02)


def test_probability_of_detection_is_drawn_anew_from_its_span(shore):
    scans = shore({'places_m': [[500, 500]], 'pd': [0, 1], 'spell_s': 100}, duration_s=20_000)
    seen = np.array([len(scan.plots.range) for scan, _ in scans])
    share = seen[: len(seen) // 20 * 20].reshape(-1, 20).mean(1)  # of some 55 s each
    assert share.mean() == pytest.approx(0.5, abs=0.06)
    assert share.std() > 0.2  # of independent draws .11


def test_a_boat_close_to_a_quay_gives_one_plot_with_it(make_scenario):
    boat = {'start': {'north_m': 800, 'east_m': 6}, 'speed_kn': 0, 'pd': 1}
    values = {
        'radar': {**QUIET, 'range_resolution_m': 20, 'beam_width_deg': 1.5},
        'targets': [boat],
        'reflectors': [{'places_m': [[806, 0]], 'pd': 1}, {'places_m': [[870, 0]], 'pd': 1}],
    }
    for scan, _ in radar.simulate(make_scenario(**values), 4):
        assert len(scan.plots.range) == 2


def test_reflectors_do_not_change_the_plots_of_ships(make_scenario, shore):
    ship = [{'start': {'range_m': 3000, 'bearing_deg': 120}, 'course_deg': 300, 'speed_kn': 9}]
    noisy = {'max_range_m': 5000, 'range_resolution_m': 0}
    alone = [s for s, _ in radar.simulate(make_scenario(radar=noisy, targets=ship), 5)]
    among = shore({'places_m': [[-900, 40]], 'pd': 1}, seed=5, radar=noisy, targets=ship)
    for one, (other, _) in zip(alone, among, strict=True):
        assert np.isin(one.plots.range, other.plots.range).all()
        assert len(other.plots.range) == len(one.plots.range) + 1


def test_radial_speed_of_a_reflector_is_that_of_a_thing_at_rest(shore):
    doppler = {**QUIET, 'radial_speed_sigma_mps': 0.3}
    scans = shore(
        {'places_m': [[-900, 40]], 'pd': 1},
        radar=doppler,
        own_ship={'course_deg': 200, 'speed_kn': 20},
    )
    speeds = np.concatenate([scan.plots.radial_speed for scan, _ in scans])
    assert speeds.mean() == pytest.approx(0, abs=0.1) and speeds.std() == pytest.approx(
        0.3, rel=0.2
    )


@pytest.mark.parametrize(
    ('item', 'said'),
    [
        ({'places_m': [[1, 2]], 'pd': 1.5}, r'reflectors\[0\].pd is 1.5; it must be a number betw'),
        ({'places_m': [[1, 2]], 'pd': [0.9, 0.2]}, r'reflectors\[0\].pd is \[0.9, 0.2\]; it must'),
        ({'places_m': [[1, 2]], 'spacing_m': 5}, r'reflectors\[0\] has a spacing beside places'),
        ({'corners_m': [[1, 2]], 'spacing_m': 5}, r'corners_m has 1 corners; it must have at l'),
        ({'corners_m': [[1, 2], [3, 4]]}, r'reflectors\[0\] has no spacing_m or spacing_nm'),
        ({'pd': 0.5}, r'none of corners_m or corners_nm; places_m or places_nm'),
        ({'corners_m': [[0, 0], [90000, 0]], 'spacing_m': 2}, r'make 45001 points; there may be'),
    ],
)
def test_wrong_reflectors_are_refused_by_name(make_scenario, item, said):
    with pytest.raises(ValueError, match=said):
        make_scenario(reflectors=[item])
