"""Runs simulator (or recorded radar), tracker and PPI over ROS 2, as processes; shows a table.

The address of the PPI is printed. On a desktop the page opens by itself.

In the page another scenario or recording and another rate can be chosen, with the token, which
stands in the address: simulator or player and tracker are started anew behind it.

Ends with Ctrl-C, after --duration, or when the recording or scenario has ended.
"""

import contextlib
import os
import signal
import sys
import threading
import time
from argparse import ArgumentParser, Namespace

from ..estimators import ESTIMATORS
from ..parameters import EXTENTS
from ..processes import closing, end_in_time
from . import demo_page, demo_plan, demo_table, tracker_options
from .node_processes import Child, Children, children_of

HELP = 'watch simulated or recorded radar being tracked, over ROS 2'

PPI = 'ppi_display'


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the options of the command."""
    source = parser.add_mutually_exclusive_group()
    source.add_argument(
        '--scenario',
        default='encounters',
        metavar='NAME',
        help='a shipped scenario or a scenario file (default: %(default)s)',
    )
    source.add_argument(
        '--recording',
        metavar='FOLDER',
        help='a recording instead: a folder, a file of spokes (.npz), or of topics (.mcap)',
    )
    tracker_options.add_video_arguments(parser, heading=False)
    parser.add_argument(
        '--recordings',
        metavar='FOLDER',
        help='where recordings lie that the page offers (default: beside that of --recording)',
    )
    parser.add_argument(
        '--rate',
        type=float,
        default=1.0,
        metavar='F',
        help='simulated seconds in a second (default: 1)',
    )
    parser.add_argument('--estimator', choices=sorted(ESTIMATORS), help='filter of the tracker')
    parser.add_argument(
        '--extent',
        choices=(*EXTENTS, 'off'),
        metavar='{' + ','.join(EXTENTS) + '}',
        help='how the tracker joins cells that touch into one target',
    )
    parser.add_argument('--seed', type=int, default=1, help='seed of the simulator (default: 1)')
    parser.add_argument('--duration', type=float, metavar='S', help='end after so many seconds')
    parser.add_argument('--no-display', action='store_true', help='no page with the radar picture')
    parser.add_argument(
        '--domain', type=int, metavar='ID', help='ROS domain (default: one that is free)'
    )


def run(args: Namespace) -> int:
    """Returns 0 after a requested stop, 1 if a process died or ROS is missing."""
    stop = threading.Event()

    def on_signal(*_):
        closing()
        stop.set()

    before = {
        number: signal.signal(number, on_signal)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    }
    try:
        return _demo(args, stop)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _demo(args, stop: threading.Event) -> int:
    offers = demo_plan.offers(args.scenario, args.recording, args.recordings)
    shown = offers.shown(args.scenario, args.recording, args.rate)
    plan = demo_plan.plan(args, offers, shown)
    try:
        from ..nodes import domain
        from ..nodes.demo_choice import DemoChoice
        from ..nodes.targets_listener import TargetsListener
    except ModuleNotFoundError as error:
        print(
            f'marine_tracker demo needs ROS 2 ({error}): '
            "pip install 'marine_tracker[ros]', or source a ROS 2 Jazzy",
            file=sys.stderr,
        )
        return 1
    end_in_time()
    with contextlib.ExitStack() as context:
        number = args.domain
        if number is None:
            number = context.enter_context(domain.free_domain())
        domain.set_local(os.environ, number)
        last = context.enter_context(contextlib.ExitStack())
        nodes = dict(plan.nodes)
        if demo_page.wanted(args.no_display):
            nodes[PPI] = {'address': f'127.0.0.1:{demo_page.free_port()}'}
        children = context.enter_context(children_of(nodes))
        listener = TargetsListener()
        last.callback(listener.close)  # after the children have ended: it may hang
        choice = DemoChoice(
            listener, offers, shown, lambda asked: demo_plan.plan(args, offers, asked)
        )
        began = time.monotonic()
        with demo_table.display() as show:
            watch = _Watch(listener, children, stop, show, began, args.duration)
            while True:
                code = watch.until_ended(f'{plan.title}, ROS domain {number}', choice)
                if code is not None:
                    break
                children.end(*plan.nodes)
                plan = demo_plan.plan(args, offers, choice.take())
                listener.forget()
                children.start(plan.nodes)
        if watch.failed:
            _tell_why(watch.failed)
        return code


class _Watch:
    """Shows the targets. failed: the node that ended the demo by failing."""

    def __init__(self, listener, children: Children, stop, show, began: float, duration) -> None:
        self._listener, self._children, self._stop = listener, children, stop
        self._show, self._began, self._duration = show, began, duration
        self._told = not any(child.name == PPI for child in children)
        self._again = False  # the page was started a second time
        self.failed: Child | None = None

    def until_ended(self, title: str, choice) -> int | None:
        """The exit code at the end; None where something else was chosen."""
        while not self._stop.is_set():
            if self._duration is not None and time.monotonic() - self._began >= self._duration:
                break
            self._listener.spin(0.1)
            if choice.changed:
                return None
            if not self._told:
                page = next(child for child in self._children if child.name == PPI)
                if address := demo_page.address_of(page):
                    self._told = True
                    demo_page.show(address)
            self._show(self._listener.picture, title)
            ended = next((one for one in self._children if one.process.poll() is not None), None)
            if ended and ended.name == PPI and not self._told and not self._again:
                # The port was free a moment ago: somebody else was quicker.
                self._again = True
                self._children.end(PPI)
                self._children.start({PPI: {'address': '127.0.0.1:0'}})
            elif ended:
                return self._end(ended, title.partition(',')[0])
        return 0

    def _end(self, ended: Child, title: str) -> int:
        if ended.process.returncode or ended.name == 'tracker':
            self.failed = ended
            return 1
        until = time.monotonic() + 0.5  # what is still on its way after the source has ended
        while time.monotonic() < until:
            self._listener.spin(0.1)
        self._show(self._listener.picture, f'{title}, ended')
        return 0


def _tell_why(child: Child) -> None:
    child.log.seek(0)
    said = child.log.read().decode(errors='replace').strip().splitlines()[-10:]
    print(
        f'marine_tracker demo: {child.name} ended with code {child.process.returncode}'
        + (', saying' if said else ''),
        *said,
        sep='\n  ',
        file=sys.stderr,
    )
