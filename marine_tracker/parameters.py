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


def parameter(default, text, *, unit='', low=None, high=None, choices=(), live=False):
    """A dataclass field with its description.

    low, high  inclusive limits of a number; choices  the values a string may take;
    live       may be changed while the node runs.
    """
    return dataclasses.field(default=default, metadata={
        'text': text, 'unit': unit, 'low': low, 'high': high, 'choices': choices, 'live': live})


def check(parameters) -> None:
    """Raise ValueError for the first field with a wrong type, or outside its limits or choices."""
    for field in dataclasses.fields(parameters):
        kind: Any = field.type
        value, about = getattr(parameters, field.name), field.metadata
        if kind is float and type(value) is int:
            value = float(value)
            object.__setattr__(parameters, field.name, value)
        if type(value) is not kind:
            raise ValueError(f'parameter {field.name} is {value!r}, a {type(value).__name__}; '
                             f'it must be a {kind.__name__}')
        if isinstance(value, float) and not math.isfinite(value):
            raise ValueError(f'parameter {field.name} is {value}; it must be finite')
        low, high = about['low'], about['high']
        if (low is not None and value < low) or (high is not None and value > high):
            raise ValueError(f'parameter {field.name} is {value:g} {about["unit"]}'.rstrip()
                             + f'; it must be between {low:g} and {high:g}')
        if about['choices'] and value not in about['choices']:
            raise ValueError(f'parameter {field.name} is {value!r}; '
                             f'it must be one of {", ".join(about["choices"])}')


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
    return tuple(kind(**{name: value for name, value in values.items() if known[name] is kind})
                 for kind in kinds)


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
        'imm', 'Filter that extrapolates and updates the tracks.',
        choices=('cs_kalman', 'imm', 'gwnn', 'gwnn_paper'), live=True)
    gwnn_weights: str = parameter(
        '', 'Weights of the estimator gwnn, a file of `marine_tracker train gwnn`; empty: those '
        'shipped.', live=True)
    gwnn_learning: bool = parameter(
        False, 'Whether each track of the estimator gwnn adds to the output weights what its own '
        'plots tell.')
    vessel_class: str = parameter(
        'ship', 'Preset of the motion models: how hard targets are expected to manoeuvre.',
        choices=VESSEL_CLASSES, live=True)
    range_sigma_m: float = parameter(
        15.0, 'Standard deviation of a measured range.', unit='m', low=0.1, high=1000.0, live=True)
    bearing_sigma_deg: float = parameter(
        0.5, 'Standard deviation of a measured bearing.', unit='deg', low=0.01, high=10.0,
        live=True)
    max_target_speed_mps: float = parameter(
        25.0, 'Fastest target over ground that initiation accepts.', unit='m/s', low=0.5,
        high=100.0, live=True)
    min_range_m: float = parameter(
        0.0, 'Nearest range the radar sees; a track nearer than this is not expected to show.',
        unit='m', low=0.0, high=10000.0, live=True)
    max_range_m: float = parameter(
        50000.0, 'Farthest range the radar sees; a track beyond it has left by range.',
        unit='m', low=100.0, high=200000.0, live=True)
    scan_period_s: float = parameter(
        60.0 / 22.0, 'Time of one antenna revolution, where the plots do not tell (22 rpm).',
        unit='s', low=0.2, high=120.0)
    gate_probability: float = parameter(
        0.995, 'Probability that the gate holds the plot of a track.', low=0.5, high=0.999999,
        live=True)
    detection_probability: float = parameter(
        0.85, 'Probability that a target gives a plot, as the track score assumes it.', low=0.1,
        high=0.99, live=True)
    confirm_hits: int = parameter(
        3, 'M of M-of-N confirmation: plots needed ...', low=2, high=20, live=True)
    confirm_scans: int = parameter(
        5, 'N of M-of-N confirmation: ... within this many scans.', low=2, high=20, live=True)
    confirm_score: float = parameter(
        8.0, 'Track score (log-odds against clutter) that confirmation needs as well.',
        low=-10.0, high=50.0, live=True)
    max_score: float = parameter(
        15.3, 'Cap of the track score: how long a good track outlives its plots. A miss costs '
        '-ln(1 - detection_probability); a confirmed track is lost below 0.',
        low=1.0, high=100.0, live=True)
    hold_hits: int = parameter(
        1, 'A confirmed track is lost when its last 10 scans held fewer plots than this.',
        low=1, high=10, live=True)
    max_drift: float = parameter(
        4.9, 'A coasting track is lost when its position has grown this many times less certain '
        'than a plot.', low=1.0, high=1000.0, live=True)
    max_tracks: int = parameter(
        2000, 'Most tracks held, tentative ones included; no new ones are initiated beyond it.',
        low=1, high=100000, live=True)
    max_plots: int = parameter(
        10000, 'Most plots taken from one scan; the strongest are kept, the rest counted.',
        low=1, high=1000000, live=True)
    own_ship_timeout_s: float = parameter(
        10.0, 'Own-ship data older than this count as missing.', unit='s', low=0.1, high=600.0)

    def __post_init__(self):
        check(self)
        if self.confirm_hits > self.confirm_scans:
            raise ValueError(f'parameter confirm_hits is {self.confirm_hits}; it must not exceed '
                             f'confirm_scans, {self.confirm_scans}')
        if self.min_range_m >= self.max_range_m:
            raise ValueError(f'parameter min_range_m is {self.min_range_m:g} m; it must be below '
                             f'max_range_m, {self.max_range_m:g} m')


@dataclass(frozen=True)
class RadarSimulatorParameters:
    """The radar simulator node's parameters; what the radar is stands in the scenario file."""

    scenario: str = parameter('paper_track', 'A shipped scenario by name, or a scenario file.')
    rate: float = parameter(
        1.0, 'Simulated seconds in a second; other than 1 needs use_sim_time in the other nodes.',
        low=0.01, high=1000.0)
    seed: int = parameter(
        1, 'Seed of every random number: same seed, same plots.', low=0, high=2 ** 31 - 1)
    loop: bool = parameter(False, 'Begin again when the scenario has ended.')

    def __post_init__(self):
        check(self)


@dataclass(frozen=True)
class RecordingPlayerParameters:
    """The recording player node's parameters."""

    folder: str = parameter('', 'Folder of a recording: plots.csv, own_ship.csv, truth.csv.')
    rate: float = parameter(
        1.0, 'Recorded seconds in a second; other than 1 needs use_sim_time in the other nodes.',
        low=0.01, high=1000.0)
    loop: bool = parameter(False, 'Begin again when the recording has ended.')

    def __post_init__(self):
        check(self)


NODES: dict[str, tuple[type, ...]] = {
    'tracker': (TrackerParameters,),
    'radar_simulator': (RadarSimulatorParameters,),
    'recording_player': (RecordingPlayerParameters,),
}
