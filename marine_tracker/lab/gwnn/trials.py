"""The estimator `gwnn` and its rivals on the same tracks: errors and their ratios, cell by cell.

Errors are those of the expectation one scan ahead, RMS per axis; positions in the plots'
deviations sigma. A cell is one kind of motion in one phase, under one set of radar conditions.
"""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...estimators import cs_kalman, imm
from ...estimators.contract import Estimator
from ...estimators.gwnn import bank, gwnn, monitor
from ...estimators.imm import Modes
from ...geometry import unit_vector
from ...networks import gwnn_weights
from ...training import ship_tracks, track_trials
from ...training.track_trials import Ratio
from ...training.training_tracks import WATERS
from ...training.tuned import TUNED
from ...types import take
from . import held_out_tracks

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
# The network; the network with plain units; with its monitor switched off; the reference of all
# ratios.
OWN, TANH, ALONE, IMM = 'GWNN', 'tanh units', 'never falling back', 'IMM'


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


# Result of a short search: 75 evaluations on ships. Compared with the strongest IMM it shows how
# much the tuning is worth.
BRIEFLY = 'IMM tuned in brief'
IN_BRIEF = Modes(
    tuple(bank.PERIOD * a * a for a in (0.0010256, 0.79201, 0.014074, 0.014074)),
    (0, 0, 0.020922, -0.020922),
    (0.99797, 0.78744, 0.78744, 0.78744),
    bank.PERIOD,
)


def kinds(vessel_class: str) -> tuple[str, ...]:
    """All kinds of motion that a vessel class is judged on."""
    return *WATERS[vessel_class].kinds, *FLEETS[vessel_class].held_out


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
    if kind in HELD_OUT:
        ships = HELD_OUT[kind](_file(data, kind), steps, rng)
        if kind in RECORDED:  # recorded tracks may lie anywhere: move them to where the others are
            away = ranges[:, None] * unit_vector(rng.uniform(0, 2 * np.pi, 2 * runs))
            ships = ships._replace(
                position=ships.position + (away - ships.position[:, SCANS // 2])[:, None]
            )
    else:
        ships = ship_tracks.sail(
            [kind] * 2 * runs, ranges, steps, rng, kinds=WATERS[vessel_class].kinds
        )
    nearest = np.hypot(*np.moveaxis(ships.position, -1, 0)).min(1)
    ships = take(ships, np.flatnonzero(nearest > fleet.nearest)[:runs])
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
    )


def _file(data, kind) -> Path | None:
    file = RECORDED.get(kind)
    if file is None:
        return None
    if data is None:
        raise ValueError(f'{file} needs --data')
    return data / file


def rivals(vessel_class: str) -> dict[str, Estimator]:
    """The filters to compare the network with. The IMM is tuned on the tracks of the network's
    training.
    """
    best, tuned = bank.STRONGEST[vessel_class], TUNED[vessel_class]
    brief = {BRIEFLY: imm.imm(IN_BRIEF, SPEED)} if vessel_class == 'ship' else {}
    return {
        IMM: imm.imm(best['training'], SPEED),
        **brief,
        'IMM for manoeuvre': imm.imm(best['manoeuvre'], SPEED),
        'IMM as shipped': imm.imm(imm.PRESETS[vessel_class], SPEED),
        'CV/CV': imm.imm(tuned.cv_cv, SPEED),
        'CV': imm.imm(tuned.cv, SPEED),
        'CS': cs_kalman.cs_kalman(tuned.cs, SPEED),
        'CS of the fallback': fallback(vessel_class),
    }


def fallback(vessel_class: str) -> Estimator:
    """What `gwnn` falls back to."""
    return cs_kalman.cs_kalman(bank.SETTINGS[vessel_class].manoeuvre, SPEED)


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
    nis       mean NIS of the network
    idle      share of the scans in fallback
    """

    vessel_class: str
    kind: str
    phase: str
    rms: dict[str, float]
    position: dict[str, Ratio]
    velocity: dict[str, Ratio]
    over: dict[str, Ratio]
    nis: float
    idle: float


def cells(
    vessel_class: str,
    kind: str,
    runs: int,
    radar: Conditions,
    seed: int,
    data: Path | None,
    weights: dict[str, gwnn_weights.Weights],
) -> list[Cell]:
    """Both phases of one kind of motion.

    weights  of the network, OWN, and of other networks to compare with it
    """
    rng = np.random.default_rng(seed)
    on = trial(vessel_class, kind, runs, radar, rng, data)
    period = 60 / radar.rpm
    fallen = np.zeros(on.seen.shape, bool)

    def watch(k, state):
        fallen[:, k] = state.monitor.status == monitor.FALLBACK

    outcomes = {
        OWN: track_trials.run(network(vessel_class, weights[OWN], period), on, False, watch)
    }
    outcomes[ALONE] = track_trials.run(
        network(vessel_class, weights[OWN], period, trust=monitor.Trust(fall=np.inf)),
        on,
        gated=False,
    )
    for name in weights:
        if name != OWN:
            outcomes[name] = track_trials.run(
                network(vessel_class, weights[name], period), on, gated=False
            )
    outcomes |= {
        name: track_trials.run(rival, on, gated=True)
        for name, rival in rivals(vessel_class).items()
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
                float(outcomes[OWN].nis[chosen & on.seen].mean()),
                float(fallen[chosen].mean()),
            )
        )
    return found
