"""One reader for all YAML and JSON: what it takes, and what it refuses in one line."""

import math
import os

import pytest

from marine_tracker import config, yaml_file


def refusal(text, name='some.yaml', **how):
    with pytest.raises(ValueError) as refused:
        yaml_file.parse(text, name, **how)
    message = str(refused.value)
    assert message.startswith(name)
    assert '\n' not in message and len(message) < 500
    return message


@pytest.mark.parametrize(
    ('written', 'expected'),
    [
        ('030', 30),
        ('-007', -7),
        ('008', 8),
        ('2:15', '2:15'),
        ('12:30:45', '12:30:45'),
        ('0o17', '0o17'),
        ('0x1F', '0x1F'),
        ('0b101', '0b101'),
        ('1_000', '1_000'),
        ('2024-02-29', '2024-02-29'),
        ('yes', 'yes'),
        ('off', 'off'),
        ('N', 'N'),
        ('true', True),
        ('False', False),
        ('~', None),
        ('', None),
        ('"012"', '012'),
        ("'true'", 'true'),
        ('!!str 012', '012'),
        ('+3.50', 3.5),
        ('.5', 0.5),
        ('6.', 6.0),
        ('1e-3', 0.001),
        ('2E4', 20000.0),
        ('-.inf', -math.inf),
        ('=', '='),
    ],
)
def test_scalars_are_those_of_yaml_1_2_with_decimal_numbers_only(written, expected):
    found = yaml_file.parse(f'key: {written}', 'it')['key']
    assert found == expected and type(found) is type(expected)


@pytest.mark.parametrize('written', ['030', 'true', '~', '1e3', '.inf', 'x'])
def test_scalars_stay_the_text_that_was_written_where_that_is_wanted(written):
    assert yaml_file.parse(f'[{written}, {{a: "{written}"}}]', 'it', as_text=True) == [
        written,
        {'a': written},
    ]


def test_not_a_number_is_a_number_to_be_judged_by_others():
    assert math.isnan(yaml_file.parse('.nan', 'it'))


def test_json_is_yaml():
    assert yaml_file.parse('{"a":[1,-2.5e1,"x\\u00e9",null,true],"b":{}}', 'it') == {
        'a': [1, -25.0, 'xé', None, True],
        'b': {},
    }


def test_a_key_may_be_there_once_at_any_depth():
    said = refusal('a: 1\nship:\n  legs:\n    - {turn: 3, speed: 1, turn: 4}\n')
    assert "line 4, ship.legs[0]: 'turn' is there twice" in said


def test_values_nested_too_deep_are_refused():
    deep = yaml_file.MAX_DEPTH
    assert yaml_file.parse('[' * deep + ']' * deep, 'it')
    assert f'{deep} levels' in refusal('[' * (deep + 1) + ']' * (deep + 1))
    assert f'{deep} levels' in refusal('key: ' + '[' * 3000)
    assert f'{deep} levels' in refusal('{a: ' * 3000)
    assert f'{deep} levels' in refusal('\n'.join(' ' * k + f'k{k}:' for k in range(200)))


def test_aliases_count_as_often_as_they_are_used():
    text = 'a: &a [' + '1, ' * 200 + ']\n'
    assert yaml_file.parse(text + 'b: *a\nc: [*a, *a]', 'it')['c'][1] == [1] * 200
    for one, another in zip('abcde', 'bcdef'):
        text += f'{another}: &{another} [' + ', '.join([f'*{one}'] * 6) + ']\n'
    assert f'too many values; {yaml_file.MAX_VALUES} are allowed' in refusal(text)


def test_an_alias_of_what_is_not_there_or_holds_it_is_refused():
    assert '*gone stands for nothing' in refusal('a: *gone')
    assert '*me stands for nothing' in refusal('a: &me [1, *me]')


def test_long_files_and_long_lists_are_refused():
    assert f'{yaml_file.MAX_BYTES} at most' in refusal(' ' * (yaml_file.MAX_BYTES + 1))
    assert 'too many values' in refusal('[' + '1,' * (yaml_file.MAX_VALUES + 1) + ']')


@pytest.mark.parametrize('digits', ['9' * 25, '-' + '8' * 6000, '9223372036854775808'])
def test_integers_too_large_for_64_bits_are_refused_and_cut(digits):
    assert 'line 2, a.b[1]: ' in (said := refusal(f'a:\n  b: [1, {digits}]'))
    assert 'at most 9223372036854775807' in said


def test_leading_noughts_make_no_number_large():
    assert yaml_file.parse('0' * 400 + '12', 'it') == 12


def test_a_long_key_is_refused_and_cut():
    assert '900 characters; 200 are allowed' in refusal('z' * 900 + ': 1')


@pytest.mark.parametrize(
    ('text', 'said'),
    [
        ('a: 1\nb: [2', 'line 2'),
        ('\ta: 1', 'line 1'),
        ('a: b: c', 'line 1'),
        ('a: 1\n---\nb: 2', 'second document'),
        ('%YAML 1.1\n---\na: 010', 'YAML 1.1; it must be YAML 1.2'),
        ('a: !!python/object:os.system x', 'tag'),
        ('a: !!binary aGVsbG8=', 'tag'),
        ('a: !thing {}', 'tag'),
        ('? [1, 2]\n: 3', 'it must be a word'),
        ('&a [1]: 2', 'it must be a word'),
        ('"\\UFFFFFFF0"', 'not YAML'),
        ('a: "\\q"', 'not YAML'),
        ('\x01', 'not YAML'),
    ],
)
def test_what_is_no_plain_yaml_is_refused_in_one_line(text, said):
    assert said in refusal(text)


def test_every_file_that_is_shipped_is_read():
    files = list(config.path().rglob('*.yaml'))
    assert files and all(yaml_file.read_mapping(file) for file in files)


def test_a_mark_of_byte_order_is_no_part_of_the_first_key(tmp_path):
    file = tmp_path / 'x.yaml'
    file.write_bytes(b'\xef\xbb\xbfa: 1\n')
    assert yaml_file.read_mapping(file) == {'a': 1}


def test_another_encoding_is_refused_with_its_line(tmp_path):
    file = tmp_path / 'x.yaml'
    file.write_bytes('a: 1\nb: ø\n'.encode('latin-1'))
    with pytest.raises(ValueError, match=r'x.yaml, line 2: the byte 0xf8 is not UTF-8'):
        yaml_file.read(file)


@pytest.mark.parametrize('read', [yaml_file.read, yaml_file.read_json])
def test_only_regular_files_of_a_few_bytes_are_opened(tmp_path, read):
    pipe, large = tmp_path / 'pipe.yaml', tmp_path / 'large.yaml'
    os.mkfifo(pipe)
    large.touch()
    os.truncate(large, 10**11)  # sparse
    for path, said in (
        (pipe, 'not a regular file'),
        ('/dev/zero', 'not a regular file'),
        (tmp_path, 'not a regular file'),
        (large, f'more than {yaml_file.MAX_BYTES} bytes'),
    ):
        with pytest.raises(ValueError, match=said):
            read(path)
    with pytest.raises(FileNotFoundError):
        read(tmp_path / 'none.yaml')


@pytest.mark.parametrize(
    ('text', 'said'),
    [
        ('{"a": 1, "a": 2}', "'a' is there twice"),
        ('{"a": {"b": 1, "c": 2, "b": 3}}', "'b' is there twice"),
        ('{"a": ' + '[' * 100 + ']' * 100 + '}', 'nested too deep'),
        ('{"a": ' * 40_000, 'nested too deep'),
        ('{"a": ' + '7' * 5000 + '}', 'at most 9223372036854775807'),
        ('[1]', 'holds a list; it must hold an object'),
        ('{"a": 1\n,}', 'line 2 is not JSON'),
        ('{"' + 'k' * 300 + '": 1}', '300 characters; 200 are allowed'),
        ('', 'line 1 is not JSON'),
    ],
)
def test_json_has_the_same_limits(tmp_path, text, said):
    file = tmp_path / 'notes.json'
    file.write_text(text)
    with pytest.raises(ValueError) as refused:
        yaml_file.read_json(file)
    assert said in str(refused.value) and str(refused.value).startswith(str(file))
    assert '\n' not in str(refused.value) and len(str(refused.value)) < 500
