import numpy as np
import pytest

from marine_tracker.geometry import KNOT, own_ship_at, unit_vector
from marine_tracker.simulation import echoes, scenario
from marine_tracker.simulation.radar import simulate

PERIOD = 60 / 22
RADAR = {'range_resolution_m': 10, 'beam_width_deg': 0.75, 'max_range_nm': 4}


def ship(range_m, bearing_deg, course_deg, length_m, beam_m, speed_mps=6, **hull):
    return {
        'start': {'range_m': range_m, 'bearing_deg': bearing_deg},
        'course_deg': course_deg,
        'speed_mps': speed_mps,
        'length_m': length_m,
        'hull': {'beam_m': beam_m, **hull},
    }


def positions(scan):
    """[M, 2] m, of the plots, each from where own ship was at its time."""
    origin, _ = own_ship_at(scan.own_ship, scan.plots.time)
    return origin + scan.plots.range[:, None] * unit_vector(scan.plots.bearing)


def along_and_across(offset, heading):
    forward = unit_vector(heading)
    return offset @ forward, offset @ np.array([forward[1], -forward[0]])


def test_echoes_add_up_in_a_cell_as_waves_do(make_scenario):
    radar = make_scenario(radar=RADAR, duration_s=60).radar
    distance, bearing = np.array([1003.0, 1009.0, 1012.0]), np.radians([30.1, 30.9, 30.2])
    echo = 1e6 * np.array([1, -0.5 + 1j, 0.7j])
    plots = echoes.cells(radar, 0.0, distance, bearing, echo, np.random.default_rng(1))
    found = {
        (round(r / 10 - 0.5), round(np.degrees(b) / 0.75 - 0.5)): power
        for r, b, power in zip(plots.range, plots.bearing, plots.amplitude)
    }
    for i in (99, 100, 101):
        for j in (39, 40, 41):
            field = 0
            for r, b, e in zip(distance, np.degrees(bearing), echo):
                # Half the power at half a cell off in range; a quarter in bearing, both ways.
                field += (
                    e
                    * 0.5 ** (2 * ((10 * i + 5 - r) / 10) ** 2)
                    * 0.25 ** (2 * ((0.75 * j + 0.375 - b) / 0.75) ** 2)
                )
            assert found[i, j] == pytest.approx(20 * np.log10(abs(field)), abs=0.01)


def test_cells_of_a_point_spread_as_pulse_and_beam_do(make_scenario):
    radar, rng = make_scenario(radar=RADAR, duration_s=60).radar, np.random.default_rng(2)
    off = []
    for _ in range(1500):
        distance, bearing = np.array([rng.uniform(1500, 2500)]), np.array([rng.uniform(1, 2)])
        echo = np.sqrt(0.5 * 10**2.5) * (rng.standard_normal((1, 2)) @ [1, 1j])
        plots = echoes.cells(radar, 0.0, distance, bearing, echo, rng)
        off.append(
            np.column_stack(
                [(plots.range - distance) / 10, (plots.bearing - bearing) / radar.beam_width]
            )
        )
    # A cell x off is seen with exp(-threshold / mean power); cells stand anywhere.
    x = np.linspace(-2.5, 2.5, 5001)
    beside = np.exp(
        -20 / (1 + 10**2.5 * 0.5 ** (4 * x[:, None] ** 2) * 0.25 ** (4 * x**2))
    )  # along, across
    for found, weight in zip(np.concatenate(off).T, (beside.sum(1), beside.sum(0))):
        expected = np.sqrt((weight * x**2).sum() / weight.sum())
        assert found.std() == pytest.approx(expected, rel=0.05)  # 3.5 sigma of 3,000 cells
        assert abs(found.mean()) < 0.04


@pytest.mark.parametrize('resolution, beam, low, high', [(10, 0.75, 4, 104), (30, 1.2, 2, 50)])
def test_hulls_give_as_many_plots_as_their_size_in_cells(resolution, beam, low, high):
    for distance in (1000, 5000):
        for length, breadth in ((60, 12), (300, 45)):
            for aspect in (0, 90):
                loaded = scenario.build(
                    {
                        'duration_s': 60,
                        'radar': {
                            'range_resolution_m': resolution,
                            'beam_width_deg': beam,
                            'max_range_nm': 4,
                        },
                        'targets': [ship(distance, 45, 45 + aspect, length, breadth)],
                    },
                    'one',
                )
                counts = [len(scan.plots.time) for scan, _ in simulate(loaded, 1)]
                assert low - 2 <= min(counts) and low <= np.mean(counts) and max(counts) <= high


@pytest.mark.parametrize('bearing', [1.0, 90.0, 359.5])
def test_cells_lie_on_the_moving_hull_even_over_north(make_scenario, bearing):
    loaded = make_scenario(
        duration_s=200,
        radar=RADAR,
        own_ship={'course_deg': 40, 'speed_kn': 15},
        targets=[ship(1500, bearing, 70, 200, 32, 15 * KNOT)],
    )
    ends = set()
    for scan, _ in simulate(loaded, 3):
        middle = np.stack([loaded.truth_at(time).position[0] for time in scan.plots.time])
        forward, starboard = along_and_across(positions(scan) - middle, np.radians(70))
        assert np.abs(forward).max() < 100 + 35 and np.abs(starboard).max() < 16 + 35
        assert np.ptp(forward) > 120
        ends.add(
            (scan.plots.time < scan.start + 0.5 * PERIOD).any()
            and (scan.plots.time > scan.end - 0.5 * PERIOD).any()
        )
    assert ends == ({False} if bearing == 90 else ends | {True})


def test_near_side_is_lit_and_pulls_the_middle_of_the_cells_to_the_radar(make_scenario):
    loaded = make_scenario(duration_s=200, radar=RADAR, targets=[ship(1000, 90, 0, 200, 32, 3)])
    off = [truth.position[0] - positions(scan).mean(0) for scan, truth in simulate(loaded, 1)]
    pulled = np.mean(off, axis=0)[0]
    assert 4 < pulled < 16


def test_hull_lies_along_its_stated_heading_else_its_course(make_scenario):
    for heading, more in ((20, {}), (110, {'heading_deg': 110})):
        loaded = make_scenario(
            duration_s=100, radar=RADAR, targets=[ship(1500, 60, 20, 250, 32, 2, **more)]
        )
        offset = np.concatenate(
            [positions(scan) - truth.position[0] for scan, truth in simulate(loaded, 1)]
        )
        forward, starboard = along_and_across(offset, np.radians(heading))
        assert forward.std() > 2 * starboard.std()


def test_hulls_leave_the_plots_of_other_targets_alone(make_scenario):
    other = {'start': {'range_nm': 3, 'bearing_deg': 200}, 'course_deg': 10, 'speed_kn': 9}
    at_rest = {'start': {'range_nm': 1, 'bearing_deg': 100}, 'speed_kn': 0, 'length_m': 100}
    runs = []
    for hull in ({}, {'hull': {'beam_m': 20}}):
        loaded = make_scenario(duration_s=100, radar=RADAR, targets=[other, at_rest | hull])
        runs.append(
            np.concatenate(
                [scan.plots.range[scan.plots.range > 5000] for scan, _ in simulate(loaded, 4)]
            )
        )
    assert len(runs[0]) > 20 and np.array_equal(*runs)


def test_same_seed_gives_the_same_cells():
    first, second, other = (
        [scan.plots for scan, _ in simulate(scenario.load('hulls'), seed)][:9] for seed in (1, 1, 2)
    )
    assert all(np.array_equal(a.amplitude, b.amplitude) for a, b in zip(first, second))
    assert not np.array_equal(first[0].amplitude, other[0].amplitude)


@pytest.mark.parametrize(
    'change, text',
    [
        ({'length_m': None}, r'targets\[0\] has a hull, but no length_m'),
        ({'pd': 0.9}, r'targets\[0\] has pd beside hull'),
        ({'hull': {}}, r'targets\[0\].hull has no beam_m or beam_nm'),
        ({'hull': {'beam_m': 300}}, r'hull.beam_m is 300; it must be between 2 and 120'),
        ({'hull': {'beam': 20}}, r'must end in its unit; write beam_m'),
        ({'hull': {'beam_m': 20, 'snr_db': 99}}, r'snr_db is 99; it must be between 0 and 60'),
    ],
)
def test_wrong_hull_is_refused_with_its_place(make_scenario, change, text):
    target = {
        key: value
        for key, value in (ship(1000, 0, 0, 120, 20) | change).items()
        if value is not None
    }
    with pytest.raises(ValueError, match=text):
        make_scenario(radar=RADAR, targets=[target])


@pytest.mark.parametrize(
    'radar, text',
    [
        ({'sensor_errors': 'imo'}, "sensor_errors is 'imo' in a scenario with hulls"),
        ({'radial_speed_sigma_mps': 0.5}, 'radial_speed_sigma in a scenario with hulls'),
        (
            {'range_resolution_m': 0},
            'range_resolution is 0 in a scenario with hulls or land; it must be at least 1',
        ),
        ({'beam_width_deg': 0}, 'beam_width is 0'),
    ],
)
def test_hull_needs_a_radar_with_cells(make_scenario, radar, text):
    with pytest.raises(ValueError, match=text):
        make_scenario(radar=radar, targets=[ship(1000, 0, 0, 120, 20)])
