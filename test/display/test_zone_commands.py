"""Zones as a viewer sends them, and as the parameter's text takes them in."""

import json

import numpy as np
import pytest

from marine_tracker.arpa import zone_text, zones
from marine_tracker.display import commands

TEXT = """
- {name: ahead, kind: guard, range_nm: [1, 2.5], bearing_deg: [315, 045]}
- {name: on, kind: exclusion, fixed_to: ground, corners_nm: [[0, 0], [1, 0], [1, 2]]}
"""
SECTOR = {'name': 'port', 'kind': 'guard', 'range_m': [700, 950.5], 'bearing_deg': [255.5, 300]}


def sent(command, /, **fields):
    return commands.parse(json.dumps({'command': command, **fields}))


def test_a_zone_goes_through_as_it_was_drawn():
    command = sent('zone_put', zone=SECTOR, was='old one', id=4)
    assert command.values == {'zone': SECTOR, 'was': 'old one'}
    assert sent('zone_delete', name='port').values == {'name': 'port'}
    assert sent('explain', x=-20.5, y=7000).values == {'x': -20.5, 'y': 7000.0}


@pytest.mark.parametrize(
    'zone, words',
    [
        ('port', 'an object'),
        ({**SECTOR, 'colour': 'red'}, 'no key'),
        ({**SECTOR, 'range_m': [[[1]]]}, 'list of numbers'),
        ({**SECTOR, 'range_m': {'near': 1}}, 'list of numbers'),
        ({**SECTOR, 'kind': None}, 'kind must be'),
        ({**SECTOR, 'kind': True}, 'kind must be'),
    ],
)
def test_what_is_no_zone_is_refused_in_words(zone, words):
    with pytest.raises(ValueError, match=words):
        sent('zone_put', zone=zone, was='')


@pytest.mark.parametrize('was', [None, 7, 'n' * 81])
def test_a_name_is_a_short_text(was):
    with pytest.raises(ValueError, match='was, a text of at most 80'):
        sent('zone_put', zone=SECTOR, was=was)


def test_a_zone_is_put_in_and_the_others_stay_as_they_were_written():
    text = zone_text.put(TEXT, SECTOR)
    assert [item['name'] for item in json.loads(text)] == ['ahead', 'on', 'port']
    assert json.loads(text)[0]['bearing_deg'] == ['315', '045']
    before, after = zones.parse(TEXT), zones.parse(text)
    assert (after.key[:2] == before.key).all()
    plain = zone_text.plain(text)
    assert plain[2]['range'] == [700.0, 950.5] and plain[2]['corners'] is None
    assert plain[2]['bearing'] == pytest.approx(np.radians([255.5, 44.5]))
    assert plain[1]['corners'] == [[0, 0], [1852, 0], [1852, 3704]]
    assert (plain[1]['fixed_to'], plain[1]['kind']) == ('ground', 'exclusion')


def test_a_zone_takes_the_place_of_the_one_it_was():
    text = zone_text.put(TEXT, {**SECTOR, 'name': 'bow'}, 'ahead')
    assert [zone['name'] for zone in zone_text.plain(text)] == ['bow', 'on']
    assert zone_text.without(text, 'bow').count('name') == 1
    assert zone_text.without(zone_text.without(text, 'bow'), 'on') == ''


def test_a_full_ring_has_no_sides():
    ring = {'name': 'r', 'kind': 'guard', 'range_m': [10, 20]}
    assert zone_text.plain(zone_text.put('', ring))[0]['bearing'] is None


@pytest.mark.parametrize(
    'change, words',
    [
        (lambda: zone_text.put(TEXT, SECTOR, 'gone'), 'no zone gone any more'),
        (lambda: zone_text.without(TEXT, 'gone'), 'no zone gone any more'),
        (lambda: zone_text.put(TEXT, {**SECTOR, 'name': 'on'}), 'two zones have the name on'),
        (lambda: zone_text.put(TEXT, {**SECTOR, 'range_m': [9, 2]}), 'the first must be below'),
    ],
)
def test_what_the_tracker_would_refuse_is_refused_in_its_words(change, words):
    with pytest.raises(ValueError, match=words):
        change()
