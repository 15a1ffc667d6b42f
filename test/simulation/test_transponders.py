import numpy as np
import pytest

from marine_tracker import m1371
from marine_tracker.ais.sentences import Sentences
from marine_tracker.geometry import KNOT
from marine_tracker.simulation import ais_sentences, scenario, transponders
from marine_tracker.types import take

SEND = {'share': 1.0, 'latency_s': 0.0, 'position_sigma_m': 0.0, 'heading_sigma_deg': 0.0}
EPOCH = 1_690_000_020.0


def built(targets, send=None, duration=600, **top):
    values = {
        'duration_s': duration,
        'origin': {'lat_deg': -33.5, 'lon_deg': 18.2},
        'ais': {'send': {**SEND, **(send or {})}},
        'targets': targets,
        **top,
    }
    return scenario.build(values, 'sends')


def target(speed=12.0, **more):
    return {
        'name': 'One',
        'start': {'north_m': 2000, 'east_m': -500},
        'course_deg': 90,
        'speed_kn': speed,
        **more,
    }


def heard(of, seed=3):
    fleet = of.fleet
    parts = list(transponders.transmit(fleet.ais, fleet.paths, fleet.length, of.duration, seed))
    return transponders.Sent(*(np.concatenate(column) for column in zip(*parts)))


@pytest.mark.parametrize(
    ('speed', 'kind', 'interval'),
    [(10, 'a', 10), (17, 'a', 6), (30, 'a', 2), (10, 'b', 30), (1, 'b', 180)],
)
def test_reports_come_at_the_intervals_of_class_and_speed(speed, kind, interval):
    sent = heard(built([target(speed, ais={'class': kind})], duration=1800))
    times = sent.time[~sent.static]
    assert np.diff(times).mean() == pytest.approx(interval, rel=0.06)


def test_a_turning_ship_reports_more_often():
    legs = [{'turn': {'angle_deg': 350, 'rate_deg_per_s': 0.7}}]
    sent = heard(built([target(10, ais={'class': 'a'}, legs=legs)]))
    assert np.diff(sent.time[(sent.time > 20) & (sent.time < 450)]).mean() < 4
    assert np.degrees(np.median(sent.turn[(sent.time > 60) & (sent.time < 400)])) == pytest.approx(
        0.7, abs=0.1
    )


def test_shares_classes_and_dropouts_are_as_asked_for():
    many = [target(12, name=f'n{k}') for k in range(40)]
    sent = heard(built(many, {'share': 0.7, 'class_b': 0.25}))
    senders, first = np.unique(sent.ship, return_index=True)
    assert len(senders) == 28
    assert (sent.kind[first] == m1371.CLASS_B).sum() == pytest.approx(7, abs=3)
    whole, half = heard(built(many)), heard(built(many, {'dropout': 0.5}))
    assert len(half.time) == pytest.approx(0.5 * len(whole.time), rel=0.1)


def test_late_reports_are_of_the_moment_they_tell():
    sent = heard(built([target(20, ais={'class': 'a'})], {'latency_s': 8.0}))
    late = sent.heard - sent.time
    assert late.min() >= 0 and late.max() == pytest.approx(8, abs=1)
    assert (np.diff(sent.heard) >= 0).all()


def test_a_silent_and_a_spoofed_ship_are_so_from_the_times_on():
    spoof = {'from_s': 300, 'shift_m': 800, 'walk_mps': 2, 'bearing_deg': 0}
    of = built([target(10, ais={'class': 'a', 'silent_s': [100, 200], 'spoof': spoof})])
    sent = heard(of)
    assert not ((sent.time >= 100) & (sent.time < 200)).any()
    sent = take(sent, ~sent.static)
    moved = sent.position[:, 1]
    assert np.ptp(moved[sent.time < 300]) < 1
    after = sent.time >= 300
    expected = moved[0] + 800 + 2 * (sent.time[after] - 300)
    assert moved[after] == pytest.approx(expected, abs=1)


def test_sentences_say_what_was_sent_and_own_ship_is_own_ship():
    of = built([target(12, ais={'class': 'a', 'mmsi': 601000111})], {'own_mmsi': 601999999})
    sent = heard(of)
    sentences = Sentences()
    for at, lines in ais_sentences.encode(sent, of.fleet.origin, of.fleet.names, EPOCH):
        for line in lines:
            sentences.take(line, at + EPOCH)
    reports = sentences.reports()
    assert set(reports.mmsi.tolist()) == {601000111} and sentences.own == 601999999
    assert 'ONE' in reports.name.tolist()
    placed = np.isfinite(reports.latitude)
    place = of.fleet.origin.to_local(reports.latitude[placed], reports.longitude[placed])
    told = sent.position[(sent.ship == 1) & ~sent.static]
    assert np.abs(place - told[: len(place)]).max() < 0.3
    assert reports.speed[placed] == pytest.approx(12 * KNOT, abs=0.2)
    off = reports.time[placed] - EPOCH - sent.time[(sent.ship == 1) & ~sent.static]
    assert np.abs(off).max() <= 0.51


def test_ships_of_a_published_table_send_under_their_own_numbers(tmp_path):
    rows = ['# Timestamp,Type of mobile,MMSI,Latitude,Longitude,Navigational status,ROT,SOG,COG']
    for k in range(40):
        rows.append(
            f'04/03/2021 10:{k // 6:02d}:{10 * (k % 6):02d},Class A,219555666,{55.1 + 0.0005 * k},'
            '10.9,Under way using engine,0.0,11.0,0.0'
        )
    (tmp_path / 'traffic.csv').write_text('\n'.join(rows))
    of = scenario.build(
        {
            'duration_s': 300,
            'ais': {'file': 'traffic.csv', 'send': SEND},
            'own_ship': {'start': {'lat_deg': 55.08, 'lon_deg': 10.95}},
        },
        'table',
        tmp_path,
    )
    sent = heard(of)
    assert set(sent.mmsi.tolist()) == {219555666}
    assert sent.speed[sent.time > 60].mean() == pytest.approx(0.0005 * 111_300 / 10, rel=0.05)


@pytest.mark.parametrize(
    ('send', 'where'),
    [
        ({'share': 2}, 'ais.send.share'),
        ({'latency_s': -1}, 'ais.send.latency_s'),
        ({'shares': 1}, 'shares'),
    ],
)
def test_errors_name_the_place(send, where):
    with pytest.raises(ValueError, match=where):
        built([target()], send)


def test_a_target_with_a_wrong_class_is_refused():
    with pytest.raises(ValueError, match='class'):
        built([target(ais={'class': 'c'})])
    with pytest.raises(ValueError, match='silent_s'):
        built([target(ais={'silent_s': [3]})])
    with pytest.raises(ValueError, match='origin'):
        scenario.build({'duration_s': 60, 'ais': {'send': SEND}, 'targets': [target()]}, 'nowhere')
