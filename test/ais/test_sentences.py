import json
import math

import numpy as np
import pytest
from pyais import encode_dict

from marine_tracker import m1371
from marine_tracker.ais import reports, sentences
from marine_tracker.ais.sentences import Sentences
from marine_tracker.geometry import KNOT

NOON = 1_710_072_000.0  # s of UTC, at a full minute
PLACE = {'lat': 53.2, 'lon': -4.6}


def lines(talker='AI', kind='VDM', channel='A', number=3, **fields):
    message = {'mmsi': 235087654, 'type': 1, **fields}
    return encode_dict(
        message, talker_id=talker, sentence_type=kind, radio_channel=channel, seq_id=number
    )


def heard(*taken, at=NOON, own=0):
    """The Sentences after these lines, a tenth of a second apart."""
    found = Sentences(own)
    for k, line in enumerate(taken):
        found.take(line, at + 0.1 * k)
    return found


def tagged(line, **fields):
    text = ','.join(f'{name}:{value}' for name, value in fields.items())
    return f'\\{text}*{sentences._checksum(text):02X}\\{line}'


def test_a_position_report_has_units_of_the_core():
    (line,) = lines(
        **PLACE, speed=12.3, course=271.5, heading=269, turn=-10.0, status=5, accuracy=1, second=57
    )
    report = heard(line, at=NOON + 59.2).reports()
    assert report.mmsi.tolist() == [235087654]
    assert (report.latitude[0], report.longitude[0]) == pytest.approx((53.2, -4.6), abs=1e-6)
    assert report.speed[0] == pytest.approx(12.3 * KNOT)
    assert np.degrees(report.course[0]) == pytest.approx(271.5)
    assert np.degrees(report.heading[0]) == pytest.approx(269)
    assert np.degrees(report.turn[0]) * 60 == pytest.approx(-10, rel=0.1)
    assert report.status[0] == m1371.MOORED
    assert report.accurate[0]
    assert report.timed[0] and report.time[0] == pytest.approx(NOON + 57.5)


def test_what_is_not_available_is_none_and_north_is_north():
    nothing = {'lat': 91, 'lon': 181, 'speed': 102.3, 'course': 360, 'heading': 511, 'turn': -128}
    report = heard(*lines(**nothing, status=15, second=60)).reports()
    for name in ('latitude', 'longitude', 'speed', 'course', 'heading', 'turn'):
        assert math.isnan(getattr(report, name)[0]), name
    assert report.status[0] == m1371.NO_STATUS and not report.timed[0]
    north = heard(*lines(**PLACE, speed=0, course=0, heading=0, turn=0, status=0)).reports()
    for name in ('speed', 'course', 'heading', 'turn', 'status'):
        assert getattr(north, name)[0] == 0, name
    only_direction = heard(*lines(**PLACE, turn=127)).reports()
    assert math.isnan(only_direction.turn[0])


@pytest.mark.parametrize(
    ('fields', 'kind', 'values'),
    [
        ({'type': 9, 'speed': 140, 'course': 33}, 9, {'speed': 140 * KNOT}),
        ({'type': 18, 'speed': 8.5, 'heading': 511}, 18, {'speed': 8.5 * KNOT}),
        ({'type': 19, 'speed': 3, 'shipname': 'PUFFIN', 'to_bow': 9, 'to_stern': 2}, 19, {}),
        ({'type': 21, 'mmsi': 992351001, 'name': 'SKERRIES W'}, 21, {'name': 'SKERRIES W'}),
        ({'type': 27, 'speed': 17, 'course': 204}, 27, {'speed': 17 * KNOT}),
        ({'type': 3, 'msg_type': 3, 'speed': 1.5}, 3, {'speed': 1.5 * KNOT}),
    ],
)
def test_every_type_that_tells_a_place_is_taken(fields, kind, values):
    report = heard(*lines(**PLACE, **fields)).reports()
    assert report.type.tolist() == [kind]
    assert report.latitude[0] == pytest.approx(53.2, abs=0.001)
    for name, value in values.items():
        assert getattr(report, name)[0] == pytest.approx(value) if name == 'speed' else value


def test_names_and_sizes_come_in_static_reports():
    size = {'to_bow': 110, 'to_stern': 32, 'to_port': 9, 'to_starboard': 14}
    five = lines(type=5, shipname='STENA BELLA', callsign='GXYZ', ship_type=60, **size)
    assert len(five) == 2
    a = lines(type=24, partno=0, shipname='TERN', mmsi=235011111)
    b = lines(type=24, partno=1, callsign='MABC2', ship_type=36, to_bow=4, mmsi=235011111)
    report = heard(*five, *a, *b).reports()
    assert report.name.tolist() == ['STENA BELLA', 'TERN', '']
    assert report.call_sign.tolist() == ['GXYZ', '', 'MABC2']
    assert report.ship_type.tolist() == [60, -1, 36]
    assert report.size[0].tolist() == [110, 32, 9, 14]
    assert np.isnan(report.size[1]).all()


def test_a_size_without_the_antenna_is_length_and_beam_only():
    report = heard(*lines(type=5, shipname='X', to_stern=88, to_starboard=15)).reports()
    assert np.array_equal(report.size[0], [np.nan, 88, np.nan, 15], equal_nan=True)


def test_parts_join_in_any_order_from_one_source_only():
    first, second = lines(type=5, shipname='FULMAR')
    assert heard(second, first).reports().name.tolist() == ['FULMAR']
    apart = Sentences()
    apart.take(first, NOON, 'north')
    apart.take(second, NOON, 'south')
    assert not len(apart.reports().mmsi)
    apart.take(second, NOON + 0.2, 'north')
    apart.take(first, NOON + 0.3, 'south')
    assert apart.reports().name.tolist() == ['FULMAR']
    assert +apart.outcome == {sentences.TAKEN: 2, sentences.TWICE: 2}


def test_ships_whose_second_parts_are_the_same_are_both_taken():
    one = lines(type=5, shipname='DUNLIN', mmsi=235066666)
    other = lines(type=5, shipname='DUNLIN', mmsi=235077777)
    assert one[1] == other[1]
    assert heard(*one, *other).reports().mmsi.tolist() == [235066666, 235077777]
    again = heard(one[0], one[0], one[1])
    assert again.outcome == {sentences.TAKEN: 2, sentences.TWICE: 1, sentences.WAITING: 0}


def test_a_part_of_another_message_completes_nothing():
    first, _ = lines(type=5, shipname='GANNET', channel='A')
    _, second = lines(type=5, shipname='RAZORBILL', mmsi=235022222, channel='B')
    assert not len(heard(first, second).reports().mmsi)
    late = Sentences()
    late.take(first, NOON)
    late.take(lines(type=5, shipname='GANNET')[1], NOON + 9)
    assert not len(late.reports().mmsi)
    assert late.outcome[sentences.ALONE] == 1
    again = Sentences()  # a new first part under the same number: what waited is given up
    again.take(first, NOON)
    whole = lines(type=5, shipname='KITTIWAKE', mmsi=235033333)
    for line in whole:
        again.take(line, NOON + 1)
    assert again.reports().name.tolist() == ['KITTIWAKE']
    assert again.outcome[sentences.ALONE] == 1


def test_what_two_receivers_hear_counts_once_and_what_is_said_again_counts():
    (line,) = lines(**PLACE, second=11)
    found = Sentences()
    found.take(line, NOON, 'mast')
    found.take(line, NOON + 1.5, 'bridge')
    assert found.outcome == {sentences.TAKEN: 1, sentences.TWICE: 1}
    found.take(line, NOON + 180)  # a moored ship says the same three minutes later
    assert found.outcome[sentences.TAKEN] == 2


@pytest.mark.parametrize(
    ('line', 'outcome'),
    [
        ('!AIVDM,1,1,,A,15N:wBP01gwf0wPJ@dVP2bN20<0w,0*00', sentences.CHECKSUM),
        ('!AIVDM,1,1,,A', sentences.UNKNOWN),
        ('AIVDM', sentences.UNKNOWN),
        ('', sentences.UNKNOWN),
        (b'\xff\xfe!AIVDM', sentences.NOT_TEXT),
        ('!' + 'A' * 2000, sentences.TOO_LONG),
        ('$GPRMC,120000,A,5312.0,N,00436.0,W,3.1,20.0,100324,,*1C', sentences.OTHER),
        ('{"class":"TPV"}', sentences.OTHER),
        ('{"class":', sentences.BAD_JSON),
        ('[1]', sentences.UNKNOWN),
        ('{"class":"AIS","type":8}', sentences.TYPE),
        ('\\c:17*00\\!AIVDM,1,1,,A,15N,0*00', sentences.TAG),
    ],
)
def test_what_cannot_be_taken_is_counted_by_name(line, outcome):
    found = heard(line)
    assert found.outcome == {outcome: 1}
    assert not len(found.reports().mmsi)


def framed(payload, fill=0):
    body = f'AIVDM,1,1,,A,{payload},{fill}'
    return f'!{body}*{sentences._checksum(body):02X}'


def test_payloads_that_are_too_short_or_of_no_use_are_counted():
    (line,) = lines(**PLACE)
    payload = line.split(',')[5]
    assert heard(framed(payload[:20])).outcome == {sentences.LENGTH: 1}
    assert heard(framed('')).outcome == {sentences.LENGTH: 1}
    (base,) = lines(type=4, **PLACE)
    assert heard(base).outcome == {sentences.TYPE: 1}


def test_impossible_places_are_refused_and_impossible_values_left_out_by_name():
    found = heard(*lines(lat=95.5, lon=3.0), *lines(mmsi=0, **PLACE))
    assert found.outcome == {reports.NO_PLACE: 1, reports.NO_IDENTITY: 1}
    found = heard(*lines(**PLACE, speed=102.2, course=360.4, heading=400))
    report = found.reports()
    assert math.isnan(report.speed[0] + report.course[0]) and math.isnan(report.heading[0])
    assert found.left_out == {'speeds': 1, 'courses': 1, 'headings': 1}
    found = heard(*lines(type=5, to_bow=511, to_stern=400))
    assert found.left_out == {'sizes': 1}


def test_own_ship_is_never_a_target_also_when_her_number_is_known_late():
    other = lines(**PLACE, mmsi=235044444)
    found = heard(*lines(**PLACE, mmsi=235000001), *other, *lines(kind='VDO', mmsi=235000001))
    assert found.own == 235000001
    assert found.reports().mmsi.tolist() == [235044444]
    found.take(lines(**PLACE, mmsi=235000001, second=33)[0], NOON + 30)
    assert found.outcome[sentences.OWN_AS_OTHER] == 1
    assert found.own_report().mmsi.tolist() == [235000001]


def test_an_own_report_with_the_number_of_another_is_refused():
    found = heard(*lines(kind='VDO', mmsi=235055555, **PLACE), own=235000001)
    assert found.outcome == {sentences.NOT_OWN: 1}
    assert not len(found.own_report().mmsi)


def test_a_recorded_line_has_its_own_time():
    found = Sentences()
    found.take(f'{NOON + 4.25} ' + lines(**PLACE, second=3)[0])
    assert found.reports().heard.tolist() == [NOON + 4.25]


def test_tag_blocks_tell_source_and_time():
    first, second = lines(type=5, shipname='SHAG')
    found = heard(
        tagged(first, s='r003669930', c=int(NOON - 3)), tagged(second, s='other', c=int(NOON))
    )
    assert not len(found.reports().mmsi)
    (line,) = lines(**PLACE)
    report = heard(tagged(line, c=int(1000 * (NOON - 7)))).reports()
    assert report.heard.tolist() == [NOON - 7]


@pytest.mark.parametrize('off', [-3 * 86400, 3 * 86400, 500])
def test_a_sender_whose_clock_is_far_off_is_taken_as_it_came(off):
    (line,), (next_,) = lines(**PLACE, second=60), lines(**PLACE, second=60, speed=7)
    found = heard(tagged(line, c=int(NOON + off)), next_)
    assert found.left_out == {sentences.CLOCK: 1}
    assert found.reports().heard == pytest.approx([NOON, NOON + 0.1])


def test_the_second_tells_how_late_a_report_is_but_not_beyond_reason():
    late, early, wrong = (heard(*lines(**PLACE, second=s), at=NOON + 8.0) for s in (1, 9, 30))
    assert late.reports().time[0] == pytest.approx(NOON + 1.5)
    assert early.reports().time[0] == pytest.approx(NOON + 8.0)
    report = wrong.reports()
    assert report.time[0] == NOON + 8.0 and not report.timed[0]
    assert wrong.left_out == {sentences.CLOCK: 1}


def test_gpsd_tells_the_same_scaled_or_not():
    scaled = {
        'class': 'AIS', 'type': 1, 'mmsi': 235087654, 'scaled': True, 'status': 0, 'turn': 'nan',
        'speed': 9.4, 'accuracy': True, 'lat': 53.2, 'lon': -4.6, 'course': 87.3, 'heading': 511,
        'second': 60,
    }  # fmt: skip
    raw = {
        **scaled, 'scaled': False, 'turn': -128, 'speed': 94, 'lat': 53.2 * 600_000,
        'lon': -4.6 * 600_000, 'course': 873,
    }  # fmt: skip
    one, other = (heard(json.dumps(line)).reports() for line in (scaled, raw))
    for report in (one, other):
        assert report.latitude[0] == pytest.approx(53.2)
        assert report.longitude[0] == pytest.approx(-4.6)
        assert report.speed[0] == pytest.approx(9.4 * KNOT)
        assert np.degrees(report.course[0]) == pytest.approx(87.3)
        assert math.isnan(report.heading[0]) and math.isnan(report.turn[0])


def fuzzed(random, whole):
    line = bytearray(whole[random.integers(len(whole))].encode())
    for _ in range(random.integers(1, 6)):
        place = random.integers(len(line)) if line else 0
        what = random.integers(5)
        if what == 0 and line:
            line[place] = random.integers(256)
        elif what == 1:
            del line[place : place + random.integers(1, 12)]
        elif what == 2:
            line[place:place] = bytes(random.integers(32, 127, 3, dtype=np.uint8))
        elif what == 3:
            line += line[place:]
        elif line.startswith(b'!') and b'*' in line:  # a wrong body under a right checksum
            body = line[1:].split(b'*')[0]
            line = bytearray(b'!%s*%02X' % (body, sentences._checksum(body.decode('latin-1'))))
    return bytes(line)


def check_fuzzed(count):
    random = np.random.default_rng(8)
    whole = [
        *lines(**PLACE),
        *lines(type=5, shipname='CHOUGH'),
        *lines(type=18, **PLACE),
        *lines(type=24, partno=1, callsign='AB'),
        *(tagged(one, c=1700000000) for one in lines(type=21, name='N BUOY')),
        json.dumps({'class': 'AIS', 'type': 18, 'mmsi': 2, 'lat': 1.0, 'lon': 2, 'speed': 3}),
        '12.5 ' + lines(type=27, **PLACE)[0],
    ]
    found = Sentences()
    for k in range(count):
        found.take(fuzzed(random, whole), NOON + 0.01 * k)
    assert found.lines == count
    assert all(value >= 0 for value in found.outcome.values())
    assert set(found.outcome) <= set(sentences.OUTCOMES)
    assert len(found.outcome) >= 8
    found.reports()


def test_fuzzed_sentences_are_all_counted_and_none_crashes():
    check_fuzzed(1000)


@pytest.mark.slow
def test_ten_thousand_fuzzed_sentences_are_all_counted():
    check_fuzzed(10_000)
