"""Recordings under the screen of live data: what the node would reject is rejected and counted."""

from pathlib import Path

import numpy as np

from ..parameters import TrackerParameters, from_mapping
from ..recording import csv_folder
from ..recording.csv_folder import Recording
from ..recording.mcap_name import is_mcap
from ..tracking import intake, own_ship
from ..types import Array, OwnShip, PolarPlots, Scan, take


def read(folder: str | Path) -> tuple[Recording, tuple[str, ...]]:
    """A recording without what the live screen rejects, and in a line what that was, if any.

    folder  of CSV files; or an MCAP file, or a folder of those
    """
    if is_mcap(folder):
        from . import recorded_topics  # needs packages of the extra `record`

        return recorded_topics.read(folder)
    recording, counts = screened(csv_folder.read(folder))
    if not counts:
        return recording, ()
    reasons = ', '.join(f'{count} {reason}' for reason, count in counts.items())
    return recording, (f'recording {recording.name}; rejected: {reasons}',)


def screened(recording: Recording) -> tuple[Recording, dict[str, int]]:
    """The recording without bad plots and own ship's bad samples; how many, by reason.

    Where own ship's sample is bad, she is where the good ones about it put her. A recording in
    which nothing is bad comes back as it is. ValueError where its tracker parameters are wrong.
    """
    parameters = from_mapping(TrackerParameters, recording.tracker_parameters)
    own, counts = _own_ship(recording.own_ship)
    scans = []
    for k, scan in enumerate(recording.scans):
        plots, rejected = _plots(scan, parameters)
        for reason, count in rejected.items():
            counts[reason] = counts.get(reason, 0) + count
        around = take(own, slice(max(k - 1, 0), k + 2))
        scans.append(scan._replace(plots=plots, own_ship=around))
    if not counts:
        return recording, counts
    return recording._replace(scans=tuple(scans), own_ship=own), counts


def _plots(scan: Scan, parameters: TrackerParameters) -> tuple[PolarPlots, dict[str, int]]:
    period = max(scan.end - scan.start, parameters.scan_period_s)
    relative = scan.plots._replace(time=scan.plots.time - scan.start)
    plots, rejected = intake.screen_plots(relative, period, parameters.max_plots)
    if not rejected:
        return scan.plots, rejected
    return plots._replace(time=plots.time + scan.start), rejected


def _own_ship(samples: OwnShip) -> tuple[OwnShip, dict[str, int]]:
    good = np.zeros(len(samples.time), bool)
    log = own_ship.empty_log()
    counts: dict[str, int] = {}
    for k, (time, position, velocity) in enumerate(zip(*samples[:3])):
        log, reason = own_ship.admit_own_ship(log, time, position, velocity)
        if reason == own_ship.OWN_REBASED:  # those that waited were right
            good |= np.isin(samples.time, log.taken.time)
        elif not reason:
            good[k] = True
    bad = int(np.count_nonzero(~good))
    if not bad:
        return samples, counts
    counts[f'samples of own ship of {len(good)}'] = bad
    if not good.any():
        return OwnShip(samples.time, *np.zeros((2, len(good), 2))), counts

    def mended(values: Array) -> Array:
        columns = [np.interp(samples.time, samples.time[good], c[good]) for c in values.T]
        return np.where(good[:, None], values, np.stack(columns, -1))

    place, velocity = mended(samples.position), mended(samples.velocity)
    return samples._replace(position=place, velocity=velocity), counts
