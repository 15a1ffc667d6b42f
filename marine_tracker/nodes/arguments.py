"""The command line of a node, without the part for ROS. Nothing in it is ignored silently.

ROS reads what is between `--ros-args` and `--`, and ignores everything else.
"""

import sys
import textwrap

from ..files import shortened

ABOUT = {
    'tracker': 'Tracks targets on radar plots and tells their approach.',
    'radar_simulator': 'Plays a scenario as a radar and own ship would see it.',
    'plot_extractor': 'Takes plots out of radar video.',
    'recording_player': 'Plays a recorded folder, or a file of spokes.',
    'nmea_output': 'Sends targets and own ship as NMEA 0183 and Signal K.',
    'recorder': 'Records the topics of the service into MCAP files.',
    'ais_input': 'Takes AIS sentences, by UDP, TCP, serial port or file.',
    'ppi_display': 'Serves the radar picture (PPI) as a page for a browser.',
}


def answer(name: str, arguments: list[str]) -> int | None:
    """The exit code if a node must not start: 0 after help, 2 after an unknown argument.

    An unknown argument is reported in one line on stderr. None: start.

    arguments  without the name of the program
    """
    others, for_ros = [], False
    for argument in arguments:
        if argument == '--ros-args':
            for_ros = True
        elif argument == '--':
            for_ros = False
        elif not for_ros:
            others.append(argument)
    if not others:
        return None
    if others[0] in ('-h', '--help'):
        print(usage(name))
        return 0
    print(
        f'{name}: {shortened(others[0])} is not understood; parameters and all else for ROS stand '
        f'behind --ros-args: {name} --ros-args {example(name)} (see {name} --help)',
        file=sys.stderr,
    )
    return 2


def example(name: str) -> str:
    """How the node's first parameter is set to its default."""
    from .. import parameter_files  # late import: signals are not handled yet

    field = parameter_files.fields(name)[0]
    return f'-p {field.name}:={parameter_files.yaml_value(field.default)}'


def usage(name: str) -> str:
    """Help: what the node does, and its parameters."""
    from .. import parameter_files

    lines = [
        f'usage: {name} [--ros-args [-p NAME:=VALUE] [--params-file FILE.yaml] [-r FROM:=TO] ...]',
        '',
        ABOUT[name],
        '',
        'parameters, with their defaults (limits and units: doc/parameters.md):',
    ]
    for field in parameter_files.fields(name):
        lines.append(f'  {field.name}: {parameter_files.yaml_value(field.default)}')
        lines += textwrap.wrap(
            field.metadata['text'], 94, initial_indent=' ' * 6, subsequent_indent=' ' * 6
        )
    return '\n'.join(lines)
