"""A recording through the tracker, scored: what a user would get of it with each estimator."""

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from ..parameters import TrackerParameters, from_mapping
from ..recording import csv_folder
from ..recording.csv_folder import Recording
from ..recording.track_file import TrackRows
from ..simulation import radar, scenario
from ..tracking.lifecycle import STATUS_NAMES
from ..tracking.tracker import Tracker
from . import metrics


def figures(recording: Recording, estimator: str) -> dict[str, Any]:
    """`metrics.score` of the tracks with the recording's own parameters and this estimator."""
    parameters = {**recording.tracker_parameters, 'estimator': estimator}
    tracker = Tracker(from_mapping(TrackerParameters, parameters))
    return metrics.score(recording, follow(tracker, recording)).figures


def follow(tracker: Tracker, recording: Recording) -> TrackRows:
    """The rows that `replay` would write."""
    names, rows, memory = np.array(STATUS_NAMES), [], tracker.start()
    for number, scan in zip(recording.numbers.tolist(), recording.scans, strict=True):
        memory, report = tracker.step(memory, scan)
        now = tracker.extrapolate(report.tracks, report.time)
        rows.append(
            (
                now.time,
                report.tracks.id.astype(str),
                names[report.tracks.status],
                now.position,
                now.velocity,
                report.predicted,
                np.full(len(now.time), number),
            )
        )
    return TrackRows(*map(np.concatenate, zip(*rows)))


def simulated(chosen: scenario.Scenario, seed: int) -> Recording:
    """A scenario as a recording."""
    with tempfile.TemporaryDirectory() as work:
        folder = Path(work, chosen.name)
        csv_folder.write(
            folder, chosen.name, radar.simulate(chosen, seed), chosen.tracker_parameters()
        )
        return csv_folder.read(folder)
