"""List, check, show or write scenarios, which the radar simulator plays.

A scenario is the name of a shipped one, or a YAML file of your own. For the form of a file, use
`scenario show` on a shipped scenario, or see its file in config/scenarios.
"""

import sys
from argparse import ArgumentParser, Namespace
from typing import Any

import numpy as np

from ..geometry import KNOT, NAUTICAL_MILE, to_range_bearing
from ..recording import csv_folder
from ..simulation import radar, scenario

HELP = 'list, check, show or write scenarios'


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the sub-commands and their options."""
    commands = parser.add_subparsers(title='what to do', metavar='ACTION', required=True)
    listed = commands.add_parser('list', help='the shipped scenarios')
    listed.set_defaults(action=_list)
    checked = commands.add_parser('check', help='whether scenario files are right')
    checked.add_argument('files', nargs='+', metavar='FILE', help='scenario file, or name')
    checked.set_defaults(action=_check)
    shown = commands.add_parser('show', help='what happens in a scenario')
    shown.add_argument('scenario', help='name of a shipped scenario, or a file')
    shown.add_argument('--plot', metavar='FILE.png', help='draw it, too (needs matplotlib)')
    shown.set_defaults(action=_show)
    written = commands.add_parser('write', help='simulate it into a recording folder')
    written.add_argument('scenario', help='name of a shipped scenario, or a file')
    written.add_argument('folder', help='folder of CSV files to write')
    written.add_argument('--seed', type=int, default=1, help='of all chance (default: 1)')
    written.set_defaults(action=_write)


def run(args: Namespace) -> int:
    """Runs the sub-command. Returns 1 if a checked file is wrong."""
    return args.action(args)


def _tell(loaded):
    for remark in loaded.fleet.remarks:
        print(remark, file=sys.stderr)
    return loaded


def _list(args):
    rows = []
    for name in scenario.shipped():
        loaded = scenario.load(name)
        rows.append(
            (
                name,
                f'{len(loaded.fleet.names)}',
                f'{loaded.duration / 60:g} min',
                loaded.description,
            )
        )
    _print_table(('scenario', 'targets', 'duration', ''), rows, '<><<')
    return 0


def _check(args):
    wrong = 0
    for file in args.files:
        try:
            loaded = scenario.load(file)
        except ValueError as error:
            print(error, file=sys.stderr)
            wrong = 1
        else:
            _tell(loaded)
            print(f'{file}: ok, {len(loaded.fleet.names)} targets, {loaded.scans} scans')
    return wrong


def _show(args):
    loaded = _tell(scenario.load(args.scenario))
    print(loaded.name + (f': {loaded.description}' if loaded.description else ''))
    for line in _conditions(loaded):
        print(f'  {line}')
    print()
    _print_table(
        ('no', 'target', 'range NM', 'bearing', 'course', 'speed kn', 'closest NM', 'at min'),
        _target_rows(loaded),
        '><>>>>>>',
    )
    if args.plot:
        from .scenario_chart import draw

        draw(loaded, args.plot)
        print(f'\ndrawn: {args.plot}')
    return 0


def _write(args):
    loaded = _tell(scenario.load(args.scenario))
    if args.seed < 0:
        raise ValueError(f'--seed is {args.seed}; it must not be negative')
    csv_folder.write(
        args.folder,
        f'{loaded.name}, seed {args.seed}',
        radar.simulate(loaded, args.seed),
        loaded.tracker_parameters(),
        _notes(loaded),
    )
    print(f'{loaded.name}: {loaded.scans} scans written to {args.folder}')
    return 0


def _notes(loaded):
    """Notes for `score`: the cutoffs for this scenario, from where the radar is least accurate."""
    sigma = np.radians(loaded.tracker_parameters()['bearing_sigma_deg']) * loaded.radar.max_range
    near = float(round(max(50.0, 2 * sigma)))
    notes: dict[str, Any] = {'seen_within_m': near, 'cutoff_m': 2 * near, 'uncooperative': False}
    origin = loaded.fleet.origin
    if origin is not None:
        notes['origin'] = [origin.latitude, origin.longitude]
    return notes


def _conditions(loaded):
    about, false = loaded.radar, loaded.clutter
    own = loaded.own_ship_at(0.0)
    yield f'{loaded.duration / 60:g} min, {loaded.scans} scans at {about.rotation:g} rpm'
    yield (
        f'own ship: course {_course(own.velocity[0])}, {np.hypot(*own.velocity[0]) / KNOT:.1f} kn'
    )
    yield (
        f'radar: {about.blind_range:.0f} m to {about.max_range / NAUTICAL_MILE:g} NM; detection '
        f'{about.pd_near:g} near, {about.pd_far:g} far; resolves {about.range_resolution:g} m, '
        f'{np.degrees(about.beam_width):g} deg'
    )
    if about.sensor_errors == 'imo':
        yield 'errors: all sensor errors of the IMO test conditions'
    else:
        yield (
            f'noise: {about.range_sigma:g} m, {np.degrees(about.bearing_sigma):g} deg; bias '
            f'{about.range_bias:g} m, {np.degrees(about.bearing_bias):g} deg'
        )
    yield (
        f'false plots a scan: {false.uniform:g} everywhere'
        + (
            f', {false.sea:g} near own ship ({false.sea_scale / NAUTICAL_MILE:.2g} NM)'
            if false.sea
            else ''
        )
    )
    if len(loaded.fixed.place):
        yield f'fixed things that often give a plot: {len(loaded.fixed.place)}'
    if loaded.in_cells:
        hulls = np.isfinite(loaded.fleet.hulls.beam).sum()
        yield f'seen as cells: {hulls} hulls, {len(loaded.shores)} shores'


def _target_rows(loaded):
    """Each target where it first appears, and its closest approach in the scenario."""
    times = np.arange(0.0, loaded.duration + 0.5, 1.0)
    count = len(loaded.fleet.names)
    first = np.full(count, np.nan)
    closest, when = np.full(count, np.inf), np.full(count, np.nan)
    rows: list[tuple[str, ...]] = [()] * count
    for time in times:
        truth, own = loaded.truth_at(time), loaded.own_ship_at(time)
        target = truth.target - 1
        distance, bearing = to_range_bearing(truth.position - own.position)
        for row in np.flatnonzero(np.isnan(first[target])):
            first[target[row]] = time
            velocity = truth.velocity[row]
            rows[target[row]] = (
                f'{truth.target[row]}',
                loaded.fleet.names[target[row]],
                f'{distance[row] / NAUTICAL_MILE:.2f}',
                f'{np.degrees(bearing[row]):05.1f}',
                _course(velocity),
                f'{np.hypot(*velocity) / KNOT:.1f}',
            )
        nearer = distance < closest[target]
        closest[target[nearer]], when[target[nearer]] = distance[nearer], time
    return [
        (*row, f'{near / NAUTICAL_MILE:.2f}', f'{time / 60:.1f}')
        for row, near, time in zip(rows, closest, when)
        if row
    ]


def _course(velocity):
    speed, course = to_range_bearing(velocity)
    return f'{np.degrees(course):05.1f}' if speed > 0.01 else '-'


def _print_table(head, rows, align):
    width = [max(len(row[k]) for row in [head, *rows]) for k in range(len(head))]
    for row in [head, *rows]:
        print(
            '  '.join(
                f'{cell:{side}{size}}' for cell, side, size in zip(row, align, width)
            ).rstrip()
        )
