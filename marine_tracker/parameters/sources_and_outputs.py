"""The parameters of the nodes other than the tracker's own: simulator, player, outputs."""

from dataclasses import dataclass

from .description import check, parameter


@dataclass(frozen=True)
class RadarSimulatorParameters:
    """The radar simulator node's parameters. The radar itself is described in the scenario file."""

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
    ais_udp: str = parameter(
        '',
        'Where the AIS sentences of the scenario (`ais: {send: ...}`) are sent as datagrams: '
        'host:port, several separated by blanks; beside the topic `ais/simulated`. Empty: nowhere.',
    )
    sectors: int = parameter(
        0,
        'Messages of plots a revolution: the antenna does not wait for its whole turn. 0: as the '
        'scenario says, 1 if it says nothing.',
        low=0,
        high=64,
    )

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class RecordingPlayerParameters:
    """The recording player node's parameters."""

    folder: str = parameter(
        '',
        'Folder of a recording (plots.csv, own_ship.csv, truth.csv), a file of spokes (.npz), or '
        'a recording of topics (.mcap, or a folder of those).',
    )
    rate: float = parameter(
        1.0,
        'Recorded seconds in a second; other than 1 needs use_sim_time in the other nodes.',
        low=0.01,
        high=1000.0,
    )
    loop: bool = parameter(False, 'Begin again when the recording has ended.')

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class RecorderParameters:
    """The recorder node's parameters."""

    folder: str = parameter(
        '', 'Folder to record into, which must not have a recording. Empty: one named by the time.'
    )
    plots_topics: str = parameter(
        'radar/plots', 'Topics of plots, several separated by blanks: those that the tracker hears.'
    )
    topics: str = parameter(
        '',
        'More topics to record, of whatever type is installed here, separated by blanks; beside '
        'those of this package.',
    )
    without: str = parameter(
        'radar/plots_readable radar/image extrapolations danger_areas',
        'Topics of this package that are not recorded, separated by blanks.',
    )
    tracker: str = parameter(
        'tracker', "The tracker's node, whose parameters are recorded, so that a replay has them."
    )
    split_mb: int = parameter(
        512, 'A new file begins when one has so many.', unit='MB', low=1, high=1_000_000
    )
    keep_free_mb: int = parameter(
        500,
        'The recording ends, whole, when less than so many would be left on the disk.',
        unit='MB',
        low=0,
        high=100_000_000,
    )
    compression: str = parameter(
        'zstd', 'How the files are packed.', choices=('zstd', 'lz4', 'none')
    )

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class TrackerOutputParameters:
    """How the tracker node publishes; nothing of it reaches the tracking."""

    tracks_paced: bool = parameter(
        False,
        'Whether the messages of `tracks` are spread over the revolution. Else those of a scan '
        'come at once, and a listener needs a depth of as many as there are tracks.',
    )
    managed: bool = parameter(
        False,
        'Whether the node is a lifecycle node: it waits to be configured and activated by ROS.',
    )
    plots_type: str = parameter(
        'PointCloud2',
        'Type of the topics of plots; RadarScan is that of radar_msgs, which must be installed.',
        choices=('PointCloud2', 'RadarScan'),
    )
    radar_tracks: bool = parameter(
        False,
        'Whether the tracks are also published on `radar_tracks`, as radar_msgs/RadarTracks, which '
        'must be installed.',
    )
    broadcast_tf: bool = parameter(
        False,
        "Whether own ship's odometry is also sent as the transform `map` -> `base_link`; tf2_ros "
        'must be installed.',
    )

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class NmeaOutputParameters:
    """The NMEA output node's parameters."""

    sentences: str = parameter(
        'RMC HDT OSD TTM',
        'Sentences to send, of RMC, HDT, OSD, RSD, TTM, TLL, VHW. OpenCPN wants '
        'no TLL with TTM: it would compute course and speed from TLL again.',
    )
    udp: str = parameter(
        '127.0.0.1:10110',
        'Where each sentence is sent as a datagram: host:port, several '
        'separated by blanks, broadcast addresses too. Empty: nowhere.',
    )
    tcp: str = parameter(
        '',
        'host:port to serve TCP clients on; 0.0.0.0:10110 for all networks, [::]:10110 for those '
        'of IPv6 as well. Empty: no server.',
    )
    signalk_udp: str = parameter(
        '', 'Where Signal K deltas are sent as datagrams, as for udp. Empty: nowhere.'
    )
    nmea2000_udp: str = parameter(
        '',
        'Where targets are sent as NMEA 2000 (PGN 128520), in lines as gateways of Yacht Devices '
        'take them, a datagram each, as for udp. Needs the package nmea2000. Empty: nowhere.',
    )
    pass_ais: bool = parameter(
        False, 'Whether the sentences on `ais/sentences` are passed on to UDP and TCP as they came.'
    )
    talker: str = parameter('RA', 'Talker of OSD, RSD, TTM and TLL.')
    target_numbers: int = parameter(
        99,
        'Greatest target number in TTM and TLL, so most targets at a time: 99 as the standard '
        'has it (two digits), up to 999 where receivers read three digits, as OpenCPN does.',
        low=99,
        high=999,
    )
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
        'Latitude and longitude in degrees of the origin of `map`, as "54.1 -10.9": south and west '
        'negative, no longitude beyond 180. Empty: own ship is where own_ship/fix says.',
    )
    fix_timeout_s: float = parameter(
        5.0,
        'Without a good fix for so long RMC is void, its position only estimated (mode E); '
        'without one for six times as long there is none (mode N).',
        unit='s',
        low=0.5,
        high=600.0,
    )
    gps_ahead_m: float = parameter(
        0.0,
        "How far ahead of own ship's reference point the place is that `own_ship/odometry` tells; "
        "as the tracker's.",
        unit='m',
        low=-500.0,
        high=500.0,
    )
    gps_starboard_m: float = parameter(
        0.0,
        'How far to starboard of the reference point that place is.',
        unit='m',
        low=-100.0,
        high=100.0,
    )
    own_ship_velocity: str = parameter(
        'auto',
        "Own ship's velocity over ground: as the odometry's twist tells it (twist), from her "
        'positions (positions), or by twist unless her positions contradict it (auto); see '
        'doc/own_ship.md.',
        choices=('auto', 'twist', 'positions'),
    )

    def __post_init__(self) -> None:
        check(self)
