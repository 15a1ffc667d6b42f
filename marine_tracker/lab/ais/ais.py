"""AIS in the radar's picture: joined rightly, told when it is wrong, and quick enough.

    joined   40 ships, 12 of them in a lane 300 m apart; 70 % have AIS, 10 % of those of class B;
             reports come up to 10 s late; the radar measures 30 m and 1 degree too much
    spoofed  four ships of such a scene tell places 1 km off, or that walk off at 5 m/s
    fused    with AIS as another sensor of the tracks; a quarter of the runs
    recorded spokes with the sentences of the same seconds, with --data
    speed    1,000 ships and 200 tracks; sentences; broken sentences

A ship-scan counts where radar has a track of the ship, after the first minute.
"""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...evaluation import parallel, report
from ...evaluation.report import Figure
from ...evaluation.result import Picture, Progress, Result, silent
from ...types import Array
from . import fused, recorded, speed
from .tallies import TOLD_WITHIN, Tally, of_scene

HELP = 'ships of AIS joined to radar targets, and told when they are wrong'
RUNS = 20
OPTIONS = {
    'data': {
        'metavar': 'FOLDER',
        'help': 'folder of spokes (.npz) with sentences of the same seconds (.nmea) beside them',
    }
}
SPOOFS: dict[str, dict[str, float]] = {
    '1 km off': {'shift_m': 1000.0},
    'walking off at 5 m/s': {'walk_mps': 5.0},
}
BINS = np.array([0.0, 0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.98, 1.0])


def run(
    runs: int,
    seed: int,
    progress: Progress = silent,
    data: str | None = None,
    workers: parallel.Workers = None,
) -> Result:
    """Every scene `runs` times; then the recordings."""
    files = _recordings(data)
    seeds = np.random.SeedSequence([seed, 23]).generate_state(runs) % 1_000_000
    work = [
        parallel.Job(of_scene, (int(one), spoof))
        for spoof in (None, *SPOOFS.values())
        for one in seeds
    ]
    few = max(runs // 4, 1)
    work += [
        parallel.Job(fused.of_scene, (int(one), estimator))
        for estimator in fused.ESTIMATORS
        for one in seeds[:few]
    ]
    found = parallel.run(work, workers, progress)
    found, off = found[: 3 * runs], found[3 * runs :]
    honest = found[:runs]
    figures = _joined(honest) + _told(found, runs)
    for k, estimator in enumerate(fused.ESTIMATORS):
        figures += fused.figures(estimator, off[k * few : (k + 1) * few])
    figures += speed.figures(seed)
    chance = np.concatenate([one.chance for one in honest])
    pictures = [Picture('join_probability', (6, 4.5), _paint(chance))]
    for file in files:
        one = recorded.follow(file)
        figures += recorded.figures(one)
        pictures.append(recorded.picture(one))
    return Result(figures, (), pictures)


def _recordings(data: str | None) -> list[Path]:
    """The files of spokes of a folder that have sentences beside them. ValueError for none."""
    if data is None:
        return []
    found = [
        file for file in sorted(Path(data).glob('*.npz')) if file.with_suffix('.nmea').exists()
    ]
    if not found:
        raise ValueError(f'--data {data} has no file of spokes (.npz) with an .nmea beside it')
    return found


def _joined(found: list[Tally]) -> list[Figure]:
    right, wrong, missed = (
        np.array([getattr(one, name) for one in found]).sum(0)
        for name in ('right', 'wrong', 'missed')
    )
    whole = right + wrong + missed
    off = np.array([(one.range, np.degrees(one.bearing)) for one in found])
    figures = []
    for part, name in enumerate(('beside the lane', 'in the lane')):
        figures += [
            report.at_least(
                f'joined rightly, {name}', 100.0 * _share(right[part], whole[part]), 99.0, '%'
            ),
            report.at_most(
                f'joined wrongly, {name}', 100.0 * _share(wrong[part], whole[part]), 0.1, '%'
            ),
        ]
    figures += [
        report.at_most('error of the range after 5 minutes, greatest', _most(off[:, 0]), 5.0, 'm'),
        report.at_most(
            'error of the bearing after 5 minutes, greatest', _most(off[:, 1]), 0.1, 'deg'
        ),
    ]
    return figures


def _told(found: list[Tally], runs: int) -> list[Figure]:
    figures = []
    for k, name in enumerate(SPOOFS, 1):
        told = np.concatenate([one.told for one in found[k * runs : (k + 1) * runs]])
        soon = 100.0 * float(np.mean(told <= TOLD_WITHIN))
        figures += [
            report.at_least(f'{name}: told within 60 s', soon, 95.0, '%'),
            Figure(f'{name}: time until told, median', float(np.nanmedian(told)), 's'),
        ]
    hours = sum(one.hours for one in found)
    false = sum(one.mismatches for one in found)
    return [
        *figures,
        report.at_most('mismatches told wrongly', false / hours, 0.1, '1/ship-hour'),
        Figure('ship-hours', hours, 'h'),
    ]


def _share(part: NDArray[Any], whole: NDArray[Any]) -> float:
    return float(part / whole) if whole else float('nan')


def _most(errors: Array) -> float:
    return float(np.abs(errors).max())


def _paint(chance: Array) -> Any:
    """Paints how often pairs of a probability are the same."""

    def paint(canvas: Any) -> None:
        axis = canvas.subplots()
        probability, same = chance.T
        which = np.clip(np.digitize(probability, BINS) - 1, 0, len(BINS) - 2)
        for k in np.unique(which):
            its = which == k
            share, count = same[its].mean(), its.sum()
            spread = 2 * np.sqrt(max(share * (1 - share), 1 / count) / count)
            axis.errorbar(probability[its].mean(), share, spread, fmt='o', color='C0')
            axis.annotate(f' {count}', (probability[its].mean(), share), fontsize=8)
        axis.plot([0, 1], [0, 1], color='grey', linewidth=1)
        axis.set(
            xlabel='probability told',
            ylabel='share that is the same',
            xlim=(0, 1.02),
            ylim=(0, 1.02),
        )
        axis.set_title('Pairs of a ship and a track; numbers of pair-scans', fontsize=10)

    return paint
