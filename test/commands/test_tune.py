import json

import numpy as np
import pytest

from marine_tracker import cli
from marine_tracker.estimators import imm


@pytest.mark.parametrize('target', ['training', 'manoeuvre'])
def test_a_short_search_gives_settings_and_judges_them_on_fresh_tracks(capsys, target):
    assert (
        cli.main(
            [
                'tune',
                'imm',
                '--for',
                target,
                '--evaluations',
                '3',
                '--tracks',
                '110',
                '--seed',
                '2',
                '--json',
                '-',
            ]
        )
        == 0
    )
    done = capsys.readouterr()
    found = json.loads(done.out)
    assert (found['target'], found['evaluations'], found['seed']) == (target, 3, 2)
    imm.imm(
        imm.Modes(
            **{
                name: tuple(value) if isinstance(value, list) else value
                for name, value in found['settings'].items()
            }
        ),
        25.0,
    )
    assert len(found['best']) == 3
    figures = {figure['name']: figure for figure in found['figures']}
    seen = figures['tracks of the search: found']
    assert np.log(seen['value']) == pytest.approx(found['best'][-1])
    rival = f'shipped for {target}'
    ratio = figures[f'fresh tracks: found over {rival}']
    assert ratio['value'] == pytest.approx(
        figures['fresh tracks: found']['value'] / figures[f'fresh tracks: {rival}']['value']
    )
    low, high = map(float, ratio['against'].strip('[]').split())
    assert low <= ratio['value'] <= high
    assert f'fresh tracks, sharp, manoeuvre: found over {rival}' in figures
    # No bar where there is no terminal; the settings to paste are in the text.
    assert 'trying settings' not in done.err and 'Modes(noise=(' in done.err


@pytest.mark.parametrize(
    ('options', 'text'),
    [
        (('--evaluations', '0'), '--evaluations is 0; it must be at least 1'),
        (('--tracks', '109'), '--tracks is 109; it must be at least 110'),
        (('--seed', '-1'), '--seed is -1; it must be at least 0'),
    ],
)
def test_numbers_out_of_range_are_told(options, text, capsys):
    assert cli.main(['tune', 'imm', *options]) == 2
    assert capsys.readouterr().err == f'marine_tracker: {text}\n'


@pytest.mark.parametrize('words', [('tune',), ('tune', 'imm', '--for', 'fun')])
def test_what_cannot_be_tuned_is_a_usage_error(words, capsys):
    with pytest.raises(SystemExit) as ended:
        cli.main(list(words))
    assert ended.value.code == 2
    assert 'see marine_tracker tune' in capsys.readouterr().err
