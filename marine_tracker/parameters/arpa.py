"""The parameters of the ARPA, which runs in the tracker node."""

from dataclasses import dataclass

from .description import check, parameter


@dataclass(frozen=True)
class ArpaParameters:
    """The parameters for targets, their approach and alarms."""

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
    acknowledge_for_min: float = parameter(
        0.0,
        'Time after which an acknowledged alarm sounds again if its cause still lasts. '
        '0: it stays acknowledged until the cause has ended.',
        unit='min',
        low=0.0,
        high=120.0,
        live=True,
    )
    own_ship_status: str = parameter(
        'detected',
        'At anchor, only targets that certainly come nearer raise CPA alarms. detected: own ship '
        'is at anchor while she makes no way; anchored, under_way: as set here.',
        choices=('detected', 'anchored', 'under_way'),
        live=True,
    )
    acquisition: str = parameter(
        'everywhere',
        'Where confirmed tracks become targets automatically: everywhere, in guard '
        'zones, or nowhere (then by `acquire` only).',
        choices=('everywhere', 'zones', 'nowhere'),
        live=True,
    )
    zones: str = parameter(
        '', 'Guard and exclusion zones: a list in YAML, see doc/arpa.md; empty: none.', live=True
    )
    max_targets: int = parameter(
        200,
        'Largest number of targets; near and dangerous ones come first.',
        low=1,
        high=10000,
        live=True,
    )
    click_radius_m: float = parameter(
        500.0,
        'Largest distance of a track from a clicked point.',
        unit='m',
        low=1.0,
        high=20000.0,
        live=True,
    )
    click_wait_s: float = parameter(
        20.0,
        'Time that a click waits for a track to appear there.',
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
        'absolute',
        'Vectors and past positions on `markers`: as over ground or through the water '
        '(absolute), or relative to own ship.',
        choices=('absolute', 'relative'),
        old={'true': 'absolute', True: 'absolute'},
        live=True,
    )
    current_set_deg: float = parameter(
        0.0,
        'Direction in which the current flows, true. With a drift above 0 courses and speeds '
        'are through the water (sea stabilised), else over ground.',
        unit='deg',
        low=0.0,
        high=360.0,
        live=True,
    )
    current_drift_kn: float = parameter(
        0.0, 'Speed of the current.', unit='kn', low=0.0, high=20.0, live=True
    )
    stabilisation: str = parameter(
        'current',
        "What own ship's way through the water is known by: the current that is set (current), "
        'the speed on `own_ship/log` (log; where it is silent, water_speed_kn), or water_speed_kn '
        '(hand). Courses and speeds are then through the water.',
        choices=('current', 'log', 'hand'),
        live=True,
    )
    water_speed_kn: float = parameter(
        -1.0,
        "Own ship's speed through the water, set by hand, along her heading; below 0: none. It "
        'also moves her on where positions and log are lost.',
        unit='kn',
        low=-1.0,
        high=100.0,
        live=True,
    )
    reference_target: int = parameter(
        0,
        'Number of a target that is surely stationary, from which courses and speeds over ground '
        'are taken; 0: none.',
        low=0,
        high=1000000000,
        live=True,
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
        'An alarm is raised when heading, position or plots are missing for this time.',
        unit='s',
        low=0.5,
        high=600.0,
        live=True,
    )

    def __post_init__(self) -> None:
        check(self)
