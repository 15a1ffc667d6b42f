import dataclasses
import re

import pytest

from marine_tracker import yaml_file
from marine_tracker.estimators import ESTIMATORS
from marine_tracker.parameters import (
    NODES,
    VESSEL_CLASSES,
    ArpaParameters,
    TrackerParameters,
    description,
    from_mapping,
)

KINDS = [kind for kinds in NODES.values() for kind in kinds]
FIELDS = [(kind, field) for kind in KINDS for field in dataclasses.fields(kind)]
NUMBERS = [(kind, field) for kind, field in FIELDS if field.type in (int, float)]


def name_of(value):
    return getattr(value, 'name', getattr(value, '__name__', None))


@pytest.mark.parametrize(('kind', 'field'), FIELDS, ids=name_of)
def test_every_parameter_is_described(kind, field):
    about = field.metadata
    assert about['text'].strip()
    assert isinstance(field.default, field.type)
    for limit in (about['low'], about['high']):
        assert limit is None or isinstance(limit, (int, float))
    suffixes = {'_m': 'm', '_s': 's', '_deg': 'deg', '_mps': 'm/s'}
    for suffix, unit in suffixes.items():
        if field.name.endswith(suffix):
            assert about['unit'] == unit


@pytest.mark.parametrize('kind', KINDS, ids=name_of)
def test_the_defaults_are_allowed(kind):
    kind()


@pytest.mark.parametrize(('kind', 'field'), NUMBERS, ids=name_of)
def test_a_number_beyond_its_limits_is_refused_by_name_value_and_limit(kind, field):
    low, high = field.metadata['low'], field.metadata['high']
    assert low is not None and high is not None, f'{field.name} has no limits'
    step = 1 if field.type is int else 0.5 * max(abs(low), 0.1)
    for wrong in (low - step, high + step):
        with pytest.raises(ValueError) as error:
            kind(**{field.name: wrong})
        text = str(error.value)
        assert field.name in text
        assert f'{wrong:g}' in text and f'{low:g}' in text and f'{high:g}' in text


def test_the_limits_themselves_are_allowed():
    TrackerParameters(
        gate_probability=0.5,
        confirm_existence=0.999999,
        confirm_hits=2,
        confirm_scans=2,
        min_range_m=0.0,
        max_range_m=200000.0,
        range_sigma_m=0.1,
    )


@pytest.mark.parametrize(
    ('name', 'value', 'kind'),
    [
        ('range_sigma_m', '15', 'float'),
        ('range_sigma_m', True, 'float'),
        ('range_sigma_m', None, 'float'),
        ('confirm_hits', 3.0, 'int'),
        ('confirm_hits', True, 'int'),
        ('estimator', 3, 'str'),
    ],
)
def test_a_wrong_type_is_refused_by_name(name, value, kind):
    with pytest.raises(ValueError, match=f'{name} is {re.escape(repr(value))}.*{kind}'):
        TrackerParameters(**{name: value})


@pytest.mark.parametrize('value', [float('nan'), float('inf'), -float('inf')])
def test_a_number_must_be_finite(value):
    with pytest.raises(ValueError, match='range_sigma_m.*finite'):
        TrackerParameters(range_sigma_m=value)


def test_whole_numbers_serve_as_floats():
    value = TrackerParameters(range_sigma_m=20).range_sigma_m
    assert value == 20.0 and type(value) is float


@pytest.mark.parametrize('name', ['estimator', 'vessel_class'])
def test_an_unknown_choice_is_refused_with_the_known_ones(name):
    with pytest.raises(ValueError) as error:
        TrackerParameters(**{name: 'kalmann'})
    field = next(f for f in dataclasses.fields(TrackerParameters) if f.name == name)
    assert name in str(error.value) and 'kalmann' in str(error.value)
    for choice in field.metadata['choices']:
        assert choice in str(error.value)


def test_the_choices_are_what_the_registry_holds():
    choices = {f.name: f.metadata['choices'] for f in dataclasses.fields(TrackerParameters)}
    assert set(choices['estimator']) == set(ESTIMATORS)
    assert set(choices['vessel_class']) == set(VESSEL_CLASSES)


@pytest.mark.parametrize(
    ('values', 'names'),
    [
        ({'confirm_hits': 6, 'confirm_scans': 5}, ('confirm_hits', '6', 'confirm_scans', '5')),
        (
            {'min_range_m': 5000.0, 'max_range_m': 4000.0},
            ('min_range_m', '5000', 'max_range_m', '4000'),
        ),
        ({'min_range_m': 4000.0, 'max_range_m': 4000.0}, ('min_range_m', 'max_range_m')),
        ({'extent': 'gp', 'radars': '- {topic: a}'}, ('extent is gp', 'several radars')),
    ],
)
def test_parameters_that_contradict_each_other_are_refused(values, names):
    with pytest.raises(ValueError) as error:
        TrackerParameters(**values)
    for name in names:
        assert name in str(error.value)


def test_parameters_cannot_be_changed_behind_the_check():
    with pytest.raises(dataclasses.FrozenInstanceError):
        TrackerParameters().confirm_hits = 1


def test_an_unknown_name_is_refused_with_its_neighbour():
    with pytest.raises(ValueError, match='range_sgma_m.*range_sigma_m'):
        from_mapping(TrackerParameters, {'range_sgma_m': 15.0})
    with pytest.raises(ValueError, match='unknown parameter 7'):
        from_mapping(TrackerParameters, {7: 15.0})


def test_a_mapping_gives_the_parameters_it_names():
    found = from_mapping(TrackerParameters, {'range_sigma_m': 7.5, 'confirm_hits': 4})
    assert found == TrackerParameters(range_sigma_m=7.5, confirm_hits=4)


@pytest.mark.parametrize(
    ('text', 'expected'), [('', {}), ('# nothing\n', {}), ('a: 1\n', {'a': 1})]
)
def test_a_yaml_file_gives_its_mapping(tmp_path, text, expected):
    file = tmp_path / 'some.yaml'
    file.write_text(text)
    assert yaml_file.read_mapping(file) == expected


@pytest.mark.parametrize('text', ['a: [1\n', '- 1\n- 2\n', 'just words', '5'])
def test_another_yaml_file_is_refused_by_name(tmp_path, text):
    file = tmp_path / 'some.yaml'
    file.write_text(text)
    with pytest.raises(ValueError, match='some.yaml'):
        yaml_file.read_mapping(file)


@pytest.mark.parametrize(
    ('kind', 'text', 'name', 'expected'),
    [
        (TrackerParameters, 'extent: off', 'extent', 'none'),
        (TrackerParameters, 'extent: false', 'extent', 'none'),
        (ArpaParameters, 'vectors: true', 'vectors', 'absolute'),
        (ArpaParameters, 'vectors: "true"', 'vectors', 'absolute'),
    ],
)
def test_words_of_earlier_versions_are_read_with_a_hint(kind, text, name, expected, caplog):
    description._tell_once.cache_clear()
    for _ in range(2):
        read = from_mapping(kind, yaml_file.parse(text, 'it'))
        assert getattr(read, name) == expected
    assert len(caplog.records) == 1
    assert f'write {expected}' in caplog.text and name in caplog.text


def test_other_bools_are_no_words():
    with pytest.raises(ValueError, match='extent is True, a bool; it must be a str'):
        TrackerParameters(extent=True)
    with pytest.raises(ValueError, match='vectors is False, a bool; it must be a str'):
        ArpaParameters(vectors=False)


def test_no_word_of_a_choice_is_read_as_another_type():
    for kinds in NODES.values():
        for field in (field for kind in kinds for field in dataclasses.fields(kind)):
            for word in field.metadata['choices']:
                assert word.lower() not in ('y', 'n', 'yes', 'no', 'on', 'off', 'true', 'false')
                assert yaml_file.parse(word, 'it') == word
