"""CSV tables as people's programs write them."""

import os

import pytest

from marine_tracker import tables


def table(tmp_path, content, required=()):
    path = tmp_path / 'some.csv'
    path.write_bytes(content)
    return tables.read(path, required)


@pytest.mark.parametrize('encoding', ['utf-8', 'utf-8-sig', 'utf-16', 'utf-16-le'])
@pytest.mark.parametrize('end', ['\n', '\r\n', '\r'])
def test_encodings_and_ends_of_lines_make_no_difference(tmp_path, encoding, end):
    mark = '\ufeff' if encoding == 'utf-16-le' else ''
    text = mark + end.join(['a, b ,c', '1,2 ,é', '', ' 3,4,"x, y"', ''])
    found = table(tmp_path, text.encode(encoding), ('b',))
    assert found.columns == {'a': ['1', '3'], 'b': ['2', '4'], 'c': ['é', 'x, y']}
    assert found.numbers('b').tolist() == [2, 4]


@pytest.mark.parametrize(
    ('content', 'said'),
    [
        (b'a,b\n1,2\n3,\xe4\n', r'some.csv, line 3: the byte 0xe4 is not UTF-8; save the file'),
        ('a,b\n1,2'.encode('utf-16') + b'\x00', 'is not UTF-16; save the file as UTF-8'),
        (b'', 'some.csv is empty; its first line must name the columns'),
        (b'\n\n', 'some.csv is empty'),
        (b'a,a\n', 'names a column twice: a, a'),
        (b'a,c\n1,2\n', 'has no column b; it has a, c'),
        (b'a,b\n1,2,3\n', r'some.csv, line 2 has 3 cells; it must have 2'),
        (b'a,b\n1,' + b'9' * 200_000, 'line 2 has more than 100000 characters'),
        (b'a,b\n1,"' + b'x\n' * 70_000, 'cannot be read as CSV: field larger than field limit'),
    ],
)
def test_what_is_wrong_with_a_file_is_told_in_one_line(tmp_path, content, said):
    with pytest.raises(ValueError, match=said) as refused:
        table(tmp_path, content, ('a', 'b'))
    assert '\n' not in str(refused.value) and len(str(refused.value)) < 500


@pytest.mark.parametrize('cell', ['x' * 5000, '0x1f', '1,5', '--'])
def test_a_cell_that_is_no_number_is_told_and_cut(tmp_path, cell):
    with pytest.raises(ValueError, match='some.csv, line 2: a is .*; it must be a number') as no:
        table(tmp_path, f'a\n"{cell}"\n'.encode()).numbers('a')
    assert len(str(no.value)) < 300


def test_only_regular_files_are_opened(tmp_path):
    os.mkfifo(tmp_path / 'pipe.csv')
    for path in (tmp_path / 'pipe.csv', tmp_path, '/dev/zero'):
        with pytest.raises(ValueError, match='is not a regular file'):
            tables.read(path)
    with pytest.raises(ValueError, match='none.csv does not exist'):
        tables.read(tmp_path / 'none.csv')


def test_a_file_is_read_row_by_row(tmp_path):
    path = tmp_path / 'long.csv'
    path.write_text('a,b\n1,2\n3,4\n' + 'x' * 200_000 + '\n')
    names, rows = tables.rows(path)
    assert names == ['a', 'b']
    assert [next(rows), next(rows)] == [(2, ['1', '2']), (3, ['3', '4'])]
    with pytest.raises(ValueError, match='line 4 has more than'):
        next(rows)
