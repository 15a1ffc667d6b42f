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
        ('time_s,vessel,lat_deg\n', 'has no column lon_deg; it has time_s, vessel, lat_deg'),
        ('', 'wrong.csv is empty; its first line must name the columns'),
        ('time_s,vessel,lat_deg,lon_deg\n', 'has no vessel between 0 s and 600 s'),
        (
            'time_s,vessel,lat_deg,lon_deg\n0,1,55,7\nx,1,55,7\n9,1,55\n12,,55,7\n8,1,91,181\n',
            'rows left out: 1 without a time that is understood, 1 with too few or too many cells, '
            '1 without a vessel, 1 without a place on Earth',
        ),
        (
            'time_s,vessel,lat_deg,lon_deg\n1.5e9,1,55,7\n1500000090,1,55,7\n',
            'its times are 1500000000 s to 1500000090 s',
        ),
    ],
)
def test_files_without_a_usable_vessel_are_refused(tmp_path, make_scenario, text, message):
    (tmp_path / 'wrong.csv').write_text(text)
    with pytest.raises(ValueError) as refused:
        make_scenario(ais={'file': 'wrong.csv'})
    assert message in str(refused.value) and '\n' not in str(refused.value)


ABOUT = {'own_ship': {'start': {'lat_deg': 55, 'lon_deg': 7}}}


def spoil(tmp_path, *lines, name='traffic.csv'):
    with open(tmp_path / name, 'a') as file:
        file.writelines(f'{line}\n' for line in lines)


def test_rows_that_cannot_be_used_are_left_out_and_told(tmp_path, ais_file, make_scenario):
    file = ais_file(northbound(4, range(0, 610, 10)))
    clean = make_scenario(ais={'file': file}, **ABOUT)
    assert clean.fleet.remarks == ()
    spoil(
        tmp_path,
        '35,4,91,181,,',  # not available
        '45,4,55.001,-181,,',
        '55,4,north,7,,',
        '65,4,nan,7,,',
        'noon,4,55,7,,',
        '75,4,55',
        '85,4,55.3,7,,',  # 33 km off
        '125,4,55.3,7,,',
        '90000,8,91,181,,',  # another vessel, another time
    )
    loaded = make_scenario(ais={'file': file}, **ABOUT)
    (remark,) = loaded.fleet.remarks
    for part in (
        'traffic.csv',
        '5 without a place on Earth',
        '1 without a time',
        '1 with too few',
        '2 that jump',
    ):
        assert part in remark
    for time in (0.0, 85.0, 333.0):
        for one, other in zip(loaded.truth_at(time), clean.truth_at(time), strict=True):
            np.testing.assert_array_equal(one, other)


def test_a_first_report_that_is_wrong_does_not_outweigh_the_rest(tmp_path, ais_file, make_scenario):
    file = ais_file(northbound(4, range(10, 610, 10)))
    spoil(tmp_path, '0,4,40.0,-30.0,,')
    loaded = make_scenario(ais={'file': file}, **ABOUT)
    assert '1 that jump' in loaded.fleet.remarks[0]
    assert loaded.truth_at(300.0).position[0, 1] == pytest.approx(1500, abs=5)


def test_of_one_name_in_two_ports_the_ship_with_more_reports_counts(
    tmp_path, ais_file, make_scenario
):
    other = ('4', range(5, 605, 20), *np.full((2, 30), 9e5))
    file = ais_file(northbound(4, range(0, 610, 10)), other)
    loaded = make_scenario(ais={'file': file}, **ABOUT)
    assert '30 that jump' in loaded.fleet.remarks[0]
    assert np.hypot(*loaded.truth_at(300.0).position[0]) < 2000


@pytest.mark.parametrize('west', [False, True])
def test_a_ship_goes_on_across_180_degrees(tmp_path, make_scenario, west):
    lines = ['time_s,vessel,lat_deg,lon_deg']
    for time in range(0, 620, 10):
        longitude = 179.997 + time * 1e-5 if not west else -179.997 - time * 1e-5
        lines.append(f'{time},7,-17.5,{(longitude + 180) % 360 - 180:.6f}')
        lines.append(f'{time},8,-17.5,{(longitude + 180.02) % 360 - 180:.6f}')
    (tmp_path / 'fiji.csv').write_text('\n'.join(lines))
    loaded = make_scenario(ais={'file': 'fiji.csv', 'vessels': [8]}, own_ship={'vessel': 7})
    own, target = loaded.own_ship_at([50.0, 590.0]), loaded.truth_at(590.0)
    per_degree = 106_200  # m, at 17.5 degrees
    going = own.position[1] - own.position[0]
    assert going == pytest.approx([540e-5 * per_degree * (-1 if west else 1), 0], abs=5)
    assert target.position[0] - own.position[1] == pytest.approx([0.02 * per_degree, 0], abs=8)
    assert loaded.fleet.remarks == ()


PUBLISHED = {
    'MarineCadastre to 2024': (
        'MMSI,BaseDateTime,LAT,LON,SOG,COG,Heading,VesselName,IMO,CallSign,VesselType,Status,'
        'Length,Width,Draft,Cargo,TransceiverClass',
        '{mmsi},{date}T{clock},{lat},{lon},9.7,0.1,511.0,"A, B",IMO1,X,70,0,182,30,7.6,70,A',
    ),
    'MarineCadastre from 2025': (
        'mmsi,base_date_time,longitude,latitude,sog,cog,heading,vessel_name,imo,call_sign,'
        'vessel_type,status,length,width,draft,cargo,transceiver',
        '{mmsi},{date} {clock},{lon},{lat},9.7,0.1,511,NAME,,,70,,182,30,,,A',
    ),
    'Danish Maritime Authority': (
        '# Timestamp,Type of mobile,MMSI,Latitude,Longitude,Navigational status,ROT,SOG,COG,'
        'Heading,IMO,Callsign,Name,Ship type,Cargo type,Width,Length,Type of position fixing '
        'device,Draught,Destination,ETA,Data source type,A,B,C,D',
        '{danish} {clock},Class A,{mmsi},{lat},{lon},Under way using engine,,9.7,0.1,,Unknown,'
        'Unknown,S\xd8LYST,Cargo,,30,182,GPS,,,,AIS,,,,',
    ),
    'Solent': (
        'Time,MMSI,Latitude_degrees,Longitude_degrees,COG_degrees,SOG_knots',
        '{date} {clock}.000,{mmsi},{lat},{lon},0.1,9.7',
    ),
    'ISO times in UTC': ('time_s,vessel,lat_deg,lon_deg', '{date}T{clock}Z,{mmsi},{lat},{lon}'),
    'ISO times in a zone': (
        'time_s,vessel,lat_deg,lon_deg',
        '{date}T{clock}+00:00,{mmsi},{lat},{lon}',
    ),
    'Unix time': ('time_s,vessel,lat_deg,lon_deg', '{unix},{mmsi},{lat},{lon}'),
}


@pytest.mark.parametrize('kind', PUBLISHED)
@pytest.mark.parametrize('encoding', ['utf-8-sig', 'latin-1', 'utf-16'])
def test_files_are_read_as_they_are_published(tmp_path, make_scenario, kind, encoding):
    header, form = PUBLISHED[kind]
    begin = 1583064000  # 2020-03-01 12:00:00 UTC
    lines = [header]
    for second in range(0, 700, 10):
        clock = f'12:{second // 60:02d}:{second % 60:02d}'
        for mmsi, lon in ((219000111, 7.0), ('002190048', 7.02)):
            lines.append(
                form.format(
                    mmsi=mmsi,
                    date='2020-03-01',
                    danish='01/03/2020',
                    clock=clock,
                    unix=begin + second,
                    lat=f'{55 + 5 * second / 111_339:.8f}',
                    lon=lon,
                )
            )
    (tmp_path / 'day.csv').write_bytes('\r\n'.join(lines).encode(encoding))
    loaded = make_scenario(
        ais={'file': 'day.csv', 'start_s': begin + 60, 'vessels': [2190048]},
        own_ship={'vessel': 219000111},
    )
    assert loaded.fleet.remarks == () and loaded.fleet.names == ('AIS 002190048',)
    assert loaded.own_ship_at([100.0]).velocity[0] == pytest.approx([0, 5], abs=0.05)
    assert loaded.truth_at(100.0).position[0, 0] == pytest.approx(0.02 * 63_994, rel=0.01)
    if 'ength' in header:
        assert loaded.fleet.length[0] == 182
    if kind != 'Unix time':  # dates begin at the first report where no start is stated
        assert len(make_scenario(ais={'file': 'day.csv'}, **ABOUT).truth_at(0.0).target) == 2


def test_blanks_around_names_and_cells_are_no_part_of_them(tmp_path, ais_file, make_scenario):
    file = ais_file(northbound(4, range(0, 610, 10)))
    clean = make_scenario(ais={'file': file}, **ABOUT)
    text = (tmp_path / file).read_text().replace(',', ' ,\t')
    (tmp_path / file).write_text(text + '\n\n')
    loaded = make_scenario(ais={'file': file}, **ABOUT)
    np.testing.assert_array_equal(loaded.truth_at(99.0).position, clean.truth_at(99.0).position)


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
