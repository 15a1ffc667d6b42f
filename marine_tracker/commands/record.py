"""Records the topics of the service into MCAP files: plots, own ship, targets, alarms, health.

`ros2 bag`, Foxglove and PlotJuggler read them; so do `replay`, `score`, `incident` and the node
recording_player. What was recorded is on disk within a second.

Ends with Ctrl-C, or after --duration.
"""

import json
import os
import signal
import sys
import threading
from argparse import ArgumentParser, Namespace

HELP = 'record what the nodes publish into MCAP files'


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the options of the command."""
    parser.add_argument('folder', metavar='FOLDER', help='new folder to record into')
    parser.add_argument('--duration', type=float, metavar='S', help='end after so many seconds')
    parser.add_argument('--topics', default='', help='more topics, separated by blanks')
    parser.add_argument(
        '--set',
        metavar='NAME=VALUE',
        action='append',
        default=[],
        help='a parameter of the node recorder, or use_sim_time=true; may be given more than once',
    )


def run(args: Namespace) -> int:
    """Runs the node recorder here, then shows what there is. Returns its exit code."""
    from ..nodes import run as nodes
    from . import recording

    given = [f'folder:={json.dumps(args.folder)}', f'topics:={json.dumps(args.topics)}']
    for text in args.set:
        name, equals, value = text.partition('=')
        if not equals:
            raise ValueError(f'--set {text[:60]}: it must be NAME=VALUE')
        given.append(f'{name}:={value}')
    sys.argv = ['recorder', '--ros-args', *(word for one in given for word in ('-p', one))]
    if args.duration is not None:
        timer = threading.Timer(args.duration, os.kill, (os.getpid(), signal.SIGINT))
        timer.daemon = True
        timer.start()
    code = nodes.run('recorder')
    if code == 0:
        recording.show(args.folder)
    return code
