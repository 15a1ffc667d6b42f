import csv

import numpy as np
import pytest

from marine_tracker.recording import spokes_file
from marine_tracker.types import OwnShip, Sweep

SHIPS = ((2100.0, 75.0, 33.0), (3000.0, 310.0, 30.0))


@pytest.fixture
def recorded(tmp_path, pictures):
    """Eight revolutions with two ships at rest; no heading is told."""
    picture = pictures.turned(pictures.make(SHIPS), 8)
    count, samples = picture.strength.shape
    path = tmp_path / 'rest.npz'
    sweep = Sweep(
        picture.time,
        picture.bearing,
        np.full(count, np.nan),
        picture.range_step * samples,
        picture.strength,
    )
    spokes_file.write(path, [sweep], OwnShip(np.zeros(1), np.zeros((1, 2)), np.zeros((1, 2))))
    return path


def test_spokes_are_tracked(command, recorded, tmp_path):
    out = tmp_path / 'tracks.csv'
    run = command(
        'replay', recorded, '--out', out, '--heading', '20',
        '--video', 'beam_width_deg=2.4', '--video', 'pulse_length_m=30',
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    rows = list(csv.DictReader(out.open()))
    last = [row for row in rows if row['scan'] == rows[-1]['scan']]
    assert [row['status'] for row in last] == ['confirmed', 'confirmed']
    bearings = sorted(float(row['bearing_deg']) for row in last)
    assert bearings == pytest.approx([95.0, 330.0], abs=1.0)


def test_without_a_heading_there_are_no_bearings(command, recorded):
    run = command('replay', recorded, '--out', '-')
    assert run.returncode == 2 and 'tells no heading' in run.stderr


@pytest.mark.parametrize('option', ['beam_width_deg=0', 'beam=2', 'beam_width_deg'])
def test_a_wrong_parameter_of_the_extraction_is_named(command, recorded, option):
    run = command('replay', recorded, '--out', '-', '--heading', '1', '--video', option)
    assert run.returncode == 2 and 'beam' in run.stderr and len(run.stderr.splitlines()) == 1
