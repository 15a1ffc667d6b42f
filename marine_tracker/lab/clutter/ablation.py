"""Ablation: what each part against clutter is good for.

The scenes of `experiments clutter`, and with --data recordings with truth, once with the whole
tracker and once without each of its parts (pieces.py): existence of tracks, learning of P_D, small
cells of the clutter map, joint association, plots of two targets, two plots of one target,
stationary places.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...evaluation import metrics, parallel, replay, report
from ...evaluation.result import Progress, Result, silent
from ...recording import csv_folder
from ...service import service_for
from . import clutter
from .pieces import PARTS, without

HELP = 'scenes with clutter, and recordings, without one part of the tracker after the other'
RUNS = 3
OPTIONS = {
    'estimator': {'default': 'gwnn', 'help': 'filter of the tracker (default gwnn)'},
    'scenes': {'nargs': '*', 'help': 'only these scenes (default: all)'},
    'without': {
        'nargs': '+',
        'metavar': 'PART',
        'help': f'leave out only these parts, one at a time (default: {", ".join(PARTS)})',
    },
    'data': {'metavar': 'FOLDER', 'help': 'folder of recordings with truth.csv, one folder each'},
}
WHOLE = 'all parts'


class Row(NamedTuple):
    """One scene with one part left out: mean GOSPA m, false tracks alive, part of the time that
    targets were held, and position RMSE m."""

    gospa: float
    false: float
    held: float
    rmse: float


def run(
    runs: int,
    seed: int,
    progress: Progress = silent,
    estimator: str = 'gwnn',
    scenes: list[str] | None = None,
    without: list[str] | None = None,
    data: str | None = None,
    workers: parallel.Workers = None,
) -> Result:
    """Every scene `runs` times for each part. ValueError for an unknown scene or part, and for
    data without truth."""
    chosen = clutter.chosen(scenes)
    parts: list[str | None] = [None, *chosen_parts(without)]
    folders = [] if data is None else recordings(data)
    jobs = [
        parallel.Job(simulated, (name, estimator, seed + k, part))
        for name in chosen
        for part in parts
        for k in range(runs)
    ] + [
        parallel.Job(recorded, (str(folder), estimator, part))
        for folder in folders
        for part in parts
    ]
    found = parallel.run(jobs, workers, progress)
    seam = len(chosen) * len(parts) * runs
    of_scenes = np.array(found[:seam]).reshape(len(chosen), len(parts), runs, 4).mean(2)
    of_folders = np.array(found[seam:]).reshape(len(folders), len(parts), 4)
    names = [*chosen, *(folder.name for folder in folders)]
    return Result(_figures(names, parts, [*of_scenes.tolist(), *of_folders.tolist()]))


def _figures(
    names: list[str], parts: list[str | None], rows: list[list[list[float]]]
) -> list[report.Figure]:
    """The figures of each scene, part by part: rows [scenes, parts, 4]."""
    return [
        report.Figure(f'{name}, {part and f"without {part}" or WHOLE}: {what}', value, unit)
        for name, of_scene in zip(names, rows)
        for part, row in zip(parts, of_scene)
        for what, value, unit in zip(Row._fields, row, ('m', '', '', 'm'))
    ]


def chosen_parts(wanted: list[str] | None) -> list[str]:
    """The parts that are to be left out. ValueError for an unknown one."""
    for part in wanted or []:
        with without(part):
            pass
    return wanted or list(PARTS)


def recordings(data: str) -> list[Path]:
    """The folders with plots and truth. ValueError if there is none."""
    found = sorted(one.parent for one in Path(data).glob('*/truth.csv'))
    if not found:
        raise ValueError(f'--data {data} has no folder with a truth.csv')
    return found


def simulated(name: str, estimator: str, seed: int, part: str | None) -> Row:
    """One run of a scene without the part."""
    with without(part) as values:
        found = clutter.follow(name, estimator, seed, **values)
    return Row(found.gospa, found.false, float(found.held.mean()), found.rmse)


def recorded(folder: str, estimator: str, part: str | None) -> Row:
    """A recording without the part."""
    recording = csv_folder.read(folder)
    with without(part) as values:
        service = service_for(recording.tracker_parameters, estimator=estimator, **values)
        found = metrics.score(recording, replay.follow(service, recording)).figures
    names = 'gospa_mean_m', 'false_per_scan', 'held', 'position_rmse_m'
    return Row(*(float(found[name] or 0) for name in names))
