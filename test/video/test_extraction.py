import numpy as np
import pytest

from marine_tracker.parameters import VideoParameters
from marine_tracker.types import Spokes
from marine_tracker.video.extraction import Extraction
from marine_tracker.video.found import LAND, LONE, NO_BEARING, together

SHIPS = ((1500.0, 40.0, 30.0), (3300.0, 151.0, 25.0), (2222.0, 359.7, 28.0))


def extract(parts, **parameters):
    values = {'beam_width_deg': 2.4, 'pulse_length_m': 30.0, 'false_alarms_per_million': 1.0}
    extraction = Extraction(VideoParameters(**{**values, **parameters}))
    memory, found = extraction.start(), []
    for part in parts:
        memory, one = extraction.step(memory, part)
        found.append(one)
    memory, one = extraction.end(memory)
    return together([*found, one])


def nearest(plots, range_, bearing):
    """The plot nearest to a place, and its distance m."""
    x = plots.range * np.exp(1j * plots.bearing)
    away = np.abs(x - range_ * np.exp(1j * np.radians(bearing)))
    return away.argmin(), away.min()


@pytest.mark.parametrize(('bits', 'least', 'false'), [(4, 0.2, 1), (8, 0.1, 0), (16, 0.1, 0)])
def test_ships_are_found_where_they_are_and_nothing_else(pictures, bits, least, false):
    found = extract(pictures.cut(pictures.turned(pictures.make(SHIPS, bits=bits), 2), 100))
    plots = found.plots
    # North is passed at both ends. With 4 bits a step is 3.5 dB: the tail is told coarsely.
    assert 6 <= len(plots.time) <= 7 + false
    for range_, bearing, snr in SHIPS:
        row, away = nearest(plots, range_, bearing)
        assert away < least * np.hypot(30.0, range_ * np.radians(2.4)) + 2.0
        place = plots.range[row] * np.exp(1j * plots.bearing[row])
        error = place - range_ * np.exp(1j * np.radians(bearing))
        offset = np.array([error.imag, error.real])  # east, north
        assert offset @ np.linalg.solve(plots.covariance[row], offset) < 16.0
        if bits > 4:
            assert plots.amplitude[row] == pytest.approx(snr, abs=2.5)
    assert (np.diff(plots.time) >= 0).all()
    assert found.details.cells.min() >= 3


@pytest.mark.parametrize('size', [1, 17, 128, 10_000])
def test_the_size_of_sectors_changes_no_place(pictures, size):
    picture = pictures.turned(pictures.make(SHIPS), 2)
    whole = extract([picture]).plots
    parts = extract(pictures.cut(picture, size)).plots
    for range_, bearing, _ in SHIPS:
        row, _ = nearest(whole, range_, bearing)
        away = nearest(parts, whole.range[row], np.degrees(whole.bearing[row]))[1]
        assert away < 3.0


def test_a_plot_comes_out_soon_after_the_beam(pictures):
    """Within an eighth of a revolution."""
    extraction = Extraction(VideoParameters(beam_width_deg=2.4, pulse_length_m=30.0))
    memory, late = extraction.start(), []
    for part in pictures.cut(pictures.turned(pictures.make(SHIPS), 2), 30):
        memory, found = extraction.step(memory, part)
        late += (part.time[-1] - found.plots.time).tolist()
    assert len(late) >= 5 and max(late) < 2.5 / 8


def test_own_level_of_each_place(pictures):
    """Rain lifts the level by 15 dB over a part of the picture: no plots there, a ship in it."""
    random = np.random.default_rng(8)
    picture = pictures.make([(2600.0, 100.0, 36.0), (900.0, 250.0, 25.0)])
    strength = picture.strength.astype(int)
    rain = np.zeros(strength.shape, bool)
    rain[200:320, 150:320] = True
    power = 10 ** (0.1 * 0.35 * (strength - 64.0))
    power = power + rain * 30.0 * random.exponential(size=strength.shape)
    strength = np.clip(64 + 10 * np.log10(power) / 0.35, 0, 255).astype(np.uint8)
    found = extract(pictures.cut(pictures.turned(picture._replace(strength=strength), 3), 128))
    assert nearest(found.plots, 2600.0, 100.0)[1] < 60
    assert len(found.plots.time) <= 3 * 2 + 6


def test_two_ships_apart_are_two_plots_and_one_is_one(pictures):
    near = pictures.make([(2000.0, 90.0, 30.0), (2000.0, 90.0 + 2.2 * 2.4, 29.0)])
    assert len(extract(pictures.cut(near, 128)).plots.time) == 2
    deep = pictures.make([(2000.0, 90.0, 30.0), (2100.0, 90.0, 29.0)])
    assert len(extract(pictures.cut(deep, 128)).plots.time) == 2
    assert len(extract(pictures.cut(pictures.make([(2000.0, 90.0, 45.0)]), 128)).plots.time) == 1


def test_land_is_no_plot_and_is_counted(pictures):
    picture = pictures.make([(1200.0, 200.0, 30.0)])
    picture.strength[300:420, 200:330] = 230
    found = extract(pictures.cut(pictures.turned(picture, 2), 128))
    assert found.counts[LAND] >= 1
    bearing = np.degrees(found.plots.bearing)
    inside = (bearing > 121) & (bearing < 167) & (found.plots.range > 2450)
    assert inside.sum() <= 2  # of 120 spokes by 130 samples
    assert nearest(found.plots, 1200.0, 200.0)[1] < 30


def test_another_radar_is_left_out_and_a_ship_in_its_spokes_stays(pictures):
    picture = pictures.make([(1800.0, 120.0, 28.0)])
    clean = extract(pictures.cut(picture, 128)).plots
    spoke = np.arange(0, 900, 3)
    picture.strength[spoke, (spoke * 7) % 395] = 220
    found = extract(pictures.cut(picture, 128))
    assert found.counts[LONE] > 200
    assert len(found.plots.time) == 1
    assert abs(found.plots.range[0] - clean.range[0]) < 3.0


def test_blind_range_and_blank_sectors_hold_no_plots(pictures):
    picture = pictures.make([(240.0, 30.0, 35.0), (2000.0, 181.0, 35.0), (2000.0, 300.0, 35.0)])
    found = extract(pictures.cut(picture, 128), blind_range_m=400.0, blank_sectors='170-190 355-4')
    assert np.degrees(found.plots.bearing) == pytest.approx([300.0], abs=0.3)
    assert found.counts == {} or NO_BEARING not in found.counts


def test_a_buoy_stays_where_it_is_across_a_change_of_range(pictures):
    """The scale comes from the spoke alone."""
    far = pictures.make([(1100.0, 77.0, 35.0)], range_step=12.0, seed=1)
    near = pictures.make([(1100.0, 77.0, 35.0)], range_step=6.0, pulse=15.0, seed=2)
    parts = [*pictures.cut(far, 128), *pictures.cut(near._replace(time=near.time + 2.5), 128)]
    plots = extract(parts).plots
    assert len(plots.time) == 2
    assert np.ptp(plots.range) < 2 * 12.0
    assert np.ptp(np.degrees(plots.bearing)) < 0.3


def test_a_range_that_changes_in_the_midst_of_an_echo_breaks_nothing(pictures):
    picture = pictures.make([(1500.0, 100.0, 35.0)])
    step = picture.range_step.copy()
    step[250:] = 24.0
    plots = extract(pictures.cut(picture._replace(range_step=step), 128)).plots
    assert len(plots.time) <= 2 and np.isfinite(plots.range).all()


@pytest.mark.parametrize('value', [0, 1, 200, 255])
def test_a_picture_of_one_strength_holds_nothing(pictures, value):
    picture = pictures.make()
    flat = picture._replace(strength=np.full_like(picture.strength, value))
    assert not len(extract(pictures.cut(pictures.turned(flat, 2), 128)).plots.time)


def test_noise_alone_gives_cells_at_the_rate_asked_for(pictures):
    from marine_tracker.video import detection, stack, tail

    asked = 1e-3
    hits = cells = 0
    known, held = tail.start(1), None
    for seed in range(6):
        held = stack.measured(stack.begun(pictures.make(seed=seed)), np.radians(2.4), 30.0, True)
        held, known, _, _ = detection.decide(held, len(held.mean), known, 255, asked, 0)
        if seed:
            hits += held.hits.sum()
            cells += held.hits.size
    assert asked / 1.5 < hits / cells < 1.5 * asked


def test_missing_spokes_make_no_echo(pictures):
    picture = pictures.make(SHIPS)
    keep = np.ones(900, bool)
    keep[300:520] = False
    part = Spokes(
        picture.time[keep],
        picture.bearing[keep],
        picture.range_step[keep],
        picture.strength[keep],
        picture.own_ship,
    )
    plots = extract(pictures.cut(part, 128)).plots
    assert len(plots.time) in (2, 3)
    bearing = np.degrees(plots.bearing)
    assert not ((bearing > 120) & (bearing < 208)).any()
