"""What others fell into with radar video; each as a situation of its own."""

import numpy as np
import pytest

from marine_tracker.parameters import VideoParameters
from marine_tracker.types import OwnShip, Sweep
from marine_tracker.video import picture
from marine_tracker.video.chain import Chain, run
from marine_tracker.video.extraction import Extraction
from marine_tracker.video.found import together

BEAM, PULSE = 2.4, 30.0
PARAMETERS = VideoParameters(beam_width_deg=BEAM, pulse_length_m=PULSE)


def at_rest(*_):
    return OwnShip(np.array([0.0, 99.0]), np.zeros((2, 2)), np.zeros((2, 2)))


def as_sweep(spokes, heading):
    samples = spokes.strength.shape[1]
    return Sweep(
        spokes.time,
        np.mod(spokes.bearing - heading, 2 * np.pi),
        np.broadcast_to(heading, spokes.time.shape).astype(float),
        spokes.range_step * samples,
        spokes.strength,
    )


def plots_of(pictures, revolutions, size=128):
    """Plots of revolutions of spokes."""
    extraction = Extraction(PARAMETERS)
    memory, found = extraction.start(), []
    for revolution in revolutions:
        for part in pictures.cut(revolution, size):
            memory, one = extraction.step(memory, part)
            found.append(one)
    memory, one = extraction.end(memory)
    return together([*found, one])


def test_a_buoys_plots_scatter_in_a_turn_as_at_rest(pictures):
    """Own ship turns at 6 degrees a second; her heading is told once a second, for all spokes."""
    spread = []
    for rate in (0.0, 6.0):
        sweeps = []
        for k in range(8):
            one = pictures.make([(2400.0, 130.0, 30.0)], seed=k)
            one = one._replace(time=one.time + 2.5 * k)
            true = np.radians(20.0 + rate * one.time)
            told = np.radians(20.0 + rate * np.floor(one.time))
            sweep = as_sweep(one, true)._replace(heading=np.mod(told, 2 * np.pi))
            sweeps += [Sweep(*(c[a : a + 90] for c in sweep)) for a in range(0, 900, 90)]
        scans = list(run(Chain(PARAMETERS), sweeps, at_rest))
        bearing = np.concatenate([scan.plots.bearing for scan in scans[1:]])
        assert len(bearing) >= 6
        spread.append(np.degrees(bearing).std())
        assert np.degrees(bearing).mean() == pytest.approx(130.0, abs=0.2)
    assert spread[1] < spread[0] + 0.05


@pytest.mark.parametrize('factor', [2, 4])
def test_a_spoke_that_reaches_farther_shows_a_buoy_in_the_same_place(pictures, factor):
    """As many samples over twice the range: each has its own scale."""
    near = pictures.make([(1800.0, 60.0, 35.0)], range_step=6.0)
    far = pictures.make([(1800.0, 60.0, 35.0)], range_step=6.0 * factor)
    far = far._replace(time=far.time + 2.5)
    plots = plots_of(pictures, [near, far]).plots
    assert len(plots.range) == 2 and np.ptp(plots.range) < 2 * 6.0 * factor


def test_spokes_that_get_shorter_leave_no_ring(pictures):
    long_ = pictures.make([(4500.0, 30.0, 35.0)], samples=400)
    short = pictures.make([(900.0, 30.0, 35.0)], samples=200)
    polar = picture.painted(picture.start(), long_)
    polar = picture.painted(polar, short._replace(time=short.time + 2.5))
    shown = picture.north_up(polar, 400, 5.0)
    axis = (np.arange(400) - 199.5) / 200 * 2400.0
    away = np.hypot(*np.meshgrid(axis, axis))
    assert shown[away < 2300].max() > 100 and not shown[away > 2420].any()


def test_what_was_not_swept_is_empty_and_fades(pictures):
    spokes = pictures.make([(2000.0, 30.0, 35.0)])
    half = next(pictures.cut(spokes, 450))
    polar = picture.painted(picture.start(), half)
    shown = picture.north_up(polar, 300, 1.2)
    assert shown[:, 160:].any() and not shown[:, :140].any()
    assert not picture.north_up(polar, 300, 20.0).any()


@pytest.mark.parametrize('on', [False, True])
def test_the_top_codes_are_strong_echoes_until_the_mode_is_told(pictures, on):
    spokes = pictures.make([(2000.0, 90.0, 40.0), (2500.0, 200.0, 40.0)], bits=4)
    top = spokes.strength >= 13
    spokes.strength[top] = 13
    spokes.strength[:500][top[:500]] = 15  # approaches
    spokes.strength[500:][top[500:]] = 14  # recedes
    extraction = Extraction(
        VideoParameters(beam_width_deg=BEAM, pulse_length_m=PULSE, doppler_codes=on)
    )
    memory, first = extraction.step(extraction.start(), spokes)
    _, last = extraction.end(memory)
    found = together([first, last])
    order = np.argsort(found.plots.range)
    assert found.plots.range[order] == pytest.approx([2000.0, 2500.0], abs=20)
    doppler = found.details.doppler[order]
    assert np.sign(doppler).tolist() == ([-1.0, 1.0] if on else [0.0, 0.0])


def test_a_fast_boat_is_seen_as_often_among_interference_as_without(pictures):
    """40 kn at 24 rpm: 51 m a revolution. Nothing asks for it at the same place again."""
    seen = {}
    for others in (False, True):
        turns = []
        for k in range(12):
            one = pictures.make([(3000.0 - 51.4 * k, 75.0, 20.0)], seed=40 + k)
            if others:
                spoke = np.arange(k % 2, 900, 2)
                one.strength[spoke, (spoke * 11 + 37 * k) % 398] = 210
            turns.append(one._replace(time=one.time + 2.5 * k))
        plots = plots_of(pictures, turns).plots
        near = np.abs(np.degrees(plots.bearing) - 75.0) < 1.0
        seen[others] = near.sum()
        assert len(plots.range) <= seen[others] + 2
    assert seen[False] >= 11 and seen[True] >= seen[False] - 1


def test_without_a_heading_there_is_no_plot_and_the_reason_is_told(pictures):
    one = pictures.make([(2000.0, 30.0, 35.0)])
    sweep = as_sweep(one, 0.0)._replace(heading=np.full(900, np.nan))
    memory, done = Chain(PARAMETERS).step(Chain(PARAMETERS).start(), sweep, at_rest())
    assert not sum(len(found.plots.time) for found in done.found)
    assert done.counts['spokes without a heading'] == 900


def test_the_time_of_plots_is_that_of_the_spokes_however_they_come(pictures):
    """Even turns, sent one by one, or five at once."""
    turns = pictures.turned(pictures.make([(2000.0, 210.0, 35.0)]), 5)
    times = []
    for size in (100, 4500):
        sweeps = [as_sweep(part, 0.4) for part in pictures.cut(turns, size)]
        scans = list(run(Chain(PARAMETERS), sweeps, at_rest))
        times.append(np.concatenate([scan.plots.time for scan in scans]))
    assert times[0] == pytest.approx(times[1], abs=1e-3)
    assert np.diff(times[0]) == pytest.approx(2.5, abs=0.01)
