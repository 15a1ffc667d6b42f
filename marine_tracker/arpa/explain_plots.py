"""What the radars saw at a place, and what became of it, in words: a part of explain.py."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ..geometry import KNOT, NAUTICAL_MILE, to_range_bearing
from ..tracking import surroundings
from ..tracking.initiate import PAIRING_GATE
from ..tracking.land_mask import on_land
from ..tracking.lifecycle import TENTATIVE
from ..tracking.noise import Noise, noise_of
from ..tracking.tracker import Report, Tracker, TrackerMemory
from ..types import Array, BoolArray, CodeArray, Extrapolation, IntArray, Plots, Scan, take
from .arpa import Arpa, Picture
from .cpa import OwnMotion
from .targets import label

SCANS = 10  # revolutions that are looked back on, of each radar
SIGMAS = 3.0  # of a plot: what lies so near is "here"
LEAST_REACH = 60.0  # m


class Reason(NamedTuple):
    """One thing that is known: what it is about, in words, and whether it alone decides."""

    about: str
    text: str
    decides: bool = False


class Seen(NamedTuple):
    """What one revolution came to, as far as it is looked back on; see `seen`.

    scan      whose plots the report tells of; of a radar that sends sectors all of them
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


def seen(report: Report, estimate: Extrapolation, picture: Picture) -> Seen:
    """Of the fields of a service.Output what is worth keeping."""
    tracks = report.tracks._replace(state=(), past=())
    return Seen(report.scan, report._replace(tracks=tracks), estimate.position, picture.own)


def newest_of(recent: Sequence[Seen]) -> list[Seen]:
    """The last scan of each radar, the newest last."""
    last = {seen.scan.radar: seen for seen in recent}
    return sorted(last.values(), key=lambda seen: seen.scan.end)


class Turn(NamedTuple):
    """M plots of a revolution, and the track that took each: its id (0: none), number, status."""

    plots: Plots
    id: IntArray
    number: IntArray
    status: CodeArray

    @property
    def free(self) -> BoolArray:
        """Mask of the plots that no track took."""
        found: BoolArray = self.id == 0
        return found


def turns_of(recent: Sequence[Seen], tracker: Tracker, radar: int) -> list[Turn]:
    """The last SCANS revolutions of a radar."""
    scans = [seen for seen in recent if seen.scan.radar == radar][-SCANS:]
    return [_turn(seen, noise_of(tracker.radars[radar], seen.scan)) for seen in scans]


def _turn(seen: Seen, noise: Noise) -> Turn:
    report, plots = seen.report, noise.locate(seen.scan)
    rows = (report.plot >= 0).nonzero()[0]
    of_plot = np.zeros((3, len(plots.time)), np.int64)
    tracks = report.tracks
    of_plot[:, report.plot[rows]] = tracks.id[rows], tracks.number[rows], tracks.status[rows]
    return Turn(plots, of_plot[0], of_plot[1], of_plot[2].astype(np.int8))


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
    of_each = [turns_of(recent, tracker, radar) for radar in range(len(arpa.radars))]
    nearby = [[_near(turn.plots, there) for turn in turns] for turns in of_each]
    unseen = not any(near.any() for here in nearby for near in here)
    for radar, (turns, here) in enumerate(zip(of_each, nearby, strict=True)):
        name = of_radar(arpa, radar)
        if not turns:
            yield Reason('plots', f'no scan{name} has come yet')
            continue
        count = sum(bool(near.any()) for near in here)
        if not count:
            text = f'no plot{name} within {there.reach:.0f} m in the last {len(turns)} scans'
            yield Reason('plots', text, unseen)
            continue
        back = next(k for k in range(len(here)) if here[-1 - k].any())
        when = 'the last one too' if not back else f'not in the last {back}'
        yield Reason(
            'plots',
            f'plots{name} within {there.reach:.0f} m in {count} of the last {len(turns)} scans, '
            f'{when}',
        )
        if not back:
            yield from _taken(tracker, memory, radar, turns[-1], here[-1])
            if len(turns) > 1:
                yield from _speed(tracker, radar, turns[-2], turns[-1], here[-1])


def _near(plots: Plots, there: Place) -> BoolArray:
    found: BoolArray = np.hypot(*(plots.position - there.position).T) <= there.reach
    return found


def _taken(
    tracker: Tracker, memory: TrackerMemory, radar: int, turn: Turn, here: BoolArray
) -> Iterator[Reason]:
    """What became of the newest plots here."""
    plots, lone = turn.plots, memory.radars[radar].leftover
    for plot in here.nonzero()[0]:
        if turn.id[plot] and turn.status[plot] != TENTATIVE:
            (name,) = label(turn.id[plot : plot + 1], turn.number[plot : plot + 1])
            yield Reason('gate', f'the newest plot here was taken by the track {name}')
        elif turn.id[plot]:
            continue  # told as the track that is being built
        elif ((lone.time == plots.time[plot]) & (lone.range == plots.range[plot])).any():
            text = 'the newest plot here is alone: a track begins when the next scan has one nearby'
            yield Reason('lone plot', text, True)
        elif not on_land(tracker.land, plots.position[plot][None])[0]:
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
    tracker: Tracker, radar: int, before: Turn, now: Turn, here: BoolArray
) -> Iterator[Reason]:
    """A lone plot here whose nearest lone plot of the scan before is too far away for its time."""
    p = tracker.radars[radar]
    limit, glint = p.max_target_speed_mps, 2 * p.glint_sigma_m**2
    plots, old = now.plots, take(before.plots, before.free)
    for plot in (here & now.free).nonzero()[0]:
        step = plots.time[plot] - old.time
        way = np.hypot(*(old.position - plots.position[plot]).T)
        spread = old.covariance + plots.covariance[plot]
        sigma = np.sqrt(0.5 * np.trace(spread, axis1=1, axis2=2) + glint)
        if len(way) and (way - limit * step > np.sqrt(PAIRING_GATE) * sigma).all():
            near = int(np.argmin(way))
            yield Reason(
                'speed',
                f'the nearest free plot of the scan before lies {way[near]:.0f} m away: that is '
                f'{way[near] / step[near] / KNOT:.0f} kn, {limit / KNOT:.0f} kn is the limit '
                '(max_target_speed_mps)',
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
        known = memory.radars[radar].known
        sigma = np.array([noise.range_sigma, max(float(away[0]) * noise.bearing_sigma, 1.0)])
        log_det = np.log(2 * sigma**2 + 2 * noise.glint_sigma**2).sum()
        density, most = surroundings.prospects(known, away, bearing, log_det, p)
        a_scan = float(density[0]) * NAUTICAL_MILE**2
        text = f'false plots here{of_radar(arpa, radar)}: {a_scan:.2g} a scan and square mile'
        hopeless = float(most[0]) < p.confirm_existence
        if hopeless:
            text += (
                f'; even {p.confirm_scans} plots in a row make a target no more probable than '
                f'{most[0]:.2g}, {p.confirm_existence:g} confirms'
            )
        yield Reason('clutter', text, hopeless)
