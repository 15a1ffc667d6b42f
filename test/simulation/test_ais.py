import numpy as np
import pytest
from pyproj import Geod

from marine_tracker.geodesy import LocalFrame
from marine_tracker.geometry import KNOT
from marine_tracker.simulation.radar import simulate

FRAME = LocalFrame(55.0, 7.0)


@pytest.fixture
def ais_file(tmp_path):
    """Write an AIS file of (vessel, times s, north m, east m) and return its name."""

    def make(*vessels, name='traffic.csv', header='time_s,vessel,lat_deg,lon_deg,sog_kn,length_m'):
        lines = [header]
        for vessel, times, north, east in vessels:
            lines += [
                f'{t:g},{vessel},{latitude:.9f},{longitude:.9f},9,<NA>'
                for t, latitude, longitude in zip(
                    times, *FRAME.to_geodetic(np.stack([east, north], -1)), strict=True
                )
            ]
        (tmp_path / name).write_text('\n'.join(lines) + '\n')
        return name

    return make


def northbound(vessel, times, speed=5.0, east=0.0):
    times = np.asarray(times, dtype=float)
    return vessel, times, speed * times, np.full(len(times), east)


def test_steady_reports_give_a_steady_ship_in_the_frame_of_the_own_vessel(ais_file, make_scenario):
    file = ais_file(
        northbound('own', range(0, 610, 10)), northbound(7, range(0, 610, 9), 8.0, 2000.0)
    )
    loaded = make_scenario(ais={'file': file}, own_ship={'vessel': 'own'})
    assert loaded.fleet.names == ('AIS 7',)
    assert loaded.own_ship_at([0, 300]).position == pytest.approx(
        np.array([[0, 0], [0, 1500]]), abs=1e-2
    )
    truth = loaded.truth_at(333.0)
    assert truth.position[0] == pytest.approx([2000, 333 * 8], abs=1e-2)
    assert truth.velocity[0] == pytest.approx([0, 8], abs=1e-4)


@pytest.mark.parametrize('start', [(54.0, 179.995), (-16.5, -179.996), (79.0, 179.98)])
def test_ships_cross_the_date_line_and_go_on(tmp_path, make_scenario, start):
    """Two at 12 m/s along geodesics, one of which reports twice each time, 30 m either side."""
    earth, times = Geod(ellps='WGS84'), np.arange(0.0, 310, 10)
    course = 90.0 if start[1] > 0 else 270.0
    lines = ['time_s,vessel,lat_deg,lon_deg']
    for vessel, ahead, asides in (('own', 0.0, [0.0]), ('twice', 3000.0, [-30.0, 30.0])):
        for time in times:
            for aside in asides:
                lon, lat, _ = earth.fwd(*start[::-1], course, ahead + 12 * time + aside)
                lines.append(f'{time:g},{vessel},{lat:.9f},{lon:.9f}')
    (tmp_path / 'line.csv').write_text('\n'.join(lines) + '\n')
    loaded = make_scenario(duration_s=300, ais={'file': 'line.csv'}, own_ship={'vessel': 'own'})
    along = np.array([np.sin(np.radians(course)), 0.0])
    for time in (5.0, 150.0, 295.0):
        truth = loaded.truth_at(time)
        assert loaded.own_ship_at(time).position[0] == pytest.approx(12 * time * along, abs=0.1)
        assert truth.position[0] == pytest.approx((3000 + 12 * time) * along, abs=0.1)
        assert truth.velocity[0] == pytest.approx(12 * along, abs=0.01)


def test_whole_second_time_stamps_do_not_shake_the_ship(ais_file, make_scenario):
    rng = np.random.default_rng(2)
    true = np.arange(0, 620, 8) + rng.uniform(-0.5, 0.5, 78)
    file = ais_file((1, np.round(true).clip(0), 7.0 * true, np.zeros(78)))
    loaded = make_scenario(ais={'file': file}, own_ship={'start': {'lat_deg': 55, 'lon_deg': 7}})
    times = np.arange(30.0, 570.0, 5.0)
    truths = [loaded.truth_at(t) for t in times]
    speed = np.array([t.velocity[0, 1] for t in truths])
    assert np.abs(speed - 7).max() < 0.35  # 3.5 m in 8 s would shake it by .6 m/s
    assert np.abs([t.position[0, 1] for t in truths] - 7 * times).max() < 4


def test_velocity_is_the_derivative_of_position(ais_file, make_scenario):
    times = np.arange(0, 610, 10.0)
    file = ais_file((1, times, 900 * np.sin(times / 120), 900 * np.cos(times / 120)))
    loaded = make_scenario(ais={'file': file}, own_ship={'start': {'lat_deg': 55, 'lon_deg': 7}})
    for time in np.arange(3.3, 590, 7.7):
        before, after = (loaded.truth_at(time + h).position[0] for h in (-1e-3, 1e-3))
        assert (after - before) / 2e-3 == pytest.approx(loaded.truth_at(time).velocity[0], abs=1e-5)
        assert loaded.truth_at(time).position[0] == pytest.approx(
            [900 * np.cos(time / 120), 900 * np.sin(time / 120)], abs=20
        )


def test_vessel_is_there_from_first_to_last_report_and_not_in_long_gaps(ais_file, make_scenario):
    times = [50, 60, 70, 80, 90, 100, 300, 310, 320, 330, 340, 350]
    file = ais_file(northbound(1, times), northbound(2, range(0, 610, 10), east=900))
    loaded = make_scenario(
        ais={'file': file, 'max_gap_s': 60, 'vessels': [1]},
        own_ship={'start': {'lat_deg': 55, 'lon_deg': 6.9}},
    )
    there = {t: len(loaded.truth_at(t).target) for t in (0, 49, 51, 99, 101, 299, 301, 349, 351)}
    assert [t for t, count in there.items() if count] == [51, 99, 301, 349]
    for scan, truth in simulate(loaded, 1):
        if not len(truth.target):
            assert not len(scan.plots.time)


def test_start_moves_the_scenario_within_the_file(ais_file, make_scenario):
    file = ais_file(northbound('a', range(0, 3000, 10)), northbound('b', range(0, 900, 10)))
    loaded = make_scenario(
        ais={'file': file, 'start_s': 1200}, own_ship={'start': {'lat_deg': 55, 'lon_deg': 7}}
    )
    assert loaded.fleet.names == ('AIS a',)
    assert loaded.truth_at(0).position[0, 1] == pytest.approx(6000, abs=0.01)


def test_scripted_targets_sail_among_ais_vessels(ais_file, make_scenario):
    file = ais_file(northbound(1, range(0, 610, 10)))
    loaded = make_scenario(
        ais={'file': file},
        own_ship={'start': {'lat_deg': 55, 'lon_deg': 7.1}},
        targets=[{'start': {'range_m': 900, 'bearing_deg': 9}, 'course_deg': 3, 'speed_kn': 9}],
    )
    assert loaded.fleet.names == ('target 1', 'AIS 1')


@pytest.mark.parametrize(
    'change, text',
    [
        ({'own_ship': {'vessel': 9}}, 'own_ship.vessel is 9; the AIS file has no such vessel'),
        ({'own_ship': {'vessel': 2}}, 'own_ship.vessel 2 has no reports from 200 s to 600 s'),
        ({'own_ship': {'vessel': 1, 'speed_kn': 4}}, 'it must be the only key of own_ship'),
        ({'ais': {'file': 'traffic.csv', 'vessels': [1, 5]}}, 'ais.vessels names 5'),
        (
            {'ais': {'file': 'traffic.csv', 'start_s': 9000}},
            'has no vessel between 9000 s and 9600 s',
        ),
        ({'ais': {'file': 'traffic.csv', 'max_gap_min': 2}}, 'ais.max_gap_min is not known'),
    ],
)
def test_wrong_use_of_a_file_is_refused(ais_file, make_scenario, change, text):
    ais_file(northbound(1, range(0, 610, 10)), northbound(2, range(0, 210, 10)))
    with pytest.raises(ValueError) as refused:
        make_scenario(**{'ais': {'file': 'traffic.csv'}, **change})
    assert text in str(refused.value)


@pytest.mark.parametrize(
    'text, message',
    [
        ('time_s,vessel,lat_deg\n', 'has no column lon_deg'),
        ('', 'has no column time_s'),
        (
            'time_s,vessel,lat_deg,lon_deg\n0,1,55,7\n1,1,north,7\n',
            "line 3: lat_deg is 'north'; it must be a number",
        ),
        ('time_s,vessel,lat_deg,lon_deg\n0,1,155,7\n', 'line 2: no place on Earth'),
        ('time_s,vessel,lat_deg,lon_deg\n0,1,55\n', 'line 2: lon_deg is None'),
        (
            'time_s,vessel,lat_deg,lon_deg\n0,1,55,7\n10,1,55.1,7\n',
            'vessel 1 moves 11132 m in 10 s',
        ),
    ],
)
def test_wrong_files_are_refused_by_line(tmp_path, make_scenario, text, message):
    (tmp_path / 'wrong.csv').write_text(text)
    with pytest.raises(ValueError) as refused:
        make_scenario(ais={'file': 'wrong.csv'})
    assert message in str(refused.value)


def test_recorded_north_sea_traffic_becomes_plausible_ships(recordings, make_scenario):
    file = recordings / 'ais_north_sea' / 'ais.csv'
    loaded = make_scenario(duration_s=3500, ais={'file': str(file)}, own_ship={'vessel': 1})
    assert len(loaded.fleet.names) == 59
    slow, previous, accelerations = 0, {}, []
    for time in np.arange(0.0, 3500.0, 10.0):
        truth = loaded.truth_at(time)
        assert np.hypot(*truth.velocity.T).max() < 45 * KNOT
        for target, velocity in zip(truth.target, truth.velocity, strict=True):
            if target in previous:
                accelerations.append(np.hypot(*(velocity - previous[target])) / 10)
        previous = dict(zip(truth.target, truth.velocity, strict=True))
        slow += len(truth.target)
    assert slow > 0.8 * 59 * 350
    assert np.median(accelerations) < 0.02
    assert np.quantile(accelerations, 0.99) < 0.3
    scan, _ = next(simulate(loaded, 1))
    assert len(scan.own_ship.time) == 4
