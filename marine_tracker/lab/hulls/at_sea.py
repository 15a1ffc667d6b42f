"""One ship seen as cells, tracked with its extent: errors of length, course and centre."""

from typing import NamedTuple

import numpy as np

from ...extent.hulls import BY_GAUSSIAN_PROCESS
from ...geometry import wrap_angle
from ...service import service_for
from ...simulation import radar, scenario
from ...tracking.lifecycle import CONFIRMED

SPEED = 6.0  # m/s
SCANS = 44  # two minutes
PERIOD = 60 / 22  # s
BEARING = 45.0  # deg, of the ship at the middle of the run
BEAMS = {60: 12, 120: 20, 200: 32, 300: 45}
FINE, COARSE = (10.0, 0.75), (30.0, 1.2)  # m, deg: cells of a short and of a long pulse


class Case(NamedTuple):
    """A ship of `length` m. At the middle of the run it is `distance` m away, `aspect` deg off the
    line of sight.
    """

    length: int
    distance: float
    aspect: float
    cell: tuple[float, float]


class HullsAtSea(NamedTuple):
    """The results of one run. Errors are estimate minus truth, nan if nothing was tracked.

    length m, course rad, beam m; centre [2] m along and across the ship's axis, mean of the last
    half; outlined: share of the last half with an outline
    """

    length: float
    course: float
    beam: float
    centre: tuple[float, float]
    outlined: float


def scene(case: Case) -> scenario.Scenario:
    """The ship alone; own ship is at rest."""
    course = BEARING + case.aspect
    way = 0.5 * SCANS * PERIOD * SPEED
    at, along = np.radians(BEARING), np.radians(course)
    return scenario.build(
        {
            'duration_s': (SCANS + 0.5) * PERIOD,
            'radar': {
                'range_resolution_m': case.cell[0],
                'beam_width_deg': case.cell[1],
                'range_sigma_m': 0.6 * case.cell[0],
                'bearing_sigma_deg': 0.4 * case.cell[1],
                'max_range_m': 8000,
            },
            'targets': [
                {
                    'start': {
                        'north_m': float(case.distance * np.cos(at) - way * np.cos(along)),
                        'east_m': float(case.distance * np.sin(at) - way * np.sin(along)),
                    },
                    'course_deg': course,
                    'speed_mps': SPEED,
                    'length_m': case.length,
                    'hull': {'beam_m': BEAMS[case.length]},
                }
            ],
        },
        'one ship',
    )


def run(case: Case, extent: str, seed: int) -> HullsAtSea:
    """One run of the tracker with extents."""
    loaded = scene(case)
    service = service_for(loaded.tracker_parameters(), extent=extent)
    memory = service.start()
    course = np.radians(BEARING + case.aspect)
    ahead = np.array([np.sin(course), np.cos(course)])
    axes = np.stack([ahead, [ahead[1], -ahead[0]]])
    off, lined, last = [], [], (np.nan,) * 3
    for k, (scan, truth) in enumerate(radar.simulate(loaded, seed)):
        memory, (_, report, estimate, shapes) = service.track(memory, scan)
        assert shapes is not None
        there = truth.position[0] + (report.time - truth.time[0])[:, None] * truth.velocity[0]
        away = np.hypot(*(estimate.position - there).T)
        away[(report.tracks.status != CONFIRMED)] = np.inf
        if not np.isfinite(away).any():
            continue
        row = int(away.argmin())
        velocity = memory.extents.hulls.matrix.mean[row, 2:]
        last = (
            shapes.length[row] - case.length,
            wrap_angle(np.arctan2(*velocity) - course),
            shapes.beam[row] - BEAMS[case.length],
        )
        if k >= SCANS // 2:
            off.append(axes @ (estimate.position[row] - there[row]))
            lined.append(memory.extents.hulls.method[row] == BY_GAUSSIAN_PROCESS)
    if not off:
        return HullsAtSea(*last, (np.nan, np.nan), 0.0)
    return HullsAtSea(*last, tuple(np.mean(off, 0)), float(np.mean(lined)))
