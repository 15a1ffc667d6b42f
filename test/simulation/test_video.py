import itertools

import numpy as np
import pytest

from marine_tracker.simulation import picture, radar_equation, scenario, video

RADAR = {
    'rotation_rpm': 25,
    'max_range_nm': 4,
    'range_resolution_m': 40,
    'beam_width_deg': 1.8,
    'blind_range_m': 60,
}
SHIP = {'start': {'range_nm': 2, 'bearing_deg': 60}, 'speed_kn': 0, 'course_deg': 0, 'length_m': 15}


def built(targets=(SHIP,), land=(), **settings):
    values = {
        'duration_s': 120,
        'radar': {**RADAR, 'video': {'spokes': 600, 'samples': 300, **settings}},
        'targets': list(targets),
        'land': list(land),
    }
    return scenario.build(values, 'made')


def turns(chosen, count=1, seed=3):
    return list(itertools.islice(video.simulate(chosen, seed), count))


def decibels(turn, bits=8):
    """Power over noise, as the display tells it."""
    return turn.sweep.strength * (80.0 / (2**bits - 1)) - 8.0


def cell(range_m, bearing_deg, spokes=600, samples=300, longest=4 * 1852.0):
    return round(bearing_deg * spokes / 360), int(range_m / longest * samples)


def test_the_same_seed_gives_the_same_picture_and_another_one_another():
    chosen = built(sea_state=3, interference=1)
    one, again = turns(chosen, 2), turns(chosen, 2)
    for first, second in zip(one, again):
        assert np.array_equal(first.sweep.strength, second.sweep.strength)
    assert not np.array_equal(one[0].sweep.strength, turns(chosen, 1, 4)[0].sweep.strength)


@pytest.mark.parametrize(
    ('bits', 'kind', 'top'), [(4, np.uint8, 15), (8, np.uint8, 255), (16, np.uint16, 65535)]
)
def test_noise_is_exponential_in_power_with_mean_one(bits, kind, top):
    turn = turns(built(bits=bits))[0]
    assert turn.sweep.strength.dtype == kind and turn.sweep.strength.max() <= top
    quiet = decibels(turn, bits)[300:, 100:]
    if bits > 4:
        power = 10 ** (0.1 * quiet)
        assert power.mean() == pytest.approx(1.0, rel=0.05)
        assert (power > 4).mean() == pytest.approx(np.exp(-4), rel=0.15)


def test_angles_count_from_the_bow_and_time_runs_with_the_beam():
    values = {
        'duration_s': 20,
        'radar': {**RADAR, 'video': {'spokes': 600, 'samples': 64}},
        'own_ship': {'course_deg': 70, 'speed_kn': 8},
        'targets': [SHIP],
    }
    turn = turns(scenario.build(values, 'made'))[0]
    true = np.mod(turn.sweep.angle + turn.sweep.heading, 2 * np.pi)
    assert turn.sweep.heading == pytest.approx(np.radians(70.0), abs=1e-6)
    off = np.mod(true - np.arange(600) * 2 * np.pi / 600 + np.pi, 2 * np.pi) - np.pi
    assert np.abs(off).max() < 1e-9
    assert np.diff(turn.sweep.time) == pytest.approx(2.4 / 600, rel=1e-6)


def mean_power(range_nm, swerling=1, length=15.0, scans=60):
    """Powers over noise of a ship in many scans, in the middle of its echo."""
    ship = {**SHIP, 'start': {'range_nm': range_nm, 'bearing_deg': 60}, 'length_m': length}
    found = turns(built([ship], swerling=swerling, bits=16), 49)
    row, column = cell(range_nm * 1852, 60)
    return np.array(
        [
            10 ** (0.1 * decibels(turn, 16)[row - 1 : row + 2, column - 1 : column + 2]).max()
            for turn in found
        ]
    )


def test_an_echo_falls_with_the_fourth_power_of_range():
    near, far = np.median(mean_power(0.8)), np.median(mean_power(1.6))
    assert 10 * np.log10(near / far) == pytest.approx(12.0, abs=3.5)


def test_swerling_1_fluctuates_more_than_swerling_3():
    one, three = mean_power(1.0), mean_power(1.0, 3)
    assert one.std() / one.mean() == pytest.approx(1.0, abs=0.35)
    assert three.std() / three.mean() == pytest.approx(0.71, abs=0.25)


def test_a_longer_ship_echoes_more_and_abeam_most():
    length = np.array([10.0, 50.0, 200.0])
    section = radar_equation.ship_section(length, np.full(3, 0.8))
    assert (np.diff(np.log10(section)) > 1).all() and 1 < section[0] < 50
    around = radar_equation.ship_section(np.full(37, 80.0), np.linspace(0, np.pi, 37))
    assert around.argmax() == 18 and around[0] > around[5]


def test_the_antenna_is_down_by_6_db_at_half_its_beam_and_has_side_lobes():
    beam = np.radians(2.0)
    two_way = picture.pattern(np.radians([0.0, 1.0, 3.0, 30.7]), beam) ** 2
    loss = 10 * np.log10(two_way)
    assert loss[:2] == pytest.approx([0.0, -6.02], abs=0.05)
    assert -60 <= loss[2] <= -40 and loss[3] <= -60


def test_the_sea_falls_with_range_and_rises_with_its_state():
    levels = []
    for state in (0, 2, 5):
        power = 10 ** (0.1 * decibels(turns(built(sea_state=state))[0]))
        levels.append([power[300:, a:b].mean() for a, b in ((10, 20), (40, 60), (250, 300))])
    calm, slight, rough = np.array(levels)
    assert calm == pytest.approx(1.0, rel=0.2)
    assert (np.diff(rough) < 0).all() and (rough >= 0.9 * slight).all() and rough[0] > 10
    assert rough[0] > 3 * slight[0]


def test_the_sea_is_k_distributed():
    """Its normalised second moment of power is 2 (1 + 1 / nu)."""
    random = np.random.default_rng(2)
    of = picture.form(4096, 40, 2000.0, np.radians(1.2), 30.0)
    factor = 1e30  # no noise
    mean = picture.background(of, factor, 4.0, random)
    power = picture.add_points(mean, of, picture.Points(*np.zeros((4, 0))), random)
    _, shape = radar_equation.sea(of.range, of.beam, of.pulse, 4.0)
    column = 24
    moment = (power[:, column] ** 2).mean(dtype=float) / power[:, column].mean(dtype=float) ** 2
    assert moment == pytest.approx(2 * (1 + 1 / shape[column]), rel=0.25)


def test_rain_lifts_the_level_where_it_is_and_moves():
    shower = {
        'start': {'north_nm': -2, 'east_nm': 0},
        'radius_nm': 0.5,
        'rate_mm_per_h': 40,
        'course_deg': 90,
        'speed_kn': 40,
    }
    chosen = built(rain=[shower])
    first, later = turns(chosen, 45)[::44]
    middle, beside = cell(2 * 1852, 180), cell(2 * 1852, 120)
    assert decibels(first)[middle[0] - 5 : middle[0] + 5, middle[1] - 3 : middle[1] + 3].mean() > 3
    assert decibels(first)[beside[0] - 5 : beside[0] + 5, beside[1] - 3 : beside[1] + 3].mean() < 0
    moved = cell(np.hypot(2, 1.17) * 1852, 180 - np.degrees(np.arctan2(1.17, 2)))
    assert decibels(later)[moved[0] - 5 : moved[0] + 5, moved[1] - 3 : moved[1] + 3].mean() > 3


def test_land_shows_and_hides_what_lies_behind():
    ship = {**SHIP, 'start': {'range_nm': 3, 'bearing_deg': 90}, 'length_m': 60}
    wall = {'name': 'mole', 'corners_nm': [[-1.0, 2.0], [1.0, 2.0]], 'snr_db': 30}
    open_, shut = turns(built([ship]))[0], turns(built([ship], [wall]))[0]
    at, shore = cell(3 * 1852, 90), cell(2 * 1852, 90)
    around = slice(at[0] - 2, at[0] + 3), slice(at[1] - 2, at[1] + 3)
    assert decibels(open_)[around].max() > 20 > decibels(shut)[around].max() + 3
    assert decibels(shut)[shore[0] - 4 : shore[0] + 5, shore[1] : shore[1] + 3].max() > 20


def test_another_radars_pulses_are_alone_in_their_spokes():
    chosen = built(interference=3)
    strong = decibels(turns(chosen)[0])[:, 100:] > 30
    ship = cell(2 * 1852, 60)
    strong[ship[0] - 8 : ship[0] + 8] = False
    assert strong.sum() > 10
    lone = strong[1:-1] & ~strong[:-2] & ~strong[2:]
    assert lone.sum() > 0.8 * strong.sum()


@pytest.mark.parametrize(
    ('settings', 'words'),
    [
        ({'bits': 12}, 'radar.video.bits is 12; it must be one of 4, 8, 16'),
        ({'bits': True}, 'radar.video.bits is True'),
        ({'sea_state': 9}, 'radar.video.sea_state is 9; it must be between 0 and 8'),
        ({'spokes': 100.5}, 'radar.video.spokes is 100.5; it must be a whole number'),
        ({'swerling': 2}, 'radar.video.swerling is 2'),
        ({'seastate': 2}, 'radar.video.seastate is not known'),
        ({'rain': [{'radius_nm': 1}]}, 'radar.video.rain[0].start has no'),
    ],
)
def test_wrong_settings_are_named(settings, words):
    with pytest.raises(ValueError) as error:
        built(**settings)
    assert words in str(error.value)


def test_a_scenario_without_video_has_no_spokes():
    plain = scenario.build({'duration_s': 60, 'targets': [SHIP]}, 'plain')
    with pytest.raises(ValueError, match='plain has no video'):
        next(video.simulate(plain, 1))
