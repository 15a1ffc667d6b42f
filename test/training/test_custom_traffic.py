"""Training for a user's own vessels and radar."""

import numpy as np
import pytest

from marine_tracker.estimators.gwnn import bank
from marine_tracker.simulation import scenario
from marine_tracker.training import custom_traffic, gwnn_samples, training_tracks

KINDS = """
pilot boat:
  speed_mps: [6, 14]
  manoeuvres_per_scan: 0.05
  turns_share: 0.9
  turn_radius_m: [60, 400]
  turn_acceleration_mps2: 2
  weave_period_s: [15, 80]
barge:
  speed_mps: [0, 3]
  manoeuvres_per_scan: 0
  drift_share: 0
"""
WATERS = training_tracks.WATERS['ship']


@pytest.fixture
def file(tmp_path):
    def write(text):
        path = tmp_path / 'kinds.yaml'
        path.write_text(text)
        return path

    return write


def test_kinds_are_read_and_move_as_they_say(file):
    kinds = custom_traffic.read_kinds(file(KINDS))
    assert list(kinds) == ['pilot boat', 'barge']
    assert kinds['pilot boat'].speed == (6, 14) and kinds['pilot boat'].weave == (15, 80)
    assert kinds['barge'].angle == 150 and kinds['barge'].weave is None
    kind = np.repeat([0, 1], 60)
    found = training_tracks.draw(
        WATERS._replace(kinds=kinds, steered={}), kind, 60, np.random.default_rng(1)
    )
    speed = np.hypot(*np.moveaxis(found.ships.velocity, -1, 0))
    boats, barges = found.kind == 0, found.kind == 1
    assert 5 < speed[boats].min() and speed[boats].max() < 16 and speed[barges].max() <= 3
    assert found.ships.manoeuvre[boats].all() and not found.ships.manoeuvre[barges].any()


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        ('{}', 'there is no kind of vessel in it'),
        ('- tug', 'it must hold a mapping'),
        ('tug: 7', 'tug is 7; it must be a mapping'),
        ('tug: {speed_mps: [1, 5]}', 'tug has no manoeuvres_per_scan'),
        ('tug: {manoeuvres_per_scan: 0.1}', 'tug has no speed_mps'),
        (
            'tug: {speed_mps: [1, 5], manoeuvres_per_scan: 2}',
            'tug.manoeuvres_per_scan is 2; it must be between 0 and 1',
        ),
        (
            'tug: {speed_mps: [5, 1], manoeuvres_per_scan: 0}',
            'the least must not be above the most',
        ),
        ('tug: {speed_mps: 5, manoeuvres_per_scan: 0}', r'it must be a pair \[least, most\]'),
        (
            'tug: {speed_mps: [1, fast], manoeuvres_per_scan: 0}',
            r"tug.speed_mps\[1\].value is 'fast'; it must be a number",
        ),
        (
            'tug: {speed_mps: [1, 5], manoeuvres_per_scan: 0, turn_radius: [1, 2]}',
            'tug.turn_radius is not known: the key must end in its unit',
        ),
    ],
)
def test_what_is_wrong_in_a_file_of_kinds_is_told(file, text, message):
    with pytest.raises(ValueError, match=f'kinds.yaml.*{message}'):
        custom_traffic.read_kinds(file(text))


def test_a_missing_file_is_told(tmp_path):
    with pytest.raises(ValueError, match=r'none\.yaml cannot be read: No such file'):
        custom_traffic.read_kinds(tmp_path / 'none.yaml')


def harbour(duration=900.0):
    return scenario.build(
        {
            'duration_s': duration,
            'radar': {
                'rotation_rpm': 40,
                'range_sigma_m': 6,
                'bearing_sigma_deg': 1,
                'max_range_m': 4000,
                'pd_near': 0.9,
                'pd_far': 0.7,
            },
            'targets': [
                {
                    'start': {'range_m': 2000, 'bearing_deg': 30},
                    'course_deg': 200,
                    'speed_mps': 4,
                    'legs': [
                        {'straight': {'duration_s': 120}},
                        {'turn': {'angle_deg': 90, 'radius_m': 100}},
                    ],
                },
                {'start': {'range_m': 900, 'bearing_deg': 300}, 'course_deg': 0, 'speed_mps': 0},
            ],
        },
        'harbour',
    )


def test_a_scenario_gives_its_radar_and_its_targets():
    waters = custom_traffic.from_scenario(WATERS, harbour())
    assert waters.names[-1] == 'scenario harbour' and len(waters.names) == len(WATERS.names) + 1
    kind = np.tile(np.arange(len(waters.names)), 40)
    found = training_tracks.draw(waters, kind, 60, np.random.default_rng(2))
    radar = found.radar
    assert 6 / 1.2 <= radar.range_sigma.min() and radar.range_sigma.max() <= 6 * 1.2
    assert np.radians(1 / 1.2) <= radar.bearing_sigma.min()
    assert (np.median(radar.period), np.ptp(radar.period) < 0.2) == (pytest.approx(1.5), True)
    assert 0.7 <= radar.detection.min() and radar.detection.max() <= 1.0
    own = found.kind == len(WATERS.names)
    speed = np.hypot(*np.moveaxis(found.ships.velocity[own], -1, 0))
    still = speed.max(1) < 0.01
    assert 0.2 < still.mean() < 0.8
    np.testing.assert_allclose(speed[~still], 4.0, atol=1e-6)
    assert found.ships.manoeuvre[own][~still].any() and not found.ships.manoeuvre[own][still].any()
    # Where they lie: the one at rest 900 m from own ship.
    np.testing.assert_allclose(np.hypot(*found.ships.position[own][still][:, 30].T), 900, atol=1)


def test_a_scenario_too_short_to_learn_from_is_told():
    waters = custom_traffic.from_scenario(WATERS, harbour(60.0))
    with pytest.raises(ValueError, match='no target that is there for .* s; make it longer'):
        gwnn_samples.make(bank.BANKS['ship'], waters, 1, 0)
