"""What happens to tracks when the network fails, in the middle of a run or from the start.

Also measures what the estimator costs.
"""

import time

import numpy as np

from ...estimators.gwnn import gwnn, monitor
from ...networks.gwnn_weights import Weights
from ...training import track_trials
from ...types import Array
from .trials import FLEETS, SCANS, fallback, network, trial

BREAK_SCAN, BREAK_SIZE = 40, 3.0  # scan; sigma, offset of the network's position
LATER = 6  # scans left out after the break
COST_TRACKS, COST_SCANS = 1000, 30


def broken(weights: Weights, shift: Array) -> Weights:
    """Weights whose positions are wrong by shift [2] sigma."""
    bias = weights.fusion.bias.copy()
    bias[gwnn.AT_ONCE] += shift
    return weights._replace(fusion=weights.fusion._replace(bias=bias))


def scans_to_fallback(
    vessel_class: str, kind: str, runs: int, seed: int, weights: Weights
) -> tuple[Array, track_trials.Ratio]:
    """Scans [B] from a sudden break of the network to the fallback, and the error afterwards.

    The error is the RMS relative to that of CS-Kalman, over all scans from the sixth after the
    break on.
    """
    rng = np.random.default_rng(seed)
    radar = FLEETS[vessel_class].radar
    on = trial(vessel_class, kind, runs, radar, rng, None)
    angle = rng.uniform(0, 2 * np.pi)
    shift = BREAK_SIZE * np.array([np.cos(angle), np.sin(angle)])
    sound, bad = (
        network(vessel_class, one, 60 / radar.rpm) for one in (weights, broken(weights, shift))
    )
    first = np.full(len(on.seen), float(SCANS))  # number of plots until the fallback

    def watch(k, state):
        if k < BREAK_SCAN:
            return None
        down = (state.monitor.status == monitor.FALLBACK) & (first == SCANS)
        first[down] = k - BREAK_SCAN - 1  # scan BREAK_SCAN + 2 is the first expected so
        return bad

    own = track_trials.run(sound, on, False, watch)
    return first, _over_cs(own, vessel_class, on, rng)


def _over_cs(own, vessel_class, on, rng) -> track_trials.Ratio:
    cs = track_trials.run(fallback(vessel_class), on, True)
    chosen = on.counts.copy()
    chosen[:, : BREAK_SCAN + LATER] = False
    return track_trials.ratio(own.position, cs.position, chosen, rng)


def rubbish(
    vessel_class: str, runs: int, seed: int, weights: Weights
) -> list[track_trials.Ratio | None]:
    """Position ratio to CS-Kalman with random weights, and with weights that are not numbers.

    None if any result is not a number.
    """
    rng = np.random.default_rng(seed)
    radar, usual = FLEETS[vessel_class].radar, FLEETS[vessel_class].usual
    on = trial(vessel_class, usual, runs, radar, rng, None)
    inner = weights.fusion.inner
    found = []
    for values in (rng.normal(0, 10 * inner.std(), inner.shape), np.full_like(inner, np.nan)):
        outer = rng.normal(0, 5.0, weights.fusion.outer.shape)
        bad = weights._replace(fusion=weights.fusion._replace(inner=values, outer=outer))
        with np.errstate(invalid='ignore'):
            own = track_trials.run(network(vessel_class, bad, 60 / radar.rpm), on, False)
        finite = np.isfinite(own.position).all() and np.isfinite(own.velocity).all()
        found.append(_over_cs(own, vessel_class, on, rng) if finite else None)
    return found


def cost(seed: int, weights: Weights) -> float:
    """CPU ms of extrapolation and update of 1,000 tracks of ships, the median scan."""
    radar = FLEETS['ship'].radar
    on = trial('ship', 'mix', COST_TRACKS, radar, np.random.default_rng(seed), None)
    estimator, rows = network('ship', weights, 60 / radar.rpm), np.arange(len(on.seen))
    state, spent = estimator.init(on.plots[0]), []
    for k in range(1, COST_SCANS):
        begin = time.process_time()
        estimator.extrapolate(state, on.plots[k].time)
        state = estimator.update(state, on.plots[k], rows)
        spent.append(time.process_time() - begin)
    return 1e3 * float(np.median(spent[monitor.WARM :]))
