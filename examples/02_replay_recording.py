"""Track a recording and score the tracks against the truth recorded with it.

    python examples/02_replay_recording.py [FOLDER]

FOLDER holds plots.csv, own_ship.csv and truth.csv (the form is told in recording/csv_folder.py).
Without one, a scenario is recorded first, as `marine_tracker scenario write` does.
"""

import sys
import tempfile
from pathlib import Path

from marine_tracker import service_for
from marine_tracker.evaluation import metrics
from marine_tracker.evaluation.replay import write_tracks
from marine_tracker.recording import csv_folder, track_file
from marine_tracker.simulation import radar, scenario

with tempfile.TemporaryDirectory() as work:
    if len(sys.argv) > 1:
        folder = Path(sys.argv[1])
    else:
        folder = Path(work, 'encounters')
        chosen = scenario.load('encounters')
        csv_folder.write(
            folder, chosen.name, radar.simulate(chosen, seed=1), chosen.tracker_parameters()
        )

    recording = csv_folder.read(folder)
    plots = sum(len(scan.plots.time) for scan in recording.scans)
    print(f'{len(recording.scans)} scans with {plots} plots')

    tracks = Path(work, 'tracks.csv')
    for estimator in ('cs_kalman', 'imm'):
        service = service_for(recording.tracker_parameters, estimator=estimator)
        with open(tracks, 'w', newline='') as file:
            write_tracks(service, zip(recording.numbers, recording.scans), file)
        figures = metrics.score(recording, track_file.read(tracks)).figures
        print(
            f'{estimator:9s}  held {figures["held"]:6.1%}'
            f'  position {figures["position_rmse_m"]:5.1f} m'
            f'  velocity {figures["velocity_rmse_mps"]:5.2f} m/s'
            f'  GOSPA {figures["gospa_mean_m"]:6.1f} m'
        )
