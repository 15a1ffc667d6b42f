import json
import re
import uuid
from decimal import Decimal

import numpy as np
import pynmea2
import pytest
from hypothesis import given
from hypothesis import strategies as st

from marine_tracker.arpa import nmea, nmea_fields, signalk
from marine_tracker.arpa.nmea import ACQUIRING, AUTOMATIC, LOST, MANUAL, TRACKING, Targets
from marine_tracker.geometry import KNOT, NAUTICAL_MILE

NOON = 1_700_049_600.0 + 0.25  # 2023-11-15 12:00:00.25 UTC
GOLDEN = (  # of real radars
    '$RATTM,01,0.438,018.6,T,0.00,180.0,T,0.438,0.0,N,TGT 01,Q,,180540.43,M*50',
    '$RATTM,01,0.438,018.9,T,0.99,103.5,T,0.438,0.0,N,TGT 01,T,,180600.47,M*57',
    '$RATTM,02,3.55,297.3,T,,,T,0.13,,N,,Q,,,M*02',
)


def targets(**columns):
    """Target 7, 2 NM off on 045, course 225 at 10 kn, with other columns as given."""
    given_ = {
        'number': 7,
        'status': TRACKING,
        'acquired': AUTOMATIC,
        'name': 'TT07',
        'range': 2 * NAUTICAL_MILE,
        'bearing': np.radians(45),
        'speed': 10 * KNOT,
        'course': np.radians(225),
        'cpa': 0.1 * NAUTICAL_MILE,
        'tcpa': 600.0,
        **columns,
    }
    count = max(np.size(value) for value in given_.values())
    return Targets(*(np.array(np.broadcast_to(given_[name], count)) for name in Targets._fields))


def read_ttm(text):
    """Targets, time and number of decimals of a TTM sentence, by pynmea2."""
    parsed = pynmea2.parse(text, check=True)

    def figure(value, unit):
        return np.nan if value is None else float(value) * unit

    at = parsed.timestamp
    return (
        targets(
            number=parsed.target_number,
            status=parsed.status,
            acquired=parsed.acquisition,
            name=parsed.name,
            range=figure(parsed.distance, NAUTICAL_MILE),
            bearing=figure(parsed.bearing, np.radians(1)),
            speed=figure(parsed.speed, KNOT),
            course=figure(parsed.cog, np.radians(1)),
            cpa=figure(parsed.dist_cpa, NAUTICAL_MILE),
            tcpa=figure(parsed.time_cpa, 60.0),
        ),
        (at.hour * 3600 + at.minute * 60 + at.second + 1e-6 * at.microsecond if at else np.nan),
        -parsed.distance.as_tuple().exponent,
    )


@pytest.mark.parametrize('text', GOLDEN)
def test_golden_sentences_are_read_and_written_again_to_the_letter(text):
    here, time, decimals = read_ttm(text)
    assert nmea.ttm(here, time, decimals=decimals) == [text]


def test_a_tracked_target_has_fifteen_fields():
    assert nmea.ttm(targets(), NOON) == [
        '$RATTM,07,2.000,045.0,T,10.00,225.0,T,0.100,10.0,N,TT07,T,,120000.25,A*34'
    ]


def test_a_target_being_acquired_has_neither_speed_nor_course_nor_tcpa():
    here = nmea.as_acquired(targets(status=[ACQUIRING, TRACKING], number=[1, 2], acquired=MANUAL))
    first, second = (line.split('*')[0].split(',') for line in nmea.ttm(here, NOON))
    assert [first[k] for k in (5, 6, 9)] == ['', '', ''] and first[12] == 'Q'
    assert [second[k] for k in (5, 6, 9)] == ['10.00', '225.0', '10.0'] and second[12] == 'T'
    assert len(first) == len(second) == 16


def test_a_lost_target_keeps_its_last_position():
    (text,) = nmea.ttm(targets(status=LOST), NOON)
    parsed = pynmea2.parse(text)
    assert (parsed.status, parsed.distance, parsed.bearing) == ('L', 2, 45)


def test_the_reference_target_is_marked():
    first, second = nmea.ttm(targets(number=[7, 8]), NOON, reference=8)
    assert [pynmea2.parse(text).reference for text in (first, second)] == ['', 'R']


def test_angles_and_times_that_round_up_to_the_full_circle_begin_again():
    (text,) = nmea.ttm(targets(bearing=np.radians(359.96), tcpa=-0.1), NOON + 43199.749)
    parsed = pynmea2.parse(text)
    assert ',000.0,T,' in text and ',0.0,N,' in text and parsed.timestamp.hour == 0
    assert nmea_fields.hours(NOON - 0.251) == '120000.00'
    assert nmea_fields.position(-54.9999999, 179.9999999) == ('5500.0000', 'S', '18000.0000', 'E')
    assert nmea_fields.position(10 - 1e-9, -9.5) == ('1000.0000', 'N', '00930.0000', 'W')


def test_a_range_of_nothing_is_not_written_as_the_zero_that_means_switched_off():
    (text,) = nmea.ttm(targets(range=0.0), NOON)
    assert text.startswith('$RATTM,07,0.001,')


@pytest.mark.parametrize(
    ('columns', 'named'),
    [
        ({'number': 0}, 'number of a target is 0; it must be 1 to 999'),
        ({'number': 1000}, 'number of a target is 1000'),
        ({'status': 'X'}, "status of a target is 'X'; it must be L, Q, T"),
        ({'acquired': 'auto'}, "acquired of a target is 'auto'; it must be A, M, R"),
    ],
)
def test_what_ttm_has_no_code_for_is_refused(columns, named):
    with pytest.raises(ValueError, match=re.escape(named)):
        nmea.ttm(targets(**columns), NOON)


def test_names_cannot_break_a_sentence_and_leave_it_its_length():
    names = ['A,B*C$D', 'x' * 50, 'Ærø\r\n', '', 'TT104']
    read = [
        pynmea2.parse(text, check=True)
        for text in nmea.ttm(targets(number=[1, 2, 3, 4, 5], name=names), NOON)
    ]
    assert [parsed.name for parsed in read] == ['ABCD', 'x' * 11, 'r', '', 'TT104']
    assert all(len(str(parsed)) <= 80 for parsed in read)


def valid(text, kind, fields):
    """Whether the checksum, the number of fields and the length are as they must be."""
    parsed = pynmea2.parse(text, check=True)
    return (
        parsed.sentence_type == kind
        and len(parsed.data) == fields
        and text.isascii()
        and str(parsed) == text
        and len(text) + 2 <= 82
        and len(parsed.data[0]) > 0
    )


FIELDS = re.compile(  # of a TTM, with what range each may have
    r'\$RATTM,(?!00)\d\d,\d{1,3}\.\d{3},[0-3]\d\d\.\d,T,(\d{1,3}\.\d\d)?,([0-3]\d\d\.\d)?,T,'
    r'(\d{1,3}\.\d{3})?,(-?\d{1,3}\.\d)?,N,[ -~]{0,20},[LQT],R?,(\d{6}\.\d\d)?,[AMR]?\*[0-9A-F]{2}'
)


def fuzz(rng, count):
    """Figures of all sizes: reasonable, nan, infinite, huge, tiny, negative."""

    def figures(usual):
        odd = rng.choice(
            [
                np.nan,
                np.inf,
                -np.inf,
                1e300,
                -1e300,
                1e-300,
                -0.0,
                0.0,
                -1.0,
                12.56,
                np.radians(359.96),
                999.9995 * NAUTICAL_MILE,
                999.995 * KNOT,
            ],
            count,
        )
        return np.where(rng.random(count) < 0.3, odd, rng.normal(0, usual, count))

    letters = np.array(list('TGX 01,*$!\\^~\r\n\tÆ\x00'))
    names = [''.join(rng.choice(letters, rng.integers(0, 30))) for _ in range(count)]
    return Targets(
        rng.integers(1, 100, count),
        rng.choice(['L', 'Q', 'T'], count),
        rng.choice(['A', 'M', 'R', ''], count),
        np.array(names),
        np.abs(figures(2e4)) * rng.choice([1.0, 1.0, -1.0], count),
        figures(4.0),
        figures(10.0),
        figures(4.0),
        figures(1e4),
        figures(3e3),
    )


def check_fuzz(count):
    rng = np.random.default_rng(4)
    here = fuzz(rng, count)
    told = nmea.ttm(nmea.as_acquired(here), NOON)
    assert 0.3 * count < len(told) < 0.9 * count  # the rest has no range or bearing
    for text in told:
        assert valid(text, 'TTM', 15) and FIELDS.fullmatch(text), text
        parsed = pynmea2.parse(text)
        figures = (
            parsed.distance,
            parsed.bearing,
            parsed.speed,
            parsed.cog,
            parsed.dist_cpa,
            parsed.time_cpa,
        )
        assert all(figure is None or isinstance(figure, Decimal) for figure in figures)
        assert 0 <= parsed.bearing < 360 and 0 <= (parsed.cog or 0) < 360 and parsed.distance > 0
        assert parsed.status != 'Q' or (figures[2], figures[3], figures[5]) == (None, None, None)
    latitude, longitude = rng.normal(0, 60, count), rng.normal(0, 200, count)
    latitude[::7], longitude[::11] = np.nan, np.inf
    told = nmea.tll(here, latitude, longitude, NOON)
    assert 0.4 * count < len(told) < 0.9 * count
    for text in told:
        assert valid(text, 'TLL', 9), text
        parsed = pynmea2.parse(text)
        assert abs(parsed.latitude) <= 90 and abs(parsed.longitude) <= 180


def test_random_targets_never_give_an_invalid_sentence():
    check_fuzz(5_000)


@pytest.mark.slow
def test_a_hundred_thousand_random_targets_never_give_an_invalid_sentence():
    check_fuzz(100_000)


@given(*[st.floats() for _ in range(6)])
def test_no_own_ship_gives_an_invalid_sentence(latitude, longitude, speed, course, heading, time):
    own = nmea.OwnShipData(latitude, longitude, speed, course, heading)
    for text, kind, fields in (
        (nmea.rmc(own, time), 'RMC', 12),
        (nmea.osd(own), 'OSD', 9),
        (nmea.hdt(own), 'HDT', 2),
    ):
        parsed = pynmea2.parse(text, check=True)
        assert (parsed.sentence_type, len(parsed.data)) == (kind, fields)
        assert 'nan' not in text and 'inf' not in text and len(text) <= 80


def test_tll_gives_the_place_to_a_few_decimetres():
    (text,) = nmea.tll(targets(), [54.123456], [-10.987654], NOON)
    assert text.startswith('$RATLL,07,5407.4074,N,01059.2592,W,TT07,120000.25,T,*')
    parsed = pynmea2.parse(text, check=True)
    assert parsed.latitude == pytest.approx(54.123456, abs=1e-6)
    assert parsed.longitude == pytest.approx(-10.987654, abs=1e-6)


@pytest.mark.parametrize(
    ('longitude', 'said'),
    [
        (179.9999991, '17959.9999,E'),
        (179.99999999, '18000.0000,E'),
        (180.0, '18000.0000,W'),
        (-180.0, '18000.0000,W'),
        (180.0257, '17958.4580,W'),
        (-179.5, '17930.0000,W'),
    ],
)
def test_a_longitude_beyond_180_is_told_as_the_same_one_west(longitude, said):
    assert f',{said},' in nmea.tll(targets(), [-17.0], [longitude], NOON)[0]
    assert f',{said},' in nmea.rmc(nmea.OwnShipData(-17.0, longitude), NOON)
    told = delta((-17.0, longitude))[1]['navigation.position']['longitude']
    assert -180 <= told < 180
    assert (told - longitude) % 360 == pytest.approx(0, abs=1e-9)


def test_own_ship_sentences():
    own = nmea.OwnShipData(54.5, 10.25, 10 * KNOT, np.radians(90), np.radians(88.5))
    assert nmea.rmc(own, NOON).startswith(
        '$IIRMC,120000.25,A,5430.0000,N,01015.0000,E,10.00,090.0,151123,,,A*'
    )
    assert nmea.hdt(own) == '$IIHDT,088.5,T*27'
    assert nmea.osd(own).startswith('$RAOSD,088.5,A,090.0,P,10.00,P,,,N*')
    assert nmea.osd(own._replace(heading=np.nan)).startswith('$RAOSD,,V,090.0,P,')
    parsed = pynmea2.parse(nmea.rmc(own, NOON), check=True)
    assert parsed.is_valid and parsed.latitude == 54.5


def test_without_a_position_rmc_is_void():
    assert nmea.rmc(nmea.OwnShipData(), NOON).startswith('$IIRMC,120000.25,V,,,,,,,151123,,,N*')


def test_rsd_has_thirteen_fields_and_is_parsed_as_well():
    text = nmea.rsd(
        6 * NAUTICAL_MILE,
        nmea.HEAD_UP,
        cursor=(1852.0, np.radians(30)),
        markers=[(926.0, np.radians(180))],
    )
    assert text.startswith('$RARSD,,,0.500,180.0,,,,,1.000,030.0,6.000,N,H*')
    parsed = pynmea2.parse(text, check=True)
    assert (parsed.range_scale, parsed.rotation, len(parsed.data)) == ('6.000', 'H', 13)
    with pytest.raises(ValueError, match='3 pairs of VRM and EBL; RSD takes 2'):
        nmea.rsd(1.0, markers=[(1.0, 1.0)] * 3)


@pytest.mark.parametrize('talker', ['ra', 'RAD', '', 'R,'])
def test_a_talker_is_two_capital_letters(talker):
    with pytest.raises(ValueError, match='talker'):
        nmea.hdt(nmea.OwnShipData(), talker)


RADAR = uuid.UUID(int=7)


def delta(place=(54.5, 10.25), **columns):
    (text,) = signalk.deltas(
        targets(**columns), [signalk.context(RADAR, 107)], [place[0]], [place[1]], NOON
    )
    said = json.loads(text)
    (update,) = said['updates']
    assert update['timestamp'] == '2023-11-15T12:00:00.250Z'
    return said['context'], {entry['path']: entry['value'] for entry in update['values']}


def test_a_signalk_delta_has_a_context_of_its_own_and_si_units():
    context, values = delta()
    assert re.fullmatch(r'vessels\.urn:mrn:signalk:uuid:[0-9a-f-]{36}', context)
    assert context == signalk.context(RADAR, 107) != signalk.context(RADAR, 108)
    assert values[''] == {'name': 'TT07'}
    assert values['navigation.position'] == {'latitude': 54.5, 'longitude': 10.25}
    assert values['navigation.courseOverGroundTrue'] == pytest.approx(np.radians(225))
    assert values['navigation.speedOverGround'] == pytest.approx(5.1444, abs=1e-3)
    assert values['navigation.closestApproach'] == pytest.approx(
        {'distance': 185.2, 'timeTo': 600.0}
    )


def test_what_is_not_known_is_not_in_the_delta():
    _, values = delta((np.nan, np.nan), speed=np.nan, course=np.inf, cpa=np.nan)
    assert set(values) == {''}
    assert 'navigation.position' not in delta((91.0, 10.0))[1]


def test_a_lost_target_is_taken_back_from_signalk():
    _, values = delta(status=LOST)
    assert values.pop('') == {'name': 'TT07'}
    assert len(values) == 4 and set(values.values()) == {None}


@pytest.mark.parametrize(
    ('state', 'told', 'method'),
    [
        ('active unacknowledged', 'alarm', ['visual', 'sound']),
        ('rectified unacknowledged', 'alarm', ['visual', 'sound']),
        ('active acknowledged', 'alarm', ['visual']),
        ('normal', 'normal', []),
    ],
)
def test_an_alert_is_a_notification_of_own_ship(state, told, method):
    alert = signalk.Alert('TT31: new target in bow & quay', 'TT31 in guard zone', 'alarm', state)
    (text,) = signalk.notifications([alert], 'radar_1', NOON)
    said = json.loads(text)
    assert said['context'] == 'vessels.self'
    (entry,) = said['updates'][0]['values']
    assert entry['path'] == 'notifications.radar.radar_1.TT31_new_target_in_bow_quay'
    assert entry['value'] == {'state': told, 'method': method, 'message': 'TT31 in guard zone'}
