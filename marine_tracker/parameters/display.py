"""The parameters of the PPI."""

from dataclasses import dataclass

from .description import check, parameter


@dataclass(frozen=True)
class PpiDisplayParameters:
    """The PPI node's parameters."""

    address: str = parameter(
        '127.0.0.1:8080',
        'host:port to serve the page on; 0.0.0.0:8080 for all networks, port 0 for one that is '
        'free. The address of the page is printed at the start.',
    )
    remote_commands: bool = parameter(
        False,
        'Whether viewers on other machines may command, if they have the token. Without encryption '
        'whoever hears the network hears the token.',
    )
    token: str = parameter(
        '',
        'What a viewer needs to command; it stands behind # in the printed address. Empty: a new '
        'one at each start.',
    )
    names: str = parameter(
        '',
        'Other names under which browsers reach this page, with blanks between: of a proxy, say. '
        "Under any other name than this machine's own the page is refused.",
    )
    tracker: str = parameter('tracker', 'Name of the tracker node that commands are for.')
    plots_topic: str = parameter(
        'radar/plots',
        'Topic of the plots that are drawn, of a tracker with one radar. Those of several are '
        'known from its parameter radars.',
    )
    own_length_m: float = parameter(
        0.0,
        "Own ship's length. With it she is drawn to scale where she is large enough; 0: never.",
        unit='m',
        low=0.0,
        high=600.0,
    )
    own_beam_m: float = parameter(0.0, "Own ship's beam.", unit='m', low=0.0, high=150.0)
    own_bow_m: float = parameter(
        -1.0,
        "From her position's reference point forward to the bow; below 0: half of the length.",
        unit='m',
        low=-1.0,
        high=600.0,
    )

    managed: bool = parameter(
        False,
        'Whether the node is a lifecycle node: it waits to be configured and activated by ROS.',
    )

    def __post_init__(self) -> None:
        check(self)
