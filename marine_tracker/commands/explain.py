"""Asks a running tracker why there is no target at a place.

  marine_tracker explain --range 2.4 --bearing 047         NM and degrees from own ship, true
  marine_tracker explain --range 2.4 --bearing 330 --bow   degrees from own ship's bow
  marine_tracker explain --east 1200 --north 5400          m, in the frame map

The answer is a list of reasons. Those marked with * keep a target away by themselves.
The exit code is 0 when the tracker answered, 2 else.
"""

import math
from argparse import ArgumentParser, Namespace

HELP = 'ask a running tracker why there is no target at a place'


def add_arguments(parser: ArgumentParser) -> None:
    """The command's options."""
    parser.add_argument('--range', type=float, metavar='NM', help='from own ship')
    parser.add_argument('--bearing', type=float, metavar='DEG', help='clockwise from true north')
    parser.add_argument('--bow', action='store_true', help="the bearing is from own ship's bow")
    parser.add_argument('--east', type=float, metavar='M', help='in the frame map')
    parser.add_argument('--north', type=float, metavar='M', help='in the frame map')
    parser.add_argument('--namespace', default='/', help="the tracker's (default: %(default)s)")
    parser.add_argument(
        '--wait', type=float, default=10.0, metavar='S', help='for an answer (default: %(default)s)'
    )


def run(args: Namespace) -> int:
    """ValueError where the place is not told well, or nobody answers."""
    polar, flat = (args.range, args.bearing), (args.east, args.north)
    wanted = flat if polar == (None, None) else polar
    other = polar if wanted is flat else flat
    if None in wanted or other != (None, None) or (args.bow and wanted is flat):
        raise ValueError('name the place by --range and --bearing, or by --east and --north')
    if not all(map(math.isfinite, wanted)) or (wanted is polar and wanted[0] < 0):
        raise ValueError(
            f'the place is {wanted[0]:g}, {wanted[1]:g}; both must be finite, a range at least 0'
        )
    from ..nodes.ask import Question, ask  # needs ROS

    question = Question(*wanted, polar=wanted is polar, bow=args.bow)
    for decides, text in ask(question, args.namespace, args.wait):
        print(f'{"*" if decides else " "} {text}')
    return 0
