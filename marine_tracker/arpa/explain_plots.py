"""What the radars saw at a place, and what became of it, in words: a part of explain.py."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ..geometry import KNOT, NAUTICAL_MILE, to_range_bearing
from ..tracking import clutter_map, score
from ..tracking.initiate import PAIRING_GATE
from ..tracking.lifecycle import TENTATIVE
from ..tracking.noise import noise_of
from ..tracking.tracker import Report, Tracker, TrackerMemory
from ..types import Array, BoolArray, Extrapolation, Plots, Scan, take
from .arpa import Arpa, Picture
from .cpa import OwnMotion
from .targets import label

SCANS = 10  # that are looked back on, of each radar
SIGMAS = 3.0  # of a plot: what lies so near is "here"
LEAST_REACH = 60.0  # m


class Reason(NamedTuple):
    """One thing that is known: what it is about, in words, and whether it alone decides."""

    about: str
    text: str
    decides: bool = False


class Seen(NamedTuple):
    """What one scan came to, as far as it is looked back on; see `seen`.

    scan      as the tracker took it
    report    without the states of the tracks, which are large
    position  [N, 2]  m, of the report's tracks
    own       own ship at its end
    """

    scan: Scan
    report: Report
    position: Array
    own: OwnMotion


class Place(NamedTuple):
    """What is asked about: a position [2] m, and how near to it is "here", m."""

    position: Array
    reach: float


def seen(scan: Scan, report: Report, estimate: Extrapolation, picture: Picture) -> Seen:
    """Of the fields of a service.Output what is worth keeping."""
    tracks = report.tracks._replace(state=(), past=())
    return Seen(scan, report._replace(tracks=tracks), estimate.position, picture.own)


def newest_of(recent: Sequence[Seen]) -> list[Seen]:
    """The last scan of each radar, the newest last."""
    last = {seen.scan.radar: seen for seen in recent}
    return sorted(last.values(), key=lambda seen: seen.scan.end)


def scans_of(recent: Sequence[Seen], radar: int) -> list[Seen]:
    """The last SCANS of a radar."""
    return [seen for seen in recent if seen.scan.radar == radar][-SCANS:]


def antenna(scan: Scan) -> Array:
    """[2] m, where it was at the end of the scan."""
    position: Array = scan.measured_from.position[-1]
    return position


def reach_of(position: Array, tracker: Tracker, newest: Sequence[Seen]) -> float:
    """m: SIGMAS deviations of a plot there, of the radar that is least certain."""
    reach = LEAST_REACH
    for seen in newest:
        noise = noise_of(tracker.radars[seen.scan.radar], seen.scan)
        away = float(np.hypot(*(position - antenna(seen.scan))))
        across = away * noise.bearing_sigma
        reach = max(
            reach, SIGMAS * float(np.hypot(max(noise.range_sigma, across), noise.glint_sigma))
        )
    return reach


def of_radar(arpa: Arpa, radar: int) -> str:
    """' of radar NAME', where there are several."""
    return f' of {arpa.radars[radar].name}' if len(arpa.radars) > 1 else ''


def plots_seen(
    there: Place, tracker: Tracker, arpa: Arpa, memory: TrackerMemory, recent: Sequence[Seen]
) -> Iterator[Reason]:
    """What each radar saw there in its last scans, and what became of the newest plots."""
    for radar in range(len(arpa.radars)):
        scans = scans_of(recent, radar)
        if not scans:
            yield Reason('plots', f'no scan{of_radar(arpa, radar)} has come yet')
            continue
        located = [noise_of(tracker.radars[radar], seen.scan).locate(seen.scan) for seen in scans]
        here = [_near(plots, there) for plots in located]
        count = sum(bool(near.any()) for near in here)
        name = of_radar(arpa, radar)
        if not count:
            text = f'no plot{name} within {there.reach:.0f} m in the last {len(scans)} scans'
            yield Reason('plots', text, len(arpa.radars) == 1)
            continue
        back = next(k for k in range(len(here)) if here[-1 - k].any())
        when = 'the last one too' if not back else f'not in the last {back}'
        yield Reason(
            'plots',
            f'plots{name} within {there.reach:.0f} m in {count} of the last {len(scans)} scans, '
            f'{when}',
        )
        if not back:
            yield from _taken(there, tracker, memory, scans[-1], located[-1], here[-1])
            if len(scans) > 1:
                yield from _speed(there, tracker, radar, scans[-2:], located[-2:], here[-1])


def _near(plots: Plots, there: Place) -> BoolArray:
    found: BoolArray = np.hypot(*(plots.position - there.position).T) <= there.reach
    return found


def _free(seen: Seen, count: int) -> BoolArray:
    """Mask of the plots that no track took."""
    free = np.ones(count, bool)
    free[seen.report.plot[seen.report.plot >= 0]] = False
    return free


def _taken(
    there: Place, tracker: Tracker, memory: TrackerMemory, seen: Seen, plots: Plots, here: BoolArray
) -> Iterator[Reason]:
    """What became of the plots of the newest scan here."""
    report, lone = seen.report, memory.radars[seen.scan.radar].leftover
    for plot in here.nonzero()[0]:
        row = (report.plot == plot).nonzero()[0]
        if len(row):
            tracks = take(report.tracks, row)
            if tracks.status[0] == TENTATIVE:
                continue  # told as the track that is being built
            (name,) = label(tracks.id, tracks.number)
            yield Reason('gate', f'the newest plot here was taken by the track {name}')
        elif ((lone.time == plots.time[plot]) & (lone.range == plots.range[plot])).any():
            text = 'the newest plot here is alone: a track begins when the next scan has one nearby'
            yield Reason('lone plot', text, True)
        else:
            yield Reason('gate', _explained_by(tracker, memory, plots, int(plot)), True)


def _explained_by(tracker: Tracker, memory: TrackerMemory, plots: Plots, plot: int) -> str:
    """A plot that is neither taken nor alone lies in the gate of a track that is held."""
    tracks = take(memory.tracks, memory.tracks.number > 0)
    text = 'the newest plot here begins no track: it is in the gate of another one'
    if not len(tracks.id):
        return text
    ahead = tracker.extrapolate(tracks, float(plots.time[plot]))
    offset = ahead.position - plots.position[plot]
    spread = ahead.covariance[:, :2, :2] + plots.covariance[plot]
    nis = np.einsum('ni,ni->n', offset, np.linalg.solve(spread, offset[..., None])[..., 0])
    near = int(np.argmin(nis))
    (name,) = label(tracks.id[near : near + 1], tracks.number[near : near + 1])
    return f'{text}, {name}, {np.hypot(*offset[near]):.0f} m away, which may have caused it'


def _speed(
    there: Place,
    tracker: Tracker,
    radar: int,
    scans: Sequence[Seen],
    located: Sequence[Plots],
    here: BoolArray,
) -> Iterator[Reason]:
    """A lone plot here whose nearest lone plot of the scan before is too far away for its time."""
    limit = tracker.radars[radar].max_target_speed_mps
    noise = noise_of(tracker.radars[radar], scans[-1].scan)
    before, now = (noise.with_glint(plots) for plots in located)
    first = _free(scans[0], len(before.time)).nonzero()[0]
    for plot in (here & _free(scans[-1], len(now.time))).nonzero()[0]:
        step = now.time[plot] - before.time[first]
        way = np.hypot(*(before.position[first] - now.position[plot]).T)
        spread = np.sqrt(
            0.5 * np.trace(before.covariance[first] + now.covariance[plot], axis1=1, axis2=2)
        )
        excess = (way - limit * step) / spread
        if len(first) and (excess**2 > PAIRING_GATE)[excess > 0].all() and (excess > 0).all():
            near = int(np.argmin(way))
            needs = way[near] / step[near] / KNOT
            yield Reason(
                'speed',
                f'the nearest free plot of the scan before lies {way[near]:.0f} m away: that is '
                f'{needs:.0f} kn, {limit / KNOT:.0f} kn is the limit (max_target_speed_mps)',
                True,
            )


def clutter(
    there: Place, tracker: Tracker, arpa: Arpa, memory: TrackerMemory, newest: Sequence[Seen]
) -> Iterator[Reason]:
    """How dense false plots are there, and whether a track can be confirmed among them."""
    for seen in newest:
        radar = seen.scan.radar
        p, noise = tracker.radars[radar], noise_of(tracker.radars[radar], seen.scan)
        away, bearing = to_range_bearing((there.position - antenna(seen.scan))[None])
        density = clutter_map.density(memory.radars[radar].clutter, away, bearing)
        sigma = np.array([noise.range_sigma, max(float(away[0]) * noise.bearing_sigma, 1.0)])
        log_det = np.log(2 * sigma**2 + 2 * noise.glint_sigma**2).sum()
        gain = float(
            score.evidence(np.array([2.0]), np.array([log_det]), density, p.detection_probability)[
                0
            ]
        )
        a_scan = float(density[0]) * NAUTICAL_MILE**2
        text = f'false plots here{of_radar(arpa, radar)}: {a_scan:.2g} a scan and square mile'
        most = max(gain, 0.0) * p.confirm_scans
        if most < p.confirm_score:
            text += (
                f'; even {p.confirm_scans} plots in a row give a score of {most:.1f} only, '
                f'{p.confirm_score:.1f} confirms'
            )
        yield Reason('clutter', text, most < p.confirm_score)
