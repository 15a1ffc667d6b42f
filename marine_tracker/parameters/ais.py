"""The parameters of AIS in the tracker node."""

from dataclasses import dataclass

from .description import check, parameter

KINDS = ('a', 'b', 'aircraft', 'aid', 'sart')
RULES = ('all', 'danger', 'zones', 'range')


@dataclass(frozen=True)
class AisParameters:
    """Which ships of AIS are shown, which are activated, and what of them is an alarm."""

    ais_own_mmsi: int = parameter(
        0,
        "Own ship's MMSI, which is never a target; 0: as her own receiver tells it.",
        low=0,
        high=999999999,
        live=True,
    )
    ais_activation: str = parameter(
        'danger zones',
        'What activates ships of AIS beside the operator, several words separated by blanks: all; '
        'danger (CPA and TCPA below the limits), zones (in a guard zone), range '
        '(within ais_activation_range_nm). Others are asleep.',
        live=True,
    )
    ais_activation_range_nm: float = parameter(
        3.0, 'See ais_activation.', unit='NM', low=0.1, high=100.0, live=True
    )
    ais_range_nm: float = parameter(
        100.0,
        'Sleeping ships beyond this range are left out (filter).',
        unit='NM',
        low=0.1,
        high=1000.0,
        live=True,
    )
    ais_cpa_nm: float = parameter(
        200.0,
        'Sleeping ships that pass farther off than this are left out (filter).',
        unit='NM',
        low=0.1,
        high=200.0,
        live=True,
    )
    ais_kinds: str = parameter(
        'a b aircraft aid sart',
        'Kinds of sleeping ships that are not left out (filter): a, b, aircraft, aid, sart.',
        live=True,
    )
    ais_max_activated: int = parameter(
        200,
        'Most activated ships: 20, 30 or 40 are asked for by the size of own ship.',
        low=20,
        high=10000,
        live=True,
    )
    ais_max_sleeping: int = parameter(
        1000,
        'Most sleeping ships, the nearest: 100, 150 or 200 are asked for by the size of own ship.',
        low=100,
        high=20000,
        live=True,
    )
    ais_lost_alarm: bool = parameter(
        True,
        'Whether the silence of an activated or joined ship within ais_lost_range_nm is an alarm.',
        live=True,
    )
    ais_lost_range_nm: float = parameter(
        6.0, 'See ais_lost_alarm.', unit='NM', low=0.1, high=100.0, live=True
    )
    ais_sleeping_danger: bool = parameter(
        True,
        'Whether a sleeping ship can be a danger. Else CPA alarms are of activated ones only.',
        live=True,
    )
    ais_join: bool = parameter(True, 'Whether ships of AIS are joined to radar targets.', live=True)
    ais_symbol: str = parameter(
        'ais',
        'Which symbol, and whose data first, a joined target has.',
        choices=('ais', 'radar'),
        live=True,
    )
    ais_fusion: bool = parameter(
        False,
        'Whether the tracks of joined targets go out as the weighted mean of radar and AIS.',
        live=True,
    )

    def __post_init__(self) -> None:
        check(self)
        for name, text, known in (
            ('ais_activation', self.ais_activation, RULES),
            ('ais_kinds', self.ais_kinds, KINDS),
        ):
            for word in text.split():
                if word not in known:
                    raise ValueError(
                        f'parameter {name} has {word[:40]!r}; it must be of {", ".join(known)}'
                    )


@dataclass(frozen=True)
class AisInputParameters:
    """The parameters of the node that takes AIS sentences."""

    udp: str = parameter(
        '0.0.0.0:10111',
        'host:port to take datagrams of sentences on; 0.0.0.0 for all networks, [::] for those of '
        'IPv6 as well. Empty: none.',
    )
    tcp: str = parameter(
        '',
        'host:port to connect to for sentences, or for the JSON of gpsd (port 2947), several '
        'separated by blanks. Lost connections are made again. Empty: none.',
    )
    tcp_server: str = parameter(
        '', 'host:port to take connections on that send sentences. Empty: none.'
    )
    serial: str = parameter('', 'Serial port to read sentences from, as /dev/ttyUSB0. Empty: none.')
    baud: int = parameter(
        38400, 'Speed of the serial port: 38400 for AIS.', unit='bit/s', low=4800, high=230400
    )
    file: str = parameter(
        '',
        'Recorded sentences to play, each after its seconds (`12.3 !AIVDM,...`) or tag block. '
        'Empty: none.',
    )
    rate: float = parameter(1.0, 'Recorded seconds of the file in a second.', low=0.01, high=1000.0)
    topics: str = parameter(
        'ais/simulated',
        'Topics of sentences (std_msgs/String) to take, separated by blanks: those of the '
        'simulator.',
    )
    own_mmsi: int = parameter(
        0, "Own ship's MMSI; 0: as her own receiver tells it (AIVDO).", low=0, high=999999999
    )

    def __post_init__(self) -> None:
        check(self)
