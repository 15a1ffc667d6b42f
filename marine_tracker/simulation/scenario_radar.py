"""The radar of a scenario file, and its false plots."""

import math
from typing import NamedTuple

from ..geometry import NAUTICAL_MILE
from . import video_settings
from .fields import Section
from .video_settings import VideoSettings

MAX_RANGE = 200_000.0  # m
MAX_SECTORS = 64  # messages a revolution

RADAR_KEYS = (
    'rotation_rpm max_range_m|max_range_nm blind_range_m|blind_range_nm '
    'range_sigma_m|range_sigma_nm bearing_sigma_deg range_bias_m|range_bias_nm '
    'bearing_bias_deg range_resolution_m|range_resolution_nm beam_width_deg '
    'pd_near pd_far sensor_errors radial_speed_sigma_mps|radial_speed_sigma_kn '
    'max_radial_speed_mps|max_radial_speed_kn sectors video'
)
CLUTTER_KEYS = 'uniform sea sea_scale_m|sea_scale_nm'


class ScenarioRadar(NamedTuple):
    """The simulated radar.

    rotation            rpm, antenna; the beam passes true north at the start of a revolution
    max_range, blind_range  m; targets beyond the first or nearer than the second are not seen
    range_sigma         m, Gaussian noise of a plot (not used with sensor_errors 'imo')
    bearing_sigma       rad, likewise
    range_bias, bearing_bias  m, rad; constant errors
    range_resolution    m, and
    beam_width          rad: targets closer than both in one revolution give one plot
    pd_near, pd_far     probability of detection at range 0 and at the maximum range
    sensor_errors       'none' or 'imo'
    radial_speed_sigma  m/s, Gaussian noise of a plot's radial speed over ground; None: no Doppler
    max_radial_speed    m/s; noise plots have radial speeds evenly between it and its negative
    sectors             number of messages in which the plots of a revolution are sent
    video               the picture of a radar that gives spokes (video_settings.py); None: plots
    """

    rotation: float
    max_range: float
    blind_range: float
    range_sigma: float
    bearing_sigma: float
    range_bias: float
    bearing_bias: float
    range_resolution: float
    beam_width: float
    pd_near: float
    pd_far: float
    sensor_errors: str
    radial_speed_sigma: float | None = None
    max_radial_speed: float = 25.0
    sectors: int = 1
    video: VideoSettings | None = None

    @property
    def scan_period(self) -> float:
        """Time of one revolution, s."""
        return 60.0 / self.rotation


class Clutter(NamedTuple):
    """False plots: mean numbers a revolution, and how fast sea clutter decreases with range.

    uniform    evenly over the area between blind and maximum range
    sea        from the waves, evenly in bearing; the number per metre of range falls as
               exp(-range / sea_scale), so the number per area falls faster
    sea_scale  m
    """

    uniform: float
    sea: float
    sea_scale: float


def read_radar(section: Section) -> ScenarioRadar:
    """The radar of the section; ValueError names place, value and limit."""
    errors = section.choice('sensor_errors', ('none', 'imo'), 'none')
    if errors == 'imo':
        for key in ('range_sigma', 'bearing_sigma'):
            if any(k.startswith(key) for k in section.values):
                raise ValueError(
                    f'radar has {key} beside sensor_errors: imo, which states all '
                    'noise; leave one out'
                )
    pd_near = section.number('pd_near', 0.01, 1.0, 0.98)
    radar = ScenarioRadar(
        section.number('rotation_rpm', 1.0, 300.0, 22.0),
        section.length('max_range', 100.0, MAX_RANGE, 12 * NAUTICAL_MILE),
        section.length('blind_range', 0.0, 10000.0, 50.0),
        section.length('range_sigma', 0.0, 1000.0, 15.0),
        math.radians(section.number('bearing_sigma_deg', 0.0, 10.0, 0.5)),
        section.length('range_bias', -1000.0, 1000.0, 0.0),
        math.radians(section.number('bearing_bias_deg', -10.0, 10.0, 0.0)),
        section.length('range_resolution', 0.0, 1000.0, 30.0),
        math.radians(section.number('beam_width_deg', 0.0, 30.0, 1.0)),
        pd_near,
        section.number('pd_far', 0.01, 1.0, min(0.8, pd_near)),
        errors,
        (
            section.speed('radial_speed_sigma', 0.0, 10.0)
            if section.has('radial_speed_sigma')
            else None
        ),
        section.speed('max_radial_speed', 1.0, 100.0, 25.0),
        section.whole('sectors', 1, MAX_SECTORS, 1),
        video_settings.read(section),
    )
    if radar.video is not None and min(radar.range_resolution, radar.beam_width) <= 0:
        raise ValueError('radar.video needs a range_resolution and a beam_width above 0')
    if radar.blind_range >= radar.max_range:
        raise ValueError(
            f'radar.blind_range is {radar.blind_range:g} m; it must be below '
            f'max_range, {radar.max_range:g} m'
        )
    if section.has('max_radial_speed') and radar.radial_speed_sigma is None:
        raise ValueError('radar has max_radial_speed, but no radial_speed_sigma: give both or none')
    if radar.pd_far > radar.pd_near:
        raise ValueError(
            f'radar.pd_far is {radar.pd_far:g}; it must not exceed pd_near, {radar.pd_near:g}'
        )
    return radar


def read_clutter(section: Section, radar: ScenarioRadar) -> Clutter:
    """The false plots of the section; ValueError likewise."""
    return Clutter(
        section.number('uniform', 0.0, 100000.0, 0.0),
        section.number('sea', 0.0, 100000.0, 0.0),
        section.length('sea_scale', 10.0, radar.max_range, min(NAUTICAL_MILE, radar.max_range)),
    )
