"""The parameters of the plot extractor."""

import math
from dataclasses import dataclass

from .description import check, parameter


@dataclass(frozen=True)
class VideoParameters:
    """The parameters of the extraction of plots from radar video, in process and as a node."""

    false_alarms_per_million: float = parameter(
        10.0,
        'Of a million cells with noise or clutter alone, how many may count as echoes.',
        low=0.001,
        high=100000.0,
        live=True,
    )
    beam_width_deg: float = parameter(
        2.0,
        'Horizontal beam width of the antenna, one way, at half power.',
        unit='deg',
        low=0.1,
        high=30.0,
        live=True,
    )
    pulse_length_m: float = parameter(
        0.0,
        'Depth of the echo of a point, at half power; 0: two samples of the video, and 7.5 m at '
        'least.',
        unit='m',
        low=0.0,
        high=1000.0,
        live=True,
    )
    blind_range_m: float = parameter(
        0.0,
        'Nothing nearer than this is an echo: the transmitted pulse.',
        unit='m',
        low=0.0,
        high=10000.0,
        live=True,
    )
    blank_sectors: str = parameter(
        '',
        'Sectors that own ship hides, in degrees clockwise from the bow, as "170-190 350-5". They '
        'count as not swept.',
        live=True,
    )
    max_size_m: float = parameter(
        450.0,
        'Longest ship; echoes that hang together over more are land, and give no plot.',
        unit='m',
        low=10.0,
        high=10000.0,
        live=True,
    )
    range_offset_m: float = parameter(
        0.0,
        'Added to every range: by how much the radar measures too near.',
        unit='m',
        low=-1000.0,
        high=1000.0,
        live=True,
    )
    doppler_codes: bool = parameter(
        False,
        'Whether the two highest strengths tell a Doppler shift, receding and approaching; else '
        'they are strong echoes.',
        live=True,
    )

    @property
    def false_alarm_rate(self) -> float:
        """Probability that a cell with noise or clutter alone counts as an echo."""
        return 1e-6 * self.false_alarms_per_million

    def __post_init__(self) -> None:
        check(self)
        blanks(self.blank_sectors)


@dataclass(frozen=True)
class PlotExtractorParameters:
    """The parameters of the plot extractor node, beside those of the extraction."""

    sectors: int = parameter(
        1,
        'Messages of plots in a revolution: 1, or more where the tracker takes sectors.',
        low=1,
        high=64,
    )
    image_size: int = parameter(
        1024, 'Width and height of `radar/image`.', unit='pixels', low=64, high=4096
    )

    def __post_init__(self) -> None:
        check(self)


def blanks(text: str) -> tuple[tuple[float, float], ...]:
    """Sectors of `blank_sectors`, rad from and to, clockwise; ValueError where it is none."""
    sectors = []
    for word in text.split():
        start, dash, end = word.partition('-')
        try:
            first, last = float(start), float(end)
        except ValueError:
            first = last = math.nan
        if not (dash and 0 <= first <= 360 and 0 <= last <= 360):
            raise ValueError(
                f'parameter blank_sectors has {word[:40]!r}; it must be two numbers from 0 to '
                '360, as 170-190'
            )
        sectors.append((math.radians(first), math.radians(last)))
    return tuple(sectors)
