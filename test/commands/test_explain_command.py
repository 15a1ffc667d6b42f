"""The place that `marine_tracker explain` asks about must be told in one way, and whole."""

import pytest


@pytest.mark.parametrize(
    'words',
    [
        [],
        ['--range', '2'],
        ['--bearing', '40'],
        ['--east', '1', '--north', '2', '--range', '3', '--bearing', '4'],
        ['--east', '1', '--north', '2', '--bow'],
        ['--east', '1'],
    ],
)
def test_half_a_place_or_two_are_refused_with_what_is_wanted(command, words):
    done = command('explain', *words)
    assert done.returncode == 2
    assert '--range and --bearing, or by --east and --north' in done.stderr


@pytest.mark.parametrize('words', [['--range', '-2'], ['--range', 'nan'], ['--range', 'inf']])
def test_a_place_that_is_none_is_refused(command, words):
    done = command('explain', *words, '--bearing', '30')
    assert done.returncode == 2 and 'both must be finite, a range at least 0' in done.stderr
