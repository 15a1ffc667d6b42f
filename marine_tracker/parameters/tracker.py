"""The parameters of the tracker."""

from dataclasses import dataclass

from .description import check, parameter

BEARINGS = ('north', 'bow')
VESSEL_CLASSES = ('ship', 'small_craft')
# m: deviation of a target's echoing point from its middle, each axis, by vessel class.
GLINT_SIGMA = {'ship': 25.0, 'small_craft': 0.0}
EXTENTS = ('none', 'random_matrix', 'gp')


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
        'Whether each track of the estimator gwnn adapts the output weights to its own plots.',
    )
    alpha_beta_mode: str = parameter(
        'hf_soft',
        'How the estimator alpha_beta weights a plot: as paper 002 (hf), with softer '
        'weights (hf_soft), or as one of the two rivals in that paper.',
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
        'Standard deviation of a measured radial speed, if the radar measures it (Doppler).',
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
        'none',
        'Whether echoes that touch are one target with length and heading: none, by an '
        'ellipse (random_matrix), close by also by an outline (gp); see doc/extended_targets.md.',
        choices=EXTENTS,
        old={'off': 'none', False: 'none'},
        live=True,
    )
    range_resolution_m: float = parameter(
        30.0,
        'Depth of a radar cell: echoes of one target lie no farther apart, and two targets in '
        'it give one plot.',
        unit='m',
        low=1.0,
        high=1000.0,
        live=True,
    )
    beam_width_deg: float = parameter(
        1.0,
        'Horizontal beam width of the antenna, which is that of a cell.',
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
        'Time of one antenna revolution, used if the plots do not show it (22 rpm).',
        unit='s',
        low=0.2,
        high=120.0,
    )
    antenna_ahead_m: float = parameter(
        0.0,
        "How far ahead of own ship's reference point the antenna is.",
        unit='m',
        low=-500.0,
        high=500.0,
        live=True,
    )
    antenna_starboard_m: float = parameter(
        0.0,
        'How far to starboard of the reference point the antenna is.',
        unit='m',
        low=-100.0,
        high=100.0,
        live=True,
    )
    bearing_offset_deg: float = parameter(
        0.0,
        'Added to every bearing: by how much the antenna points to the left of what it tells.',
        unit='deg',
        low=-180.0,
        high=180.0,
        live=True,
    )
    bearings: str = parameter(
        'north',
        "What the radar counts bearings from: true north (north), or own ship's bow (bow): her "
        'heading is then added.',
        choices=BEARINGS,
        live=True,
    )
    gate_probability: float = parameter(
        0.995,
        'Probability that the gate holds the plot of a track.',
        low=0.5,
        high=0.999999,
        live=True,
    )
    association: str = parameter(
        'joint',
        'How contested plots are shared out: by all joint associations, and two targets in one '
        'cell of the radar share its plot (joint); or to one track each (nearest).',
        choices=('joint', 'nearest'),
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
        'Probability that a target gives a plot, as long as nothing else is known of it.',
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
    confirm_existence: float = parameter(
        0.98,
        'Probability that there is a target, which confirmation needs as well.',
        low=0.1,
        high=0.999999,
        live=True,
    )
    lose_existence: float = parameter(
        0.2,
        'A confirmed track is lost when the probability that its target is there falls below this.',
        low=0.0001,
        high=0.99,
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
    stationary_places: bool = parameter(
        True,
        'Whether places where plots always are (quays, moored craft) are learnt and shown as '
        'stationary objects, not as ever new targets; see doc/tracking.md.',
        live=True,
    )
    correct_plots: bool = parameter(
        False,
        'Whether the offsets of ranges and bearings and the lag of plots that stationary objects '
        'show are taken off the plots; see doc/tracking.md.',
        live=True,
    )
    known_marks: str = parameter(
        '',
        'Stationary objects whose positions are known: a list in YAML of [north_m, east_m]. They '
        'show offsets of the radar also to a ship at rest.',
    )
    land_mask: str = parameter(
        '', 'GeoJSON file of polygons of land: plots on land begin no track. Empty: none.'
    )
    land_mask_origin: str = parameter(
        '',
        'Latitude and longitude, deg, of the origin of the local positions, as in "63.43 10.39". '
        'Empty: the coordinates in land_mask are metres, east and north.',
    )
    max_tracks: int = parameter(
        2000,
        'Largest number of tracks, including tentative ones; above it none are initiated.',
        low=1,
        high=100000,
        live=True,
    )
    max_plots: int = parameter(
        10000,
        'Largest number of plots in a scan; the strongest are kept, the rest are counted.',
        low=1,
        high=1000000,
        live=True,
    )
    own_ship_timeout_s: float = parameter(
        10.0, 'Own-ship data older than this count as missing.', unit='s', low=0.1, high=600.0
    )
    gps_ahead_m: float = parameter(
        0.0,
        "How far ahead of own ship's reference point the place is that `own_ship/odometry` tells: "
        "the GPS antenna's.",
        unit='m',
        low=-500.0,
        high=500.0,
        live=True,
    )
    gps_starboard_m: float = parameter(
        0.0,
        'How far to starboard of the reference point that place is.',
        unit='m',
        low=-100.0,
        high=100.0,
        live=True,
    )
    own_ship_velocity: str = parameter(
        'auto',
        "Own ship's velocity over ground: as the odometry's twist tells it (twist), from her "
        'positions (positions), or by twist unless her positions contradict it (auto); see '
        'doc/own_ship.md.',
        choices=('auto', 'twist', 'positions'),
        live=True,
    )

    def __post_init__(self) -> None:
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
        if self.extent != 'none' and self.radars:
            raise ValueError(
                f'parameter extent is {self.extent}; with several radars it must be none'
            )

    @property
    def glint_sigma(self) -> float:
        """m: glint_sigma_m; if that is below 0, the value of the vessel class."""
        return GLINT_SIGMA[self.vessel_class] if self.glint_sigma_m < 0 else self.glint_sigma_m
