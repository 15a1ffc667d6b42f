"""The estimator `gwnn` and its rivals on the same tracks: errors and their ratios, cell by cell.

Errors are those of the expectation one scan ahead, RMS per axis; positions in the plots'
deviations sigma. A cell is one kind of motion in one phase, under one set of radar conditions.
"""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...estimators import cs_kalman, imm
from ...estimators.contract import Estimator
from ...estimators.gwnn import bank_settings, gwnn, monitor
from ...geometry import unit_vector
from ...networks import gwnn_weights
from ...training import ship_tracks, track_trials, training_tracks
from ...training.track_trials import Ratio
from ...training.training_tracks import WATERS
from ...training.tuned import TUNED
from ...types import take
from . import held_out_tracks, strangers

SCANS = 150
SPEED = 25.0  # m/s, maximum target speed given to every estimator
LEAST_CELL = 300  # scans; smaller cells are not judged
AIS, BOAT = Path('ais_north_sea', 'ais.csv'), Path('autosea_joyride', 'truth.csv')
RECORDED = {'AIS': AIS, 'boat': BOAT}  # kinds of motion that need --data
HELD_OUT = {
    'autopilot': lambda file, steps, rng: held_out_tracks.nomoto(steps, rng),
    'paper turn': lambda file, steps, rng: held_out_tracks.paper_turn(steps, rng),
    'AIS': held_out_tracks.real_ships,
    'boat': held_out_tracks.recorded_boats,
}
# The network; with its monitor switched off; the reference of all ratios.
OWN, ALONE, IMM = 'GWNN', 'never falling back', 'IMM'
MANOEUVRE, LINE = 'IMM for manoeuvre', 'straight line'
# Kinds whose ships never change course nor speed: a fit to all plots is the best there can be.
STRAIGHT_KINDS = ('steady', 'still')
NEARLY_NONE = 1e-9  # m^2/s^3, density of the acceleration in that fit


class Conditions(NamedTuple):
    """A radar.

    range_sigma m; bearing_sigma deg; detection; outliers; truly: true deviation over the stated
    one; rpm; jitter: deviation of a scan's time over the time.
    """

    range_sigma: float
    bearing_sigma: float
    rpm: float
    detection: float = 1.0
    outliers: float = 0.0
    truly: float = 1.0
    jitter: float = 0.0


class Fleet(NamedTuple):
    """What a vessel class is judged on.

    radar     fair conditions
    ranges    m, at which tracks begin, or where their middle lies
    nearest   m; tracks that come nearer are left out
    held_out  kinds of motion that the training does not have
    usual     the kind of motion for measurements on one kind only
    """

    radar: Conditions
    ranges: tuple[float, float]
    nearest: float
    held_out: tuple[str, ...]
    usual: str


FLEETS = {
    'ship': Fleet(
        Conditions(25.0, 0.4, 22.0),
        (1500.0, 18000.0),
        1000.0,
        ('autopilot', 'paper turn', 'AIS', 'boat'),
        'mix',
    ),
    'small_craft': Fleet(Conditions(6.0, 0.7, 30.0), (150.0, 4000.0), 50.0, ('boat',), 'cruise'),
}


def kinds(vessel_class: str) -> tuple[str, ...]:
    """All kinds of motion that a vessel class is judged on; strangers last."""
    own = *WATERS[vessel_class].names, *FLEETS[vessel_class].held_out
    return own + (tuple(strangers.CRAFT) if vessel_class == 'ship' else ())


def is_stranger(vessel_class: str, kind: str) -> bool:
    """Whether ships of this kind come from the independent simulation."""
    return vessel_class == 'ship' and kind in strangers.CRAFT


def trial(
    vessel_class: str,
    kind: str,
    runs: int,
    radar: Conditions,
    rng: np.random.Generator,
    data: Path | None,
) -> track_trials.TrackTrial:
    """Tracks of one kind and a radar's plots of them; ValueError where a file is needed."""
    fleet = FLEETS[vessel_class]
    period = 60 / radar.rpm
    steps = period * (1 + radar.jitter * np.clip(rng.standard_normal((2 * runs, SCANS)), -3, 3))
    low, high = np.log(fleet.ranges)
    ranges = np.exp(rng.uniform(low, high, 2 * runs))
    hull = np.zeros(2 * runs)
    if is_stranger(vessel_class, kind):
        ships = strangers.sail(kind, steps, rng)
    elif kind in HELD_OUT:
        ships = HELD_OUT[kind](_file(data, kind), steps, rng)
        if kind in RECORDED:  # recorded tracks may lie anywhere: move them to where the others are
            away = ranges[:, None] * unit_vector(rng.uniform(0, 2 * np.pi, 2 * runs))
            ships = ships._replace(
                position=ships.position + (away - ships.position[:, SCANS // 2])[:, None]
            )
    else:
        waters = WATERS[vessel_class]
        number = np.full(2 * runs, waters.names.index(kind))
        ships, hull = training_tracks.sail(
            waters, number, ranges, steps, rng, np.full(2 * runs, np.inf)
        )
    nearest = np.hypot(*np.moveaxis(ships.position, -1, 0)).min(1)
    keep = np.flatnonzero(nearest > fleet.nearest)[:runs]
    ships, hull = take(ships, keep), hull[keep]
    every = np.ones(len(ships.time))
    return track_trials.trial(
        ships,
        ship_tracks.RunRadar(
            radar.range_sigma * every,
            np.radians(radar.bearing_sigma) * every,
            radar.detection * every,
            radar.outliers * every,
            radar.truly * every,
            period * every,
        ),
        rng,
        hull if hull.any() else None,
    )


def _file(data, kind) -> Path | None:
    file = RECORDED.get(kind)
    if file is None:
        return None
    if data is None:
        raise ValueError(f'{file} needs --data')
    return data / file


def rivals(vessel_class: str, kind: str) -> dict[str, Estimator]:
    """The filters to compare the network with.

    The IMMs are tuned on the tracks of the network's training; for ships of the independent
    simulation, on tracks of that.
    """
    tuned = TUNED[vessel_class]
    best = (
        strangers.TUNED
        if is_stranger(vessel_class, kind)
        else bank_settings.STRONGEST[vessel_class]
    )
    line = imm.Modes((NEARLY_NONE,), (0.0,), (1.0,), bank_settings.PERIOD)
    return {
        IMM: imm.imm(best['training'], SPEED),
        MANOEUVRE: imm.imm(best['manoeuvre'], SPEED),
        'IMM as shipped': imm.imm(imm.PRESETS[vessel_class], SPEED),
        'CV/CV': imm.imm(tuned.cv_cv, SPEED),
        'CS': cs_kalman.cs_kalman(tuned.cs, SPEED),
        'CS of the fallback': fallback(vessel_class),
        **({LINE: imm.imm(line, SPEED)} if kind in STRAIGHT_KINDS else {}),
    }


def fallback(vessel_class: str) -> Estimator:
    """What `gwnn` falls back to."""
    return cs_kalman.cs_kalman(bank_settings.SETTINGS[vessel_class].manoeuvre, SPEED)


def network(
    vessel_class: str, weights: gwnn_weights.Weights, period: float, **options: Any
) -> Estimator:
    """The estimator `gwnn` with its own options."""
    return gwnn.gwnn(weights, SPEED, period, vessel_class=vessel_class, **options)


class Cell(NamedTuple):
    """One kind of motion in one phase, `straight` or `manoeuvre`.

    rms       position RMS in sigma, by estimator
    position  ratio of position RMS to the IMM's, for every other estimator; velocity likewise
    over      ratio of the network's position RMS to each other estimator's
    faster    likewise of the velocity, to those it is to be compared with
    nis       mean NIS of the network; nees: mean NEES over its degrees of freedom, 1 in theory
    idle      share of the scans in fallback
    scans     their number
    """

    vessel_class: str
    kind: str
    phase: str
    rms: dict[str, float]
    position: dict[str, Ratio]
    velocity: dict[str, Ratio]
    over: dict[str, Ratio]
    faster: dict[str, Ratio]
    nis: float
    nees: float
    idle: float
    scans: int


def cells(
    vessel_class: str,
    kind: str,
    runs: int,
    radar: Conditions,
    seed: int,
    data: Path | None,
    weights: gwnn_weights.Weights,
) -> list[Cell]:
    """Both phases of one kind of motion, with these weights of the network."""
    rng = np.random.default_rng(seed)
    on = trial(vessel_class, kind, runs, radar, rng, data)
    period = 60 / radar.rpm
    fallen = np.zeros(on.seen.shape, bool)

    def watch(k, state):
        fallen[:, k] = state.monitor.status == monitor.FALLBACK

    outcomes = {OWN: track_trials.run(network(vessel_class, weights, period), on, False, watch)}
    outcomes[ALONE] = track_trials.run(
        network(vessel_class, weights, period, trust=monitor.Trust(np.inf, np.inf)), on, gated=False
    )
    outcomes |= {
        name: track_trials.run(rival, on, gated=True)
        for name, rival in rivals(vessel_class, kind).items()
    }
    found = []
    for phase, within in (('straight', ~on.phase), ('manoeuvre', on.phase)):
        chosen = within & on.counts
        if chosen.sum() < LEAST_CELL:
            continue

        def ratio(one, other, what, chosen=chosen):
            return track_trials.ratio(
                getattr(outcomes[one], what), getattr(outcomes[other], what), chosen, rng
            )

        found.append(
            Cell(
                vessel_class,
                kind,
                phase,
                {
                    name: track_trials.rms(outcome.position, chosen)
                    for name, outcome in outcomes.items()
                },
                {name: ratio(name, IMM, 'position') for name in outcomes if name != IMM},
                {name: ratio(name, IMM, 'velocity') for name in outcomes if name != IMM},
                {name: ratio(OWN, name, 'position') for name in outcomes if name != OWN},
                {
                    name: ratio(OWN, name, 'velocity')
                    for name in (MANOEUVRE, LINE)
                    if name in outcomes
                },
                float(outcomes[OWN].nis[chosen & on.seen].mean()),
                float(outcomes[OWN].nees[chosen].mean()),
                float(fallen[chosen].mean()),
                int(chosen.sum()),
            )
        )
    return found
