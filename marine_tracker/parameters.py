"""Every parameter of every node, described once: default, unit, limits, meaning.

ROS descriptors, the YAML files in config/, doc/parameters.md and the checks of the command line
all derive from the frozen dataclasses here. A wrong value raises ValueError at construction and
names the parameter, the value and the limit.
"""

import dataclasses
import difflib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import yaml

VESSEL_CLASSES = ('ship', 'small_craft')
# m: how far the point of a target that echoes strays from its middle, each axis, by vessel class.
GLINT_SIGMA = {'ship': 25.0, 'small_craft': 0.0}
EXTENTS = ('off', 'random_matrix', 'gp')


def parameter(default, text, *, unit='', low=None, high=None, choices=(), live=False):
    """A dataclass field with its description.

    low, high  inclusive limits of a number; choices  the values a string may take;
    live       may be changed while the node runs.
    """
    return dataclasses.field(
        default=default,
        metadata={
            'text': text,
            'unit': unit,
            'low': low,
            'high': high,
            'choices': choices,
            'live': live,
        },
    )


def check(parameters) -> None:
    """Raise ValueError for the first field with a wrong type, or outside its limits or choices."""
    for field in dataclasses.fields(parameters):
        kind: Any = field.type
        value, about = getattr(parameters, field.name), field.metadata
        if kind is float and type(value) is int:
            value = float(value)
            object.__setattr__(parameters, field.name, value)
        if value is False and 'off' in about['choices']:  # how YAML reads it
            value = 'off'
            object.__setattr__(parameters, field.name, value)
        if type(value) is not kind:
            raise ValueError(
                f'parameter {field.name} is {value!r}, a {type(value).__name__}; '
                f'it must be a {kind.__name__}'
            )
        if isinstance(value, float) and not math.isfinite(value):
            raise ValueError(f'parameter {field.name} is {value}; it must be finite')
        low, high = about['low'], about['high']
        if (low is not None and value < low) or (high is not None and value > high):
            raise ValueError(
                f'parameter {field.name} is {value:g} {about["unit"]}'.rstrip()
                + f'; it must be between {low:g} and {high:g}'
            )
        if about['choices'] and value not in about['choices']:
            raise ValueError(
                f'parameter {field.name} is {value!r}; '
                f'it must be one of {", ".join(about["choices"])}'
            )


P = TypeVar('P')


def from_mapping(kind: type[P], values: Mapping[str, Any]) -> P:
    """A parameter object from a mapping; an unknown key is an error that names its neighbours."""
    return from_mappings((kind,), values)[0]


def from_mappings(kinds: Sequence[type], values: Mapping[str, Any]) -> tuple[Any, ...]:
    """Parameter objects of several kinds, whose names all differ, from one mapping."""
    known = {field.name: kind for kind in kinds for field in dataclasses.fields(kind)}
    for name in values:
        if name not in known:
            near = difflib.get_close_matches(str(name), known, 1)
            hint = f'; did you mean {near[0]}?' if near else ''
            raise ValueError(f'unknown parameter {name}{hint}')
    return tuple(
        kind(**{name: value for name, value in values.items() if known[name] is kind})
        for kind in kinds
    )


def read_yaml_mapping(path) -> dict[str, Any]:
    """A YAML file that holds one mapping (empty counts as none); errors name the file."""
    with open(path) as file:
        try:
            values = yaml.safe_load(file)
        except yaml.YAMLError as error:
            raise ValueError(f'{path} is not YAML: {error}') from error
    if values is None:
        return {}
    if not isinstance(values, dict):
        raise ValueError(f'{path} holds a {type(values).__name__}; it must hold a mapping')
    return values


@dataclass(frozen=True)
class TrackerParameters:
    """The tracker's parameters, in process and as a node."""

    estimator: str = parameter(
        'gwnn',
        'Filter that extrapolates and updates the tracks.',
        choices=(
            'cs_kalman',
            'imm',
            'gwnn',
            'gwnn_paper',
            'cs_rough_nn',
            'cs_bp_nn',
            'wavelet_cs',
            'alpha_beta',
        ),
        live=True,
    )
    gwnn_weights: str = parameter(
        '',
        'Weights of the estimator gwnn, a file of `marine_tracker train gwnn`; empty: those '
        'shipped.',
        live=True,
    )
    gwnn_learning: bool = parameter(
        False,
        'Whether each track of the estimator gwnn adds to the output weights what its own '
        'plots tell.',
    )
    alpha_beta_mode: str = parameter(
        'hf_soft',
        'How the estimator alpha_beta weighs a plot: as paper 002 does (hf), the same '
        'with softer weights (hf_soft), or as its two rivals.',
        choices=('hf_soft', 'hf', 'method1', 'method2'),
        live=True,
    )
    vessel_class: str = parameter(
        'ship',
        'Preset of the motion models: how hard targets are expected to manoeuvre.',
        choices=VESSEL_CLASSES,
        live=True,
    )
    range_sigma_m: float = parameter(
        15.0, 'Standard deviation of a measured range.', unit='m', low=0.1, high=1000.0, live=True
    )
    bearing_sigma_deg: float = parameter(
        0.5, 'Standard deviation of a measured bearing.', unit='deg', low=0.01, high=10.0, live=True
    )
    radial_speed_sigma_mps: float = parameter(
        0.5,
        'Standard deviation of a measured radial speed, where the radar tells one (Doppler).',
        unit='m/s',
        low=0.01,
        high=10.0,
        live=True,
    )
    glint_sigma_m: float = parameter(
        -1.0,
        'Standard deviation of the point of a target that echoes, about its middle, along '
        'each axis: some 0.15 of the length of large ships. Below 0: that of the vessel class, '
        f'{GLINT_SIGMA["ship"]:g} m for ships, {GLINT_SIGMA["small_craft"]:g} for small craft.',
        unit='m',
        low=-1.0,
        high=100.0,
        live=True,
    )
    radars: str = parameter(
        '',
        'Radars whose plots are fused: a list in YAML, see doc/two_radars.md; empty: one, on '
        '`radar/plots`.',
    )
    extent: str = parameter(
        'off',
        'Whether echoes that touch are one target with length and heading: off, by an '
        'ellipse (random_matrix), close by also by an outline (gp); see doc/extended_targets.md.',
        choices=EXTENTS,
        live=True,
    )
    range_resolution_m: float = parameter(
        30.0,
        'Depth of a radar cell: echoes of one target lie no farther apart; for extent.',
        unit='m',
        low=1.0,
        high=1000.0,
        live=True,
    )
    beam_width_deg: float = parameter(
        1.0,
        'Horizontal beam width of the antenna, which is that of a cell; for extent.',
        unit='deg',
        low=0.1,
        high=30.0,
        live=True,
    )
    max_target_speed_mps: float = parameter(
        25.0,
        'Fastest target over ground that initiation accepts.',
        unit='m/s',
        low=0.5,
        high=100.0,
        live=True,
    )
    min_range_m: float = parameter(
        0.0,
        'Nearest range the radar sees; a track nearer than this is not expected to show.',
        unit='m',
        low=0.0,
        high=10000.0,
        live=True,
    )
    max_range_m: float = parameter(
        50000.0,
        'Farthest range the radar sees; a track beyond it has left by range.',
        unit='m',
        low=100.0,
        high=200000.0,
        live=True,
    )
    scan_period_s: float = parameter(
        60.0 / 22.0,
        'Time of one antenna revolution, where the plots do not tell (22 rpm).',
        unit='s',
        low=0.2,
        high=120.0,
    )
    gate_probability: float = parameter(
        0.995,
        'Probability that the gate holds the plot of a track.',
        low=0.5,
        high=0.999999,
        live=True,
    )
    doppler_gate: bool = parameter(
        True,
        'Whether a plot must have the radial speed over ground that its track expects, where '
        'the radar tells it.',
        live=True,
    )
    detection_probability: float = parameter(
        0.85,
        'Probability that a target gives a plot, as the track score assumes it.',
        low=0.1,
        high=0.99,
        live=True,
    )
    confirm_hits: int = parameter(
        3, 'M of M-of-N confirmation: plots needed ...', low=2, high=20, live=True
    )
    confirm_scans: int = parameter(
        5, 'N of M-of-N confirmation: ... within this many scans.', low=2, high=20, live=True
    )
    confirm_score: float = parameter(
        8.0,
        'Track score (log-odds against clutter) that confirmation needs as well.',
        low=-10.0,
        high=50.0,
        live=True,
    )
    max_score: float = parameter(
        15.3,
        'Cap of the track score: how long a good track outlives its plots. A miss costs '
        '-ln(1 - detection_probability); a confirmed track is lost below 0.',
        low=1.0,
        high=100.0,
        live=True,
    )
    hold_hits: int = parameter(
        1,
        'A confirmed track is lost when its last 10 scans held fewer plots than this.',
        low=1,
        high=10,
        live=True,
    )
    max_drift: float = parameter(
        4.9,
        'A coasting track is lost when its position has grown this many times less certain '
        'than a plot.',
        low=1.0,
        high=1000.0,
        live=True,
    )
    max_tracks: int = parameter(
        2000,
        'Most tracks held, tentative ones included; no new ones are initiated beyond it.',
        low=1,
        high=100000,
        live=True,
    )
    max_plots: int = parameter(
        10000,
        'Most plots taken from one scan; the strongest are kept, the rest counted.',
        low=1,
        high=1000000,
        live=True,
    )
    own_ship_timeout_s: float = parameter(
        10.0, 'Own-ship data older than this count as missing.', unit='s', low=0.1, high=600.0
    )

    def __post_init__(self):
        check(self)
        if self.confirm_hits > self.confirm_scans:
            raise ValueError(
                f'parameter confirm_hits is {self.confirm_hits}; it must not exceed '
                f'confirm_scans, {self.confirm_scans}'
            )
        if self.min_range_m >= self.max_range_m:
            raise ValueError(
                f'parameter min_range_m is {self.min_range_m:g} m; it must be below '
                f'max_range_m, {self.max_range_m:g} m'
            )
        if self.extent != 'off' and self.radars:
            raise ValueError(
                f'parameter extent is {self.extent}; with several radars it must be off'
            )

    @property
    def glint_sigma(self) -> float:
        """m: glint_sigma_m, or where that is below 0 that of the vessel class."""
        return GLINT_SIGMA[self.vessel_class] if self.glint_sigma_m < 0 else self.glint_sigma_m


@dataclass(frozen=True)
class ArpaParameters:
    """What the tracker node makes of the tracks: targets, their approach, alarms."""

    cpa_limit_nm: float = parameter(
        0.5,
        'A target is dangerous when its CPA is below this ...',
        unit='NM',
        low=0.01,
        high=20.0,
        live=True,
    )
    tcpa_limit_min: float = parameter(
        12.0,
        '... and comes within this time. The same for all targets.',
        unit='min',
        low=0.1,
        high=120.0,
        live=True,
    )
    acquisition: str = parameter(
        'everywhere',
        'Where confirmed tracks become targets by themselves: everywhere, in guard '
        'zones, or nowhere (then by `acquire` only).',
        choices=('everywhere', 'zones', 'nowhere'),
        live=True,
    )
    zones: str = parameter(
        '', 'Guard and exclusion zones: a list in YAML, see doc/arpa.md; empty: none.', live=True
    )
    max_targets: int = parameter(
        200, 'Most targets; the near and dangerous ones come first.', low=1, high=10000, live=True
    )
    click_radius_m: float = parameter(
        500.0,
        'How far from a clicked point its track may be.',
        unit='m',
        low=1.0,
        high=20000.0,
        live=True,
    )
    click_wait_s: float = parameter(
        20.0,
        'How long a click waits for a track to appear there.',
        unit='s',
        low=0.0,
        high=600.0,
        live=True,
    )
    past_positions: int = parameter(
        8, 'Past positions of each target that are shown.', low=4, high=100
    )
    past_interval_s: float = parameter(
        30.0, 'Time between two past positions.', unit='s', low=1.0, high=3600.0
    )
    vector_time_min: float = parameter(
        6.0, 'Length of the vectors on `markers`.', unit='min', low=0.1, high=120.0, live=True
    )
    vectors: str = parameter(
        'true',
        'Vectors and past positions on `markers`: true or relative to own ship.',
        choices=('true', 'relative'),
        live=True,
    )
    current_set_deg: float = parameter(
        0.0,
        'Where the current sets, true; with a drift above 0 courses and speeds are through '
        'the water (sea stabilised), else over ground.',
        unit='deg',
        low=0.0,
        high=360.0,
        live=True,
    )
    current_drift_kn: float = parameter(
        0.0, 'Speed of the current.', unit='kn', low=0.0, high=20.0, live=True
    )
    trial_course_deg: float = parameter(
        0.0,
        'Trial manoeuvre: course of own ship, stabilised as the targets are.',
        unit='deg',
        low=0.0,
        high=360.0,
        live=True,
    )
    trial_speed_kn: float = parameter(
        10.0,
        'Trial manoeuvre: speed of own ship, stabilised likewise.',
        unit='kn',
        low=0.0,
        high=100.0,
        live=True,
    )
    trial_delay_min: float = parameter(
        0.0, 'Trial manoeuvre: time until it begins.', unit='min', low=0.0, high=60.0, live=True
    )
    trial_turn_rate_deg_min: float = parameter(
        30.0,
        'Trial manoeuvre: how fast own ship turns.',
        unit='deg/min',
        low=1.0,
        high=3600.0,
        live=True,
    )
    trial_acceleration_mps2: float = parameter(
        0.02,
        'Trial manoeuvre: how fast own ship gains or loses speed.',
        unit='m/s^2',
        low=0.001,
        high=10.0,
        live=True,
    )
    sensor_timeout_s: float = parameter(
        10.0,
        'An alarm tells when heading, position or plots are missing for so long.',
        unit='s',
        low=0.5,
        high=600.0,
        live=True,
    )

    def __post_init__(self):
        check(self)


@dataclass(frozen=True)
class RadarSimulatorParameters:
    """The radar simulator node's parameters; what the radar is stands in the scenario file."""

    scenario: str = parameter('paper_track', 'A shipped scenario by name, or a scenario file.')
    rate: float = parameter(
        1.0,
        'Simulated seconds in a second; other than 1 needs use_sim_time in the other nodes.',
        low=0.01,
        high=1000.0,
    )
    seed: int = parameter(
        1, 'Seed of every random number: same seed, same plots.', low=0, high=2**31 - 1
    )
    begin_at_s: float = parameter(
        0.0,
        'Stamp at which the scenario begins: two radars of one scene have the same, and one '
        'that starts later leaves out what is past. 0: when the node starts.',
        unit='s',
        low=0.0,
        high=1e10,
    )
    loop: bool = parameter(False, 'Begin again when the scenario has ended.')

    def __post_init__(self):
        check(self)


@dataclass(frozen=True)
class RecordingPlayerParameters:
    """The recording player node's parameters."""

    folder: str = parameter('', 'Folder of a recording: plots.csv, own_ship.csv, truth.csv.')
    rate: float = parameter(
        1.0,
        'Recorded seconds in a second; other than 1 needs use_sim_time in the other nodes.',
        low=0.01,
        high=1000.0,
    )
    loop: bool = parameter(False, 'Begin again when the recording has ended.')

    def __post_init__(self):
        check(self)


@dataclass(frozen=True)
class NmeaOutputParameters:
    """The NMEA output node's parameters."""

    sentences: str = parameter(
        'RMC HDT OSD TTM',
        'Sentences to send, of RMC, HDT, OSD, RSD, TTM, TLL. OpenCPN wants no '
        'TLL beside TTM: it would reckon course and speed anew from it.',
    )
    udp: str = parameter(
        '127.0.0.1:10110',
        'Where each sentence is sent as a datagram: host:port, several '
        'separated by blanks, broadcast addresses too. Empty: nowhere.',
    )
    tcp: str = parameter(
        '', 'host:port to serve TCP clients on; 0.0.0.0:10110 for all networks. Empty: no server.'
    )
    signalk_udp: str = parameter(
        '', 'Where Signal K deltas are sent as datagrams, as for udp. Empty: nowhere.'
    )
    talker: str = parameter('RA', 'Talker of OSD, RSD, TTM and TLL.')
    own_ship_talker: str = parameter('II', 'Talker of RMC and HDT.')
    own_ship_period_s: float = parameter(
        1.0,
        'RMC and HDT come with every scan, and at least this often.',
        unit='s',
        low=0.1,
        high=60.0,
    )
    range_scale_nm: float = parameter(
        6.0, 'Range scale that RSD tells.', unit='NM', low=0.125, high=120.0
    )
    origin: str = parameter(
        '',
        'Latitude and longitude in degrees of the origin of `map`, as "54.1 10.9". Empty: own '
        'ship is where own_ship/fix says.',
    )

    def __post_init__(self):
        check(self)


NODES: dict[str, tuple[type, ...]] = {
    'tracker': (TrackerParameters, ArpaParameters),
    'radar_simulator': (RadarSimulatorParameters,),
    'recording_player': (RecordingPlayerParameters,),
    'nmea_output': (NmeaOutputParameters,),
}
