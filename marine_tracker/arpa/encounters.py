"""A danger that was acknowledged: has the encounter ended, or has it become worse since then?

It has clearly ended when, for alerts.Rule.forget_after, one of these holds:

    the target is farther away than ENDED times the CPA limit, and its closest approach is past;
    CPA or TCPA are ENDED times beyond their limit, with a probability of danger below REMOTE;
    own ship is at anchor and the target does not come nearer.

It has become worse when, for alerts.Rule.worse_after, it is a danger and one of these holds:

    the CPA is below the acknowledged one by NEARER of the CPA limit, or the closest approach comes
    sooner than the acknowledged one by SOONER of the TCPA limit; a value is used only if SURELY
    times its deviation is at most that much, because otherwise it is a guess;
    the target was no longer a danger and comes back, while it is still nearer than ENDED times the
    CPA limit: to less than BACK of the distance.

Between the two the operator knows of the danger already.
"""

import numpy as np
from numpy.typing import NDArray

from ..types import Array, row_of
from .alerts import CLEAR, NORMAL, OFF, ON, WORSE, Alerts
from .situation import DANGEROUS, SAFE, Limits, Situation

ENDED, REMOTE = 1.5, 0.1
NEARER, SOONER, SURELY, BACK = 0.5, 0.25, 2.0, 0.5


def marked(
    alerts: Alerts, dangers: NDArray[np.bool_], situation: Situation, limits: Limits, now: float
) -> Alerts:
    """The alerts. Acknowledged dangers [A] without a mark get the marks of a worse danger.

    The marks are a CPA, m, and a time of the closest approach, s; each is nan while it is a guess.
    """
    row = row_of(situation.id, alerts.id)
    new = dangers & ~np.isnan(alerts.until) & (row >= 0)
    new &= np.append(situation.danger, SAFE)[row] == DANGEROUS
    known = _known(situation, limits, now)
    known[:, 0] = np.minimum(known[:, 0], limits.cpa)  # likely below it, or it were no danger
    worse = known - _clearly(limits)
    worse = np.append(worse, [[np.nan, np.nan]], 0)[row]  # -1, gone away: the last
    mark = np.where(new[:, None] & np.isnan(alerts.mark), worse, alerts.mark)
    return alerts._replace(mark=mark)


def _clearly(limits: Limits) -> Array:
    """[2] m, s: by how much CPA and TCPA must differ."""
    return np.array([NEARER * limits.cpa, SOONER * limits.tcpa])


def _known(situation: Situation, limits: Limits, now: float) -> Array:
    """[N, 2] CPA, m, and the time of it, s; nan where it is a guess."""
    sure = SURELY * np.stack([situation.cpa_sigma, situation.tcpa_sigma], 1) <= _clearly(limits)
    return np.where(sure, np.stack([situation.cpa, now + situation.tcpa], 1), np.nan)


def level(
    danger: NDArray[np.int8],
    alerts: Alerts,
    dangers: NDArray[np.bool_],
    situation: Situation,
    limits: Limits,
    now: float,
) -> NDArray[np.int8]:
    """Levels [N] of danger as alerts.Causes has them, of `danger` [N], OFF to ON.

    Those of the tracks whose danger was acknowledged, rows `dangers` [A] of the alerts, may be
    CLEAR and WORSE.
    """
    known = dangers & ~np.isnan(alerts.until)
    row = row_of(situation.id, alerts.id[known])
    there, row = row >= 0, row[row >= 0]
    mark, acknowledged, over = np.full((len(danger), 2), np.nan), *np.zeros((2, len(danger)), bool)
    mark[row] = alerts.mark[known][there]
    acknowledged[row] = True
    over[row] = alerts.state[known][there] == NORMAL
    near = situation.range < ENDED * limits.cpa
    within = (
        (situation.cpa < ENDED * limits.cpa)
        & (situation.tcpa >= 0)
        & (situation.tcpa < ENDED * limits.tcpa)
    ) | (situation.probability >= REMOTE)
    clear = (situation.danger == SAFE) & (situation.harmless | ~(near | within))
    worse = (_known(situation, limits, now) < mark).any(1) | (
        over & near & (situation.cpa < BACK * situation.range)
    )
    return np.select(
        [acknowledged & (danger == OFF) & clear, acknowledged & (danger == ON) & worse],
        [CLEAR, WORSE],
        danger,
    ).astype(np.int8)
