import math
import re

import numpy as np
import pytest

from marine_tracker.parameters import VideoParameters
from marine_tracker.video import picture
from marine_tracker.video.explain import explain
from marine_tracker.video.extraction import Extraction


@pytest.fixture
def asked(pictures):
    """Why at a range and bearing, in a picture that was seen twice."""

    def ask(range_, bearing, spokes=None, echoes=(), **parameters):
        spokes = pictures.make(echoes, spokes=2048) if spokes is None else spokes
        values = {'beam_width_deg': 2.4, 'pulse_length_m': 30.0, **parameters}
        extraction = Extraction(VideoParameters(**values))
        memory, polar = extraction.start(), picture.start()
        for part in pictures.cut(pictures.turned(spokes, 2), 256):
            memory, _ = extraction.step(memory, part)
            polar = picture.painted(polar, part)
        return explain(polar, memory, extraction, range_, math.radians(bearing), 0.0, 5.0)

    return ask


def test_a_plot_is_told_with_its_strength(asked):
    first = asked(2000.0, 77.0, echoes=[(2000.0, 77.0, 30.0)])[0]
    assert not first.decides
    told = re.search(r'a plot comes from there, (\d+) dB', first.text)
    assert int(told.group(1)) == pytest.approx(30, abs=2)


def test_noise_is_below_its_level(asked):
    first = asked(2000.0, 77.0)[0]
    assert first.decides and 'it is below' in first.text and 'of 255' in first.text


@pytest.mark.parametrize(
    ('range_', 'bearing', 'words'),
    [
        (9000.0, 77.0, 'ends at 4800 m'),
        (100.0, 77.0, 'blind_range_m, 300 m'),
        (2000.0, 185.0, 'blank sector'),
    ],
)
def test_what_is_not_looked_at_is_named(asked, range_, bearing, words):
    (why,) = asked(range_, bearing, blind_range_m=300.0, blank_sectors='170-190')
    assert why.decides and words in why.text


def test_land_is_named(asked, pictures):
    spokes = pictures.make(spokes=2048)
    spokes.strength[300:700, 200:330] = np.random.default_rng(1).integers(225, 240, (400, 130))
    (first, *_) = asked(2500.0, 360 * 330 / 2048, spokes)
    assert first.decides and ('counts as land' in first.text or 'it is below' in first.text)


def test_a_direction_without_spokes_is_named(asked, pictures):
    spokes = pictures.make(spokes=2048)
    some = spokes._replace(**{k: getattr(spokes, k)[:1000] for k in spokes._fields[:4]})
    (why,) = asked(2000.0, 300.0, some)
    assert why.decides and 'no spoke in that direction' in why.text


def test_the_radars_own_control_is_named(asked, pictures):
    """Sea or rain control is on: all weak echoes are gone before the video comes."""
    spokes = pictures.make([(2000.0, 77.0, 12.0)], spokes=2048, floor=0.0)
    spokes.strength[spokes.strength < 60] = 0
    said = asked(2000.0, 77.0, spokes)
    assert any("the radar's own gain, sea or rain control" in why.text for why in said)
