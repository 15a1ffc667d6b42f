"""Puts the sectors of a revolution together again, for what is done once a revolution."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..types import BoolArray, Scan, Tracks, append, take
from .lifecycle import LOST
from .sectors import HAIR, joined, rest_of, together, turned_since
from .sweep import TURN
from .tracker import Report


class Turn(NamedTuple):
    """What came of one radar's revolution so far.

    scans    its sectors
    reports  of the tracker, one a sector
    turned   rad, the beam, since the revolution began
    end      s, of the last sector; nan: none
    """

    scans: tuple[Scan, ...] = ()
    reports: tuple[Report, ...] = ()
    turned: float = 0.0
    end: float = math.nan

    def then(self, scan: Scan, *reports: Report) -> 'Turn':
        """With one more sector."""
        turned = self.turned + turned_since(self.end, scan)
        return Turn((*self.scans, scan), (*self.reports, *reports), turned, scan.end)

    def next(self, *reports: Report) -> 'Turn':
        """The next revolution, to which the reports belong."""
        return Turn((), reports, rest_of(self.turned), self.end)

    @property
    def complete(self) -> bool:
        """Whether the beam has turned once."""
        return self.turned >= TURN - HAIR


def whole(scans: Sequence[Scan]) -> Scan:
    """The revolution of sectors that follow one another."""
    scan = scans[0]
    for one in scans[1:]:
        antenna = one.antenna
        if scan.antenna is not None and antenna is not None:
            antenna = joined(scan.antenna, antenna)
        scan = scan._replace(
            end=one.end,
            plots=together(scan.plots, one.plots),
            own_ship=joined(scan.own_ship, one.own_ship),
            antenna=antenna,
        )
    return scan._replace(sector=None)


def report_of(turn: Turn, tracks: Tracks) -> tuple[Report, Turn]:
    """The report of the whole revolution, as of one scan, and what belongs to the next one.

    tracks  that are alive; those which no sector judged had no plot

    A track that was judged twice, where the revolution began and where it ended, is in this report
    as the first time, and in the next one again.
    """
    scan, now, later = whole(turn.scans), [], []
    known = np.zeros(0, np.int64)
    for report in turn.reports:
        ids = report.tracks.id
        twice = np.isin(ids, known)
        gone = (report.tracks.status != LOST) & ~np.isin(ids, tracks.id)  # by another radar
        now.append(_rows(report, ~twice & ~gone))
        if (twice & ~gone).any():
            later.append(_rows(report, twice & ~gone)._replace(begun=take(report.begun, slice(0))))
        known = np.append(known, ids)
    last = turn.reports[-1]._replace(scan=scan)
    now.append(_idle(take(tracks, ~np.isin(tracks.id, known)), last))
    return _joined(now, scan), turn.next(*later)


def _rows(report: Report, chosen: BoolArray) -> Report:
    """The chosen rows [N] of a report."""
    return report._replace(
        time=report.time[chosen],
        tracks=take(report.tracks, chosen),
        predicted=report.predicted[chosen],
        plot=report.plot[chosen],
        reason=report.reason[chosen],
    )


def _idle(tracks: Tracks, last: Report) -> Report:
    """Of tracks that were not looked at; the rest as in the last report."""
    count = len(tracks.id)
    return last._replace(
        time=tracks.last_time,
        tracks=tracks,
        predicted=np.full((count, 2), np.nan),
        plot=np.full(count, -1),
        reason=np.zeros(count, np.int8),
        begun=take(last.begun, slice(0)),
        left_out=0,
        scan=last.scan._replace(plots=take(last.scan.plots, slice(0))),
    )


def _joined(reports: Sequence[Report], scan: Scan) -> Report:
    """One report of all, its tracks in the order of their ids, those that began in it the last."""
    plots, begun = reports[0].scan.plots, reports[0].begun
    tracks, plot = reports[0].tracks, [reports[0].plot]
    for one in reports[1:]:
        plot.append(np.where(one.plot >= 0, one.plot + len(plots.time), -1))
        plots, begun = together(plots, one.scan.plots), together(begun, one.begun)
        tracks = append(tracks, one.tracks)
    order = tracks.id.argsort()
    new = [one.tracks.id[len(one.tracks.id) - len(one.begun.time) :] for one in reports]
    if not np.array_equal(np.concatenate(new), tracks.id[order][len(order) - len(begun.time) :]):
        begun = take(begun, slice(0))  # another radar began tracks meanwhile
    return Report(
        np.concatenate([one.time for one in reports])[order],
        take(tracks, order),
        np.concatenate([one.predicted for one in reports])[order],
        np.concatenate(plot)[order],
        np.concatenate([one.reason for one in reports])[order],
        begun,
        sum(one.left_out for one in reports),
        scan._replace(plots=plots),
        reports[-1].places,
        reports[-1].meetings,
    )
