"""The radar picture of a scenario file: `radar: {video: true}`, or with settings of its own:

radar:
  range_resolution_m: 30          # of the pulse
  beam_width_deg: 1.2
  video:
    spokes: 2048                  # in a revolution
    samples: 1024                 # in a spoke
    bits: 8                       # 4, 8 or 16, over 80 dB
    sea_state: 4                  # 0 to 8; 0 is no sea clutter
    interference: 2               # other radars about
    power_kw: 25                  # of the transmitter
    swerling: 1                   # 1 or 3: how the echoes of ships fluctuate
    rain:
      - {start: {north_nm: 2, east_nm: 1}, radius_nm: 1.5, rate_mm_per_h: 10,
         course_deg: 80, speed_kn: 20}
"""

import math
from typing import NamedTuple

from ..files import shown
from ..geometry import unit_vector
from ..types import Array
from .fields import Section

KEYS = 'spokes samples bits sea_state interference power_kw swerling rain'
RAIN_KEYS = 'start radius_m|radius_nm rate_mm_per_h course_deg speed_kn|speed_mps'
START_KEYS = 'north_m|north_nm east_m|east_nm'
FARTHEST = 200_000.0  # m
MOST_SPOKES, MOST_SAMPLES = 8192, 8192


class Rain(NamedTuple):
    """A shower: where it is at the start [2] m, velocity [2] m/s, radius m, rate mm/h."""

    place: Array
    velocity: Array
    radius: float
    rate: float


class VideoSettings(NamedTuple):
    """The picture; see the module. `power` W."""

    spokes: int
    samples: int
    bits: int
    sea_state: float
    interference: int
    power: float
    swerling: int
    rain: tuple[Rain, ...]


def read(radar: Section) -> VideoSettings | None:
    """The settings under `radar`; None where there is no video. ValueError names what is wrong."""
    value = radar.values.get('video', False)
    if value is False:
        return None
    section = Section({} if value is True else value, 'radar.video', KEYS)
    return VideoSettings(
        section.whole('spokes', 64, MOST_SPOKES, 2048),
        section.whole('samples', 16, MOST_SAMPLES, 1024),
        _one_of(section, 'bits', (4, 8, 16), 8),
        section.number('sea_state', 0.0, 8.0, 0.0),
        section.whole('interference', 0, 20, 0),
        1e3 * section.number('power_kw', 0.01, 100.0, 25.0),
        _one_of(section, 'swerling', (1, 3), 1),
        tuple(
            _rain(Section(item, f'radar.video.rain[{k}]', RAIN_KEYS))
            for k, item in enumerate(section.items('rain'))
        ),
    )


def _one_of(section: Section, key: str, choices: tuple[int, ...], default: int) -> int:
    value = section.values.get(key, default)
    if value not in choices or isinstance(value, bool):
        words = ', '.join(map(str, choices))
        raise ValueError(f'{section.place(key)} is {shown(value)}; it must be one of {words}')
    return int(value)


def _rain(section: Section) -> Rain:
    start = section.section('start', START_KEYS)
    place = [start.length(stem, -FARTHEST, FARTHEST) for stem in ('east', 'north')]
    speed = section.speed('speed', 0.0, 50.0, 0.0)
    course = section.number('course_deg', -360.0, 360.0, 0.0)
    return Rain(
        place=_array(place),
        velocity=speed * unit_vector(math.radians(course)),
        radius=section.length('radius', 1.0, FARTHEST),
        rate=section.number('rate_mm_per_h', 0.1, 200.0, 5.0),
    )


def _array(values: list[float]) -> Array:
    return 0.0 * unit_vector(0.0) + values
