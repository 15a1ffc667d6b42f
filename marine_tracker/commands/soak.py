"""Runs the tracker for hours on simulated traffic, with faults thrown in, and reports.

`busy_strait` is played again and again. The figures tell how many scans it takes after each kind of
fault until 95 % of the ships that were held before are held again, whether memory grows, and
whether anything failed. By default the node is in this process and hears everything at once, so
eight hours take some minutes. With --live tracker and simulator are processes, over DDS.
"""

import contextlib
import os
import time
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING

import numpy as np

from ..evaluation import report
from ..evaluation.result import Progress
from ..processes import keep_freed_memory
from .node_processes import child_of
from .progress_bar import progress_bar

if TYPE_CHECKING:
    from ..nodes.soak import SoakResult

HELP = 'run the tracker for hours with faults thrown in'
WITHIN = 5  # scans
GROWTH = 5.0  # MB after the first hour
SETTLED_S = 8.0  # of the wall, for a live tracker to find the ships
BETWEEN_S = 8.0  # of the wall, between two faults of a live run
BEGIN_AGAIN = ('tracker', 'simulator')
LIVE_FAULTS = ('flood', 'no plots', 'bad stamp', 'teleport', 'lost heading', *BEGIN_AGAIN)


def add_arguments(parser: ArgumentParser) -> None:
    """The command line of `soak`."""
    parser.add_argument(
        '--hours', type=float, default=8.0, metavar='H', help='simulated hours (default 8)'
    )
    parser.add_argument('--faults', action='store_true', help='throw faults in')
    parser.add_argument('--live', action='store_true', help='processes of their own, over DDS')
    parser.add_argument(
        '--rate',
        type=float,
        default=20.0,
        metavar='F',
        help='simulated seconds in a second, with --live (default 20)',
    )
    parser.add_argument('--seed', type=int, default=1, metavar='N', help='random seed (default 1)')
    report.add_arguments(parser)


def run(args: Namespace) -> int:
    """Prints the figures. Returns 1 if one misses its limit."""
    if not 0 < args.hours <= 1000:
        raise ValueError(f'--hours is {args.hours:g}; it must be above 0 and at most 1000')
    if not 0.1 <= args.rate <= 100:
        raise ValueError(f'--rate is {args.rate:g}; it must be from 0.1 to 100')
    if args.seed < 0:
        raise ValueError(f'--seed is {args.seed}; it must not be negative')
    try:
        from ..nodes import soak
    except ModuleNotFoundError as error:
        raise ValueError(
            f"soak needs ROS 2 ({error}): pip install 'marine_tracker[ros]'"
        ) from error
    keep_freed_memory()
    with progress_bar('soak') as progress:
        if args.live:
            found = _live(args, progress)
        else:
            found = soak.run(args.hours, args.seed, args.faults, progress)
    figures = [report.Figure('ships held, mean', found.held)]
    for fault in dict.fromkeys(one.fault for one in found.incidents):
        scans = [one.scans for one in found.incidents if one.fault == fault]
        name = f'{fault} ({len(scans)} times): scans until 95 % are held again'
        figures.append(report.at_most(name, float(max(scans)), WITHIN))
    later = found.memory[found.memory[:, 0] >= min(1.0, args.hours / 3), 1]
    grown = float(later.max() - later[0])
    figures.append(report.at_most('memory grown after the first hour', grown, GROWTH, 'MB'))
    figures.append(report.Figure('memory at the end', float(found.memory[-1, 1]), 'MB'))
    figures.append(report.at_most('exceptions in callbacks', len(found.exceptions), 0))
    title = f'{args.hours:g} simulated hours{" with faults" if args.faults else ""}'
    facts = {'hours': args.hours, 'faults': args.faults, 'live': args.live, 'seed': args.seed}
    return report.publish(title, figures, args.json, facts)


class _Nodes:
    """Tracker and simulator as processes; each may begin again."""

    def __init__(self, rate: float, seed: int, context: contextlib.ExitStack) -> None:
        from ..nodes.soak import SCENARIO
        from ..simulation import scenario

        tracker = scenario.load(SCENARIO).tracker_parameters()
        whole = {k: float(v) if type(v) is int else v for k, v in tracker.items()}
        simulator = {'scenario': SCENARIO, 'rate': rate, 'loop': True, 'seed': seed}
        self._given = {
            'tracker': ('tracker', {**whole, 'use_sim_time': True}),
            'simulator': ('radar_simulator', simulator),
        }
        self._running = {
            name: context.enter_context(contextlib.ExitStack()) for name in self._given
        }
        self.tracker = 0  # the number of its process
        for name in self._given:
            self.begin(name)

    def begin(self, name: str) -> None:
        """Ends the node, if it runs, and begins it again."""
        self._running[name].close()
        child = self._running[name].enter_context(child_of(*self._given[name]))
        if name == 'tracker':
            self.tracker = child.process.pid


def _live(args: Namespace, progress: Progress) -> 'SoakResult':
    from ..nodes import domain
    from ..nodes.soak import RECOVERED, Incident, SoakResult, megabytes
    from ..nodes.soak_live import SoakListener

    memory: list[tuple[float, float]] = []
    incidents: list[Incident] = []
    held: list[int] = []
    with contextlib.ExitStack() as context:
        domain.set_local(os.environ, context.enter_context(domain.free_domain()))
        nodes = _Nodes(args.rate, args.seed, context)
        listener = SoakListener()
        context.callback(listener.close)
        listener.spin(60.0, lambda: listener.held > 0)
        listener.spin(SETTLED_S)
        began = time.monotonic()
        while (hours := (time.monotonic() - began) * args.rate / 3600) < args.hours:
            progress(round(3600 * hours), round(3600 * args.hours))
            listener.spin(BETWEEN_S)
            held.append(listener.held)
            memory.append((hours, megabytes(nodes.tracker)))
            if not args.faults:
                continue
            fault = LIVE_FAULTS[len(incidents) % len(LIVE_FAULTS)]
            before = listener.held
            if fault in BEGIN_AGAIN:
                nodes.begin(fault)
            else:
                listener.throw(fault)
            scans = listener.until_held(RECOVERED * before)
            incidents.append(Incident(fault, hours, before, scans))
    exceptions = ['counted by the tracker'] * listener.failed
    return SoakResult(incidents, np.array(memory), float(np.mean(held)), exceptions)
