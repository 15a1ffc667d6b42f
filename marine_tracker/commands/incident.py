"""Looks at a moment of a recording: targets, alarms, and the manoeuvre that would have cleared it.

The recording is tracked again up to that moment, with the parameters that were recorded. For
several times before it, the least change of course to either side and the least loss of speed are
told that would have kept every target outside the CPA limit (with a risk below 5 %), and how near
the targets would have come then, as they really moved.
"""

import calendar
import re
import sys
import time
from argparse import ArgumentParser, Namespace
from typing import Any

import numpy as np

from ..arpa.view import told
from ..evaluation import incident, screened
from ..evaluation.incident import Incident
from ..geometry import KNOT, NAUTICAL_MILE, to_range_bearing
from ..parameters import ArpaParameters, from_mapping
from ..recording.csv_folder import Recording
from ..service import Service
from . import incident_picture, tracker_options

HELP = 'look at a moment of a recording: alarms, and what would have cleared it'
MOST_TARGETS, MOST_ALARMS = 12, 20
NOTHING = 'no change of course or speed would have cleared it'


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the command line of `incident`."""
    parser.add_argument('source', metavar='FILE', help='a recording: MCAP, or a folder of CSV')
    parser.add_argument(
        '--at',
        metavar='TIME',
        required=True,
        help='s from the beginning of the recording, or UTC as 14:05:30 or 2026-03-08T14:05:30',
    )
    parser.add_argument(
        '--before',
        type=float,
        default=15.0,
        metavar='MIN',
        help='how far back to look (default 15)',
    )
    parser.add_argument(
        '--after',
        type=float,
        default=10.0,
        metavar='MIN',
        help='how long targets are followed past a manoeuvre (default 10)',
    )
    parser.add_argument('--picture', metavar='FILE.png', help='a chart of it')
    tracker_options.add_arguments(parser)


def run(args: Namespace) -> int:
    """ValueError if there is no such moment in the recording."""
    for name in ('before', 'after'):
        if not 0 <= getattr(args, name) <= 600:
            raise ValueError(f'--{name} is {getattr(args, name):g} min; it must be 0 to 600')
    recording, remarks = screened.read(args.source)
    for remark in remarks:
        print(remark, file=sys.stderr)
    begin = float(recording.notes.get('begin_s', 0.0))
    at = moment(args.at, begin, recording)
    service = Service(
        tracker_options.parameters(args, recording.tracker_parameters),
        from_mapping(ArpaParameters, recording.notes.get('arpa', {})),
    )
    found = incident.find(service, recording.scans, at, 60 * args.before, 60 * args.after)
    for line in report(found, recording.name, begin):
        print(line)
    if args.picture:
        title = f'{recording.name}, {clock(found.time, begin)}'
        incident_picture.draw(found, title, args.picture)
    return 0


def moment(text: str, begin: float, recording: Recording) -> float:
    """s of the recording. ValueError if it is no time, or not in the recording."""
    first, last = recording.scans[0].start, recording.scans[-1].end
    clock_time = re.fullmatch(r'(?:(\d{4}-\d\d-\d\d)[T ])?(\d\d:\d\d:\d\d)(\.\d+)?Z?', text)
    try:
        if clock_time:
            day = clock_time[1] or time.strftime('%Y-%m-%d', time.gmtime(begin + first))
            parsed = time.strptime(f'{day} {clock_time[2]}', '%Y-%m-%d %H:%M:%S')
            at = calendar.timegm(parsed) + float(clock_time[3] or 0) - begin
            if not clock_time[1] and at < first - 1:
                at += 86_400  # past midnight
        else:
            at = float(text)
    except ValueError:
        raise ValueError(f'--at is {text[:60]!r}; it must be seconds, or UTC as 14:05:30') from None
    if not first <= at <= last + 1:
        raise ValueError(
            f'--at is {text[:60]}; the recording goes from {clock(first, begin)} to '
            f'{clock(last, begin)}'
        )
    return at


def clock(seconds: float, begin: float) -> str:
    """The time of day in UTC, if the recording tells it, else s."""
    if begin < 1e8:  # no clock that was set
        return f'{seconds:.1f} s'
    return time.strftime('%Y-%m-%d %H:%M:%S UTC', time.gmtime(begin + seconds))


def report(found: Incident, name: str, begin: float) -> list[str]:
    """The lines to print."""
    picture = found.output.picture
    speed, course = to_range_bearing(picture.own.velocity)
    lines = [
        f'{name}, {clock(found.time, begin)}',
        f'own ship: course {degrees(course)} deg, {speed / KNOT:.1f} kn',
        '',
        'target  range NM  bearing  course  speed kn   CPA NM  TCPA min  danger',
    ]
    shown, names = told(picture), incident.names(picture, found.output.report.tracks.number)
    order = np.lexsort((shown.range, -shown.danger_probability))
    for row in order[:MOST_TARGETS]:
        miles = (shown.range[row] / NAUTICAL_MILE, shown.cpa[row] / NAUTICAL_MILE)
        lines.append(
            f'{names[row]:7s} {miles[0]:8.2f}  {degrees(shown.bearing[row])}    '
            f'{degrees(shown.course[row])}   {shown.speed[row] / KNOT:8.1f} '
            f'{miles[1]:8.2f}  {shown.tcpa[row] / 60:8.1f}  '
            f'{100 * shown.danger_probability[row]:4.0f} %'
        )
    if len(order) > MOST_TARGETS:
        lines.append(f'and {len(order) - MOST_TARGETS} more')
    lines += ['', 'alarms before it:' if found.alarms else 'no alarms before it']
    lines += [f'  {clock(at, begin)}  {words}' for at, words in found.alarms[-MOST_ALARMS:]]
    lines += [
        '',
        'what would have cleared it:' if found.remedies else 'nothing would have cleared it',
    ]
    for one in found.remedies:
        change = f'{np.degrees(one.change):.0f} deg to {one.kind}, course {degrees(one.course)}'
        if one.kind == incident.SLOWER:
            change = f'{one.change / KNOT:.1f} kn slower, {one.speed / KNOT:.1f} kn'
        lines.append(
            f'  {one.before / 60:4.1f} min before: {change}; nearest '
            f'{_miles(one.nearest)} as known then, {_miles(one.really)} as they moved'
        )
    return lines


def degrees(angle: Any) -> str:
    """000 to 359; --- for nan."""
    return '---' if np.isnan(angle) else f'{round(float(np.degrees(angle))) % 360:03d}'


def _miles(distance: float) -> str:
    return f'{distance / NAUTICAL_MILE:.2f} NM' if np.isfinite(distance) else 'none'
