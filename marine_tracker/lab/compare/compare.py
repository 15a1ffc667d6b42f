"""Compares every estimator on every kind of scene, to help choose one.

RMS errors of position and velocity, for each estimator of the registry with its default settings:

    straight, turns, fast boat     the tracks of `marine_table`, each plot given to its track
    sharp turns, boat              B tracks that turn hard, of ships and of boats (ship_tracks)
    busy strait                    40 ships and clutter, through the whole tracker
    AIS                            real ships drive the simulator; with --data
    recordings                     real radar, with --data

`runs` is the number of Monte Carlo tracks of the first five scenes. A scene through the whole
tracker runs once for every 50 of them; a recording runs once. Imazu's encounters go through the
whole service. There the ARPA judges danger by a motion model of its own, which does not depend on
the estimator.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...conformance import encounters
from ...conformance.encounters import WARNED_BEFORE
from ...estimators import ESTIMATORS, Estimator
from ...evaluation import parallel, replay, report
from ...evaluation.result import Progress, Result, silent
from ...files import write_text
from ...parameters import TrackerParameters
from ...recording import csv_folder
from ...simulation import scenario
from ...training import ship_tracks, track_trials
from .. import marine_table
from ..marine_table import BEARING_SIGMA, PERIOD, RANGE_SIGMA
from . import pictures

HELP = 'all estimators on all scenes, the recordings too: which one to choose when'
RUNS = 200
OPTIONS = {
    'data': {
        'metavar': 'FOLDER',
        'help': 'folder of recordings (plots.csv ...) and of AIS (ais.csv), one folder each',
    },
    'page': {'metavar': 'FILE', 'help': 'also write the table into this page, between its marks'},
}
AIS_OWN_SHIP = '14'  # a vessel that reports all the time and meets several others
AIS_SCENE = {
    'duration_s': 1800,
    'ais': {'file': 'ais.csv'},
    'own_ship': {'vessel': AIS_OWN_SHIP},
    'radar': {'max_range_nm': 24},
    'clutter': {'uniform': 50},
}
SHARP = {
    'sharp turns': ('ship', ship_tracks.KINDS, (1500.0, 6000.0)),
    'boat': ('small_craft', ship_tracks.SMALL_CRAFT, (150.0, 1500.0)),
}
SHARP_SCANS = 150


class Errors(NamedTuple):
    """One estimator in one scene: RMS errors in m and m/s; share of the time that targets were
    held; nan where there is no data for a figure.
    """

    position: float
    velocity: float
    held: float = 1.0


def made(name: str, vessel_class: str = 'ship') -> Estimator:
    """The estimator with its default settings."""
    return ESTIMATORS[name](
        TrackerParameters(estimator=name, vessel_class=vessel_class, range_sigma_m=RANGE_SIGMA)
    )


def run(
    runs: int,
    seed: int,
    progress: Progress = silent,
    data: str | None = None,
    page: str | None = None,
    workers: parallel.Workers = None,
) -> Result:
    """Every estimator of the registry in every scene."""
    scenes = scenes_of(runs, seed, data)
    work = [
        parallel.Job(function, (name, *arguments))
        for name in ESTIMATORS
        for function, *arguments in scenes.values()
    ]
    results = iter(parallel.run(work, workers, progress))
    found = {name: {scene: next(results) for scene in scenes} for name in ESTIMATORS}
    figures = [
        report.Figure(f'{name}, {scene}: {what}', getattr(errors, what), unit)
        for name, row in found.items()
        for scene, errors in row.items()
        for what, unit in (('position', 'm'), ('velocity', 'm/s'), ('held', ''))
        if what != 'held' or errors.held != 1.0
    ]
    figures += _imazu(max(1, runs // 200), seed, workers)
    if page:
        write_table(page, found)
    return Result(figures, pictures=[pictures.picture(found)])


def scenes_of(runs: int, seed: int, data: str | None) -> dict[str, tuple[Any, ...]]:
    """For each scene a function, and its arguments after the estimator's name."""
    scenes: dict[str, tuple[Callable[..., Errors], *tuple[Any, ...]]] = {
        name: (on_track, name, runs, seed) for name in marine_table.TRACKS
    }
    scenes |= {name: (in_sharp_turns, name, runs, seed) for name in SHARP}
    whole = max(1, runs // 50)
    scenes['busy strait'] = (in_traffic, 'busy_strait', whole, seed)
    if data is not None:
        folders = sorted(path for path in Path(data).iterdir() if path.is_dir())
        if not any((one / 'ais.csv').exists() or (one / 'plots.csv').exists() for one in folders):
            raise ValueError(f'--data {data} has no folder with plots.csv or ais.csv')
        for folder in folders:
            if (folder / 'ais.csv').exists():
                scenes[f'AIS, {folder.name}'] = (in_traffic, str(folder), whole, seed)
            elif (folder / 'plots.csv').exists():
                scenes[folder.name] = (on_recording, str(folder))
    return scenes


def on_track(name: str, track: str, runs: int, seed: int) -> Errors:
    """A track of `marine_table`."""
    return Errors(*marine_table.errors(made(name), marine_table.TRACKS[track], runs, seed))


def in_sharp_turns(name: str, scene: str, runs: int, seed: int) -> Errors:
    """Targets that turn hard, at ranges of their kind."""
    vessel_class, kinds, (near, far) = SHARP[scene]
    rng = np.random.default_rng([seed, 7])
    ships = ship_tracks.sail(
        ['sharp'] * runs,
        rng.uniform(near, far, runs),
        np.full((runs, SHARP_SCANS), PERIOD),
        rng,
        kinds=kinds,
    )
    every = np.ones(runs)
    on = track_trials.trial(
        ships,
        ship_tracks.RunRadar(
            RANGE_SIGMA * every,
            BEARING_SIGMA * every,
            0.9 * every,
            0 * every,
            every,
            PERIOD * every,
        ),
        rng,
    )
    estimator, count = made(name, vessel_class), np.arange(runs)
    state, off = estimator.init(on.plots[0]), []
    for k in range(1, SHARP_SCANS):
        rows = count[on.seen[:, k]]
        state = estimator.update(state, track_trials.take(on.plots[k], rows), rows)
        if k >= track_trials.SETTLED:
            now = estimator.extrapolate(state, ships.time[:, k])
            off.append((now.position - ships.position[:, k], now.velocity - ships.velocity[:, k]))
    return Errors(*(float(np.sqrt(np.mean(np.square([pair[i] for pair in off])))) for i in (0, 1)))


def in_traffic(name: str, scene: str, runs: int, seed: int) -> Errors:
    """A shipped scenario, or the ships of a folder's AIS reports, through the whole tracker."""
    if Path(scene).is_dir():
        chosen = scenario.build(AIS_SCENE, 'ais', Path(scene))
    else:
        chosen = scenario.load(scene)
    seeds = np.random.SeedSequence([seed, 8]).generate_state(runs).tolist()
    return _scored([replay.figures(replay.simulated(chosen, one), name) for one in seeds])


def on_recording(name: str, folder: str) -> Errors:
    """A recording through the whole tracker."""
    return _scored([replay.figures(csv_folder.read(folder), name)])


def _scored(runs: list[dict[str, Any]]) -> Errors:
    def mean(name, power):
        told = [run[name] for run in runs if run[name] is not None]
        return float(np.mean(np.power(told, power)) ** (1 / power)) if told else float('nan')

    # The score has the error of both axes together; elsewhere in this module it is per axis.
    return Errors(
        mean('position_rmse_m', 2) / np.sqrt(2),
        mean('velocity_rmse_mps', 2) / np.sqrt(2),
        mean('held', 1),
    )


def _imazu(runs: int, seed: int, workers: parallel.Workers) -> list[report.Figure]:
    """The encounters: dangers warned of in time, and CPA error 3 minutes after acquisition."""
    found = encounters.run(list(ESTIMATORS), runs, seed, workers=workers)
    figures = []
    for e, name in enumerate(ESTIMATORS):
        warned = np.concatenate([one.warned[e].ravel() for one in found])
        cpa = np.concatenate([one.cpa[e].ravel() for one in found])
        figures += [
            report.Figure(
                f'{name}, Imazu: warned with 6 minutes left', float(np.mean(warned > WARNED_BEFORE))
            ),
            report.Figure(
                f'{name}, Imazu: CPA off after 3 minutes, 95 %', float(np.percentile(cpa, 95)), 'NM'
            ),
        ]
    return figures


BEGIN, END = '<!-- table: begin -->', '<!-- table: end -->'


def write_table(page: str, found: dict[str, dict[str, Errors]]) -> None:
    """Writes the table, one row a scene, between the marks of the page.

    ValueError if the page has no marks.
    """
    text = Path(page).read_text()
    head, begin, rest = text.partition(BEGIN)
    _, end, tail = rest.partition(END)
    if not (begin and end):
        raise ValueError(f'{page} has not the lines {BEGIN} and {END}')
    lines = [
        '| scene | ' + ' | '.join(f'`{name}`' for name in found) + ' |',
        '|---' * (len(found) + 1) + '|',
    ]
    for scene in next(iter(found.values())):
        row = [errors[scene] for errors in found.values()]
        best = [np.nanmin([one[k] for one in row] + [np.inf]) for k in (0, 1)]
        lines.append(f'| {scene} | ' + ' | '.join(_cell(one, best) for one in row) + ' |')
    write_text(page, '\n'.join([head + begin, *lines, end + tail]))


def _cell(errors: Errors, best) -> str:
    def told(value, least, places):
        if np.isnan(value):
            return '-'
        text = f'{value:.{places}f}'
        return f'**{text}**' if value <= 1.02 * least else text

    cell = f'{told(errors.position, best[0], 1)} / {told(errors.velocity, best[1], 2)}'
    return cell if errors.held == 1.0 else f'{cell} ({100 * errors.held:.0f} %)'
