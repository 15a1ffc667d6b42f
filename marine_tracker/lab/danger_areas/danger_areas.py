"""Predicted areas of danger against ships that are sailed: is a course dangerous that crosses one?

Five scenes go through the whole service. At one moment of each, own ship tries 200 courses at
random, at her present speed. For each of them the true state of every target is drawn from its
estimate, with own ship's own error; both sail on, and the nearest distance is measured. A course
agrees where, for every target, the share of draws that pass within the limit is above the risk if
and only if the course crosses an area of that target. Passing is coming nearer first: a target that
only goes away does not.
"""

from typing import NamedTuple

import numpy as np

from ...arpa.cpa import OwnMotion
from ...arpa.danger_areas import RISK, DangerAreas, dangers
from ...arpa.motion import Motion
from ...evaluation import parallel, report
from ...evaluation.report import Figure
from ...evaluation.result import Progress, Result, silent
from ...geometry import NAUTICAL_MILE, unit_vector
from ...service import service_for
from ...simulation import radar, scenario
from ...types import Array, BoolArray

HELP = 'predicted areas of danger beside ships that are sailed'
RUNS = 3
LIMIT, WITHIN = 0.5 * NAUTICAL_MILE, 1800.0  # m, s
COURSES = 200
DRAWS = 20_000
AGREE = 0.99
# Scenes, and the moment of each, s: few plots and large errors, and long tracks.
SCENES = (
    ('encounters', 60.0),
    ('encounters', 300.0),
    ('imazu_17', 120.0),
    ('busy_strait', 90.0),
    ('busy_strait', 400.0),
)


class Passes(NamedTuple):
    """Of N targets on C courses, from draws.

    share  [C, N]  that pass within the limit
    some   [C]     in which at least one target does
    inside [C, N]  of the passes, those whose nearest point lies in the area; nan without passes
    """

    share: Array
    some: Array
    inside: Array


def run(
    runs: int, seed: int, progress: Progress = silent, workers: parallel.Workers = None
) -> Result:
    """Every scene `runs` times."""
    seeds = np.random.SeedSequence([seed, 23]).generate_state(runs).tolist()
    work = [parallel.Job(judge, (*scene, one)) for scene in SCENES for one in seeds]
    found = np.array(parallel.run(work, workers, progress)).reshape(len(SCENES), runs, -1).mean(1)
    figures = []
    for (name, moment), (targets, areas, agree, ring, safe, inside) in zip(
        SCENES, found.tolist(), strict=True
    ):
        scene = f'{name} after {moment:g} s'
        figures += [
            Figure(f'{scene}: targets', targets),
            Figure(f'{scene}: areas', areas),
            report.at_least(f'{scene}: courses that agree', agree, AGREE, against='sailed ships'),
            report.at_least(f'{scene}: ring agrees', ring, AGREE, against='sailed ships'),
            Figure(f'{scene}: safe courses', safe),
            Figure(f'{scene}: passes that lie in their area', inside),
        ]
    every = found.mean(0)
    figures.append(report.at_least('all: courses that agree', every[2], AGREE))
    return Result(figures)


def judge(name: str, moment: float, seed: int) -> list[float]:
    """Of a scene: targets, areas, shares of courses that agree, of courses whose ring agrees, of
    safe ones, and of passes that lie in their area."""
    motion, own = picture(name, moment, seed)
    rng = np.random.default_rng([seed, 5])
    course = rng.uniform(0, 2 * np.pi, COURSES)
    found = dangers(motion, own, LIMIT, WITHIN)
    crossed, near, far = crossing(found.areas, course, len(motion.position))
    sailed = sail(motion, own, course, near, far, rng)
    agrees = (crossed == (sailed.share >= RISK)).all(1)
    # The ring stands at half degrees: the nearest one tells.
    place = np.round(course / found.course[1]).astype(int) % len(found.course)
    ring = found.safe[place] == (sailed.some < RISK)
    weight = np.where(crossed, sailed.share, 0.0)
    inside = float(np.nansum(weight * sailed.inside) / max(weight.sum(), 1e-9))
    return [
        len(motion.position),
        len(found.areas.row),
        agrees.mean(),
        ring.mean(),
        found.safe.mean(),
        inside,
    ]


def picture(name: str, moment: float, seed: int) -> tuple[Motion, OwnMotion]:
    """The targets' motion and own ship's after `moment` s of a scenario, as the service tells."""
    loaded = scenario.load(name)
    service = service_for(loaded.tracker_parameters())
    memory = service.start()
    for scan, _ in radar.simulate(loaded, seed):
        memory, output = service.step(memory, scan)
        if scan.end >= moment:
            return output.picture.motion, output.picture.own
    raise ValueError(f'{name} ends before {moment:g} s')


def crossing(areas: DangerAreas, course: Array, targets: int) -> tuple[BoolArray, Array, Array]:
    """[C, N]: whether each course [C] rad crosses an area of each target, and the stretch of it, m,
    as drawn: straight between the points of the outline."""
    shape = len(course), targets
    crossed, near, far = np.zeros(shape, bool), np.full(shape, np.nan), np.full(shape, np.nan)
    for row, edge, first, last in zip(areas.row, areas.course, areas.near, areas.far, strict=True):
        turned = edge[0] + (course - edge[0]) % (2 * np.pi)
        its = turned <= edge[-1]
        crossed[its, row] = True
        near[its, row] = np.interp(turned[its], edge, first)
        far[its, row] = np.interp(turned[its], edge, last)
    return crossed, near, far


def sail(
    motion: Motion,
    own: OwnMotion,
    course: Array,
    near: Array,
    far: Array,
    rng: np.random.Generator,
    draws: int = DRAWS,
    limit: float = LIMIT,
    within: float = WITHIN,
) -> Passes:
    """Draws of both ships' states, sailed on on each course [C] rad; near, far [C, N] m."""
    speed = float(np.hypot(*own.velocity))
    error = rng.multivariate_normal(np.zeros(4), own.covariance, draws)
    steered = speed * unit_vector(course)
    share = np.zeros(near.shape)
    inside = np.full(near.shape, np.nan)
    some = np.zeros((len(course), draws), bool)
    for row in range(len(motion.position)):
        state = rng.multivariate_normal(
            np.concatenate([motion.position[row], motion.velocity[row]]),
            motion.covariance[row],
            draws,
        )
        place = state[:, :2] - own.position - error[:, :2]
        for k, velocity in enumerate(steered):
            way = state[:, 2:] - velocity - error[:, 2:]
            squared = np.maximum((way * way).sum(1), 1e-12)
            time = np.clip(-(place * way).sum(1) / squared, 0.0, within)
            distance = np.hypot(*(place + time[:, None] * way).T)
            passes = (distance < limit) & (time > 0) & (time < within)
            share[k, row] = passes.mean()
            some[k] |= passes
            if passes.any() and np.isfinite(near[k, row]):
                sailed = speed * time[passes]
                inside[k, row] = ((sailed >= near[k, row]) & (sailed <= far[k, row])).mean()
    return Passes(share, some.mean(1), inside)
