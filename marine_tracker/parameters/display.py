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
    plots_topic: str = parameter('radar/plots', 'Topic of the plots that are drawn.')

    managed: bool = parameter(
        False,
        'Whether the node is a lifecycle node: it waits to be configured and activated by ROS.',
    )

    def __post_init__(self) -> None:
        check(self)
