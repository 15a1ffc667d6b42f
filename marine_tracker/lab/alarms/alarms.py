"""How often the alarm of danger sounds, beside the dangers that there truly are.

    busy strait    40 ships and clutter; each run has noise of its own
    AIS            the simulator driven by the ships of a folder's ais.csv, with --data
    yaw            six steady ships pass at .6 to 1.4 of the CPA limit while own ship yaws by up to
                   10 degrees in 30 to 60 s; a run is one scene for each amplitude and period

An operator acknowledges each alarm 20 s after it sounds. A danger is true where CPA and TCPA, from
how the ships really moved, were below the limits for a minute or more. An alarm belongs to the
danger of its ship that is nearest in time; it is a renewal where another sounded for the same
danger before, and without need where that danger is more than SOON before or after, or its ship
never was one.
"""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arpa.cpa import cpa_of
from ...arpa.situation import Limits
from ...evaluation import parallel, report
from ...evaluation.report import Figure
from ...evaluation.result import Progress, Result, silent
from ...simulation import scenario
from . import yawing
from .watch import Watch, keep

HELP = 'alarms an hour beside the true dangers, and alarms renewed by yaw'
RUNS = 10
OPTIONS = {
    'data': {
        'metavar': 'FOLDER',
        'help': 'folder of recordings; those with an ais.csv drive the simulator',
    }
}
LASTING = 60.0  # s of true danger that must raise an alarm
APART = 60.0  # s without danger, after which the next of a ship is another one
SOON = 120.0  # s about a true danger in which its alarm is not without need
YAWS = [(0.0, 0.0)] + [(a, t) for a in (4.0, 7.0, 10.0) for t in (30.0, 38.0, 47.0, 60.0)]
OWN_SHIPS = 6  # of a folder, one after the other
BEGINS = (0.0, 1790.0)  # s of the reports
AIS_SCENE: dict[str, Any] = {
    'duration_s': 1800,
    'radar': {'max_range_nm': 12},
    'clutter': {'uniform': 50},
}


class Tally(NamedTuple):
    """Of one watch: hours; true dangers, and those that no alarm told; alarms that sounded for the
    first time, again, without need; dangers of the moment that do not count."""

    hours: float
    dangers: int
    missed: int
    first: int
    renewed: int
    needless: int


def run(
    runs: int,
    seed: int,
    progress: Progress = silent,
    data: str | None = None,
    workers: parallel.Workers = None,
) -> Result:
    """Every scene `runs` times."""
    seeds = np.random.SeedSequence([seed, 11]).generate_state(runs).tolist()
    folders = _with_ais(data)
    work = [parallel.Job(in_strait, (one,)) for one in seeds]
    work += [
        parallel.Job(in_ais, (str(folder), begin, vessel, one))
        for folder, own_ships in folders.items()
        for begin, vessel in own_ships
        for one in seeds[: max(1, runs // 2)]
    ]
    count = len(work)
    work += [
        parallel.Job(under_yaw, (amplitude, period, turn, one))
        for turn, one in enumerate(seeds)
        for amplitude, period in YAWS
    ]
    found = parallel.run(work, workers, progress)
    figures = _traffic('busy strait', found[:runs])
    for folder in folders:
        its = [
            one
            for job, one in zip(work, found, strict=True)
            if job.function is in_ais and job.arguments[0] == str(folder)
        ]
        figures += _traffic(f'AIS, {folder.name}', its)
    return Result(figures + _yaw(np.array(found[count:])))


def _with_ais(data: str | None) -> dict[Path, list[tuple[float, str]]]:
    """The folders with AIS, and when which of their vessels is to be own ship."""
    if data is None:
        return {}
    found = {file.parent: _own_ships(file.parent) for file in sorted(Path(data).glob('*/ais.csv'))}
    if not any(found.values()):
        raise ValueError(
            f'--data {data} has no folder with an ais.csv in which a vessel reports all the time '
            'and meets another'
        )
    return found


def _own_ships(folder: Path) -> list[tuple[float, str]]:
    """Those that meet most others: begin s, and vessel."""
    limits, candidates = Limits(), []
    for begin in BEGINS:
        try:
            loaded = scenario.build(_scene(begin), 'ais', folder)
        except ValueError:  # the reports have ended
            break
        ships = loaded.fleet.paths.ships - 1
        times = np.linspace(0.0, AIS_SCENE['duration_s'], 31)
        there = np.zeros((len(times), ships), bool)
        meet = np.zeros((ships, ships), bool)
        for k, time in enumerate(times):
            truth = loaded.truth_at(time)
            row = truth.target - 1
            there[k, row] = True
            cpa, tcpa = cpa_of(
                truth.position[:, None] - truth.position, truth.velocity[:, None] - truth.velocity
            )
            meet[np.ix_(row, row)] |= (cpa < limits.cpa) & (tcpa >= 0) & (tcpa < limits.tcpa)
        candidates += [
            (-int(meet[ship].sum()), begin, loaded.fleet.names[ship].removeprefix('AIS '))
            for ship in np.flatnonzero(there.all(0))
            if meet[ship].any()
        ]
    return [(begin, vessel) for _, begin, vessel in sorted(candidates)[:OWN_SHIPS]]


def _scene(begin: float) -> dict[str, Any]:
    return {**AIS_SCENE, 'ais': {'file': 'ais.csv', 'start_s': begin}}


def in_strait(seed: int) -> Tally:
    """The scenario `busy_strait`."""
    return tally(keep(scenario.load('busy_strait'), seed))


def in_ais(folder: str, begin: float, vessel: str, seed: int) -> Tally:
    """The ships of a folder's AIS reports from `begin` s on, one of which is own ship."""
    chosen = {**_scene(begin), 'own_ship': {'vessel': vessel}}
    return tally(keep(scenario.build(chosen, 'ais', Path(folder)), seed))


def under_yaw(amplitude: float, period: float, turn: int, seed: int) -> NDArray[np.int64]:
    """[SHARES, 2]: how often the alarm sounded for each ship, and whether one was missed."""
    watch = keep(yawing.passing(amplitude, period, turn), seed, swing=period)
    order = np.argsort(yawing.shares(turn))
    sounded = np.bincount(watch.ship[watch.ship >= 0], minlength=len(order))
    told = (watch.alarmed & watch.dangerous).any(0)
    missed = watch.dangerous.any(0) & ~told
    return np.stack([sounded, missed.astype(np.int64)], 1)[order]


def tally(watch: Watch) -> Tally:
    """The alarms of a watch by what they were for."""
    dangers = missed = first = renewed = needless = 0
    for ship in range(watch.dangerous.shape[1]):
        time = watch.time[watch.dangerous[:, ship]]
        spans = np.split(time, (np.diff(time) > APART).nonzero()[0] + 1) if len(time) else []
        ends = np.array([(span[0], span[-1]) for span in spans]).reshape(-1, 2)
        sounded = watch.sounded[watch.ship == ship]
        alarmed = watch.time[watch.alarmed[:, ship]]
        for begin, end in ends[ends[:, 1] - ends[:, 0] >= LASTING]:
            dangers += 1
            missed += not ((alarmed >= begin) & (alarmed <= end)).any()
        off = np.maximum(ends[:, 0] - sounded[:, None], sounded[:, None] - ends[:, 1])
        off = np.maximum(off, 0.0)  # [alarms, dangers]
        its = off.argmin(1)[off.min(1) <= SOON] if len(ends) else sounded[:0]
        needless += len(sounded) - len(its)
        first += len(np.unique(its))
        renewed += len(its) - len(np.unique(its))
    needless += int((watch.ship < 0).sum())
    return Tally(float(np.ptp(watch.time)) / 3600, dangers, missed, first, renewed, needless)


def _traffic(name: str, found: list[Tally]) -> list[Figure]:
    whole = Tally(*(sum(column) for column in zip(*found, strict=True)))
    hours = max(whole.hours, 1e-9)
    return [
        Figure(f'{name}: true dangers', whole.dangers / hours, '1/h'),
        Figure(
            f'{name}: alarms',
            (whole.first + whole.renewed + whole.needless) / hours,
            '1/h',
            against='true dangers',
        ),
        Figure(f'{name}: alarms renewed', whole.renewed / hours, '1/h'),
        Figure(f'{name}: alarms without need', whole.needless / hours, '1/h'),
        report.at_most(f'{name}: dangers without an alarm', whole.missed, 0),
    ]


def _yaw(found: NDArray[np.int64]) -> list[Figure]:
    """found [runs x YAWS, SHARES, 2], run by run."""
    found = found.reshape(-1, len(YAWS), len(yawing.SHARES), 2)
    figures = []
    for k, (amplitude, period) in enumerate(YAWS):
        name = f'yaw of {amplitude:g} deg in {period:g} s' if amplitude else 'no yaw'
        sounded, missed = found[:, k, :, 0], found[:, k, :, 1]
        far = np.sort(yawing.SHARES) > 1
        figures += [
            report.at_most(f'{name}: alarms renewed, of any ship', _most(sounded - 1), 1),
            Figure(f'{name}: alarms renewed, a ship', float(np.maximum(sounded - 1, 0).mean())),
            Figure(
                f'{name}: of ships beyond the limit with an alarm',
                float((sounded[:, far] > 0).mean()),
            ),
            report.at_most(f'{name}: dangers without an alarm', int(missed.sum()), 0),
        ]
    return figures


def _most(renewed: NDArray[np.int64]) -> int:
    return max(int(renewed.max()), 0)
