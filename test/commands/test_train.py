"""`marine_tracker train`, from start to end."""

import pytest

from marine_tracker import cli
from marine_tracker.estimators.gwnn import gwnn
from marine_tracker.networks import rough_weights
from marine_tracker.networks import wavelet_network as net


def test_training_by_command_gives_weights_that_load(tmp_path, command):
    """Start to end, short: 660 tracks and 30 steps of training."""
    file = tmp_path / 'w.npz'
    done = command(
        'train', 'gwnn', '--seed', 2, '--tracks', 660, '--steps', 30, '--out', file, timeout=110
    )
    assert done.returncode == 0, done.stderr
    assert 'steady, straight: position ratio' in done.stdout
    weights = gwnn.weights(str(file))
    assert weights.manifest['seed'] == 2 and weights.manifest['tracks'] == 660
    assert not list(tmp_path.glob('*.part*'))
    assert net.group_size(weights.fusion.layout) == 20


def test_training_for_ones_own_radar_and_vessels(tmp_path, command):
    """A scenario's radar and targets, boats by a file: weights for small craft."""
    file, kinds = tmp_path / 'w.npz', tmp_path / 'kinds.yaml'
    kinds.write_text('tug: {speed_mps: [0, 7], manoeuvres_per_scan: 0.05}\n')
    done = command(
        'train',
        'gwnn',
        '--vessel-class',
        'small_craft',
        '--kinds',
        kinds,
        '--scenario',
        'busy_strait',
        '--tracks',
        660,
        '--steps',
        20,
        '--out',
        file,
        timeout=110,
    )
    assert done.returncode == 0, done.stderr
    assert 'tug, straight: position ratio' in done.stdout
    manifest = gwnn.weights(str(file), 'small_craft').manifest
    assert manifest['kinds'] == ['tug', 'scenario busy_strait']
    with pytest.raises(ValueError, match='of vessel class small_craft .*, not those of ship'):
        gwnn.weights(str(file))


def test_wrong_options_are_told(tmp_path, capsys):
    for options, text in (
        (('--steps', 0), '--steps is 0'),
        (('--seed', -1), '--seed is -1'),
        (('--out', tmp_path / 'no' / 'w.npz'), 'there is no folder'),
        (('--out', tmp_path / 'w.json'), 'that name is for'),
        (('--without', 'canoe'), "kind of motion 'canoe'; it must be one of steady,"),
        (('--kinds', tmp_path / 'none.yaml'), 'none.yaml cannot be read'),
        (('--scenario', 'busy_street'), 'did you mean busy_strait?'),
    ):
        assert cli.main(['train', 'gwnn', *map(str, options)]) == 2
        assert text in capsys.readouterr().err


def test_training_the_plain_network_of_cs_bp_nn_gives_the_shipped_weights(tmp_path, command):
    file = tmp_path / 'w.npz'
    done = command('train', 'rough_nn', '--network', 'bp', '--seed', 1, '--out', file)
    assert done.returncode == 0, done.stderr
    assert 'RMS error of the share O' in done.stdout
    shipped = rough_weights.shipped('bp')
    assert file.read_bytes() == shipped.read_bytes()
    assert file.with_suffix('.json').read_text() == shipped.with_suffix('.json').read_text()
    wrong = command('train', 'rough_nn', '--seed', -1)
    assert wrong.returncode == 2 and '--seed is -1' in wrong.stderr
