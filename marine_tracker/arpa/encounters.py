"""A danger that was acknowledged: has the encounter ended, or become worse than what was seen?

It has clearly ended once, for alerts.Rule.forget_after, the closest approach is past, or CPA or
TCPA are ENDED times beyond their limit with a probability of danger below REMOTE, or own ship lies
at anchor and the target does not come nearer.

It has clearly become worse when for alerts.Rule.worse_after it is a danger and the CPA is below
what was acknowledged by NEARER of the CPA limit, or the closest approach comes sooner than was
acknowledged by SOONER of the TCPA limit; in both by SURELY of their deviations then, too, for what
was a guess when it was acknowledged may come out as anything. Between the two the operator knows of
it already.
"""

import numpy as np
from numpy.typing import NDArray

from ..types import row_of
from .alerts import CLEAR, OFF, ON, WORSE, Alerts
from .situation import SAFE, Limits, Situation

ENDED, REMOTE = 1.5, 0.1
NEARER, SOONER, SURELY = 0.5, 0.25, 2.0


def marked(
    alerts: Alerts, dangers: NDArray[np.bool_], situation: Situation, limits: Limits, now: float
) -> Alerts:
    """The alerts; the dangers [A] acknowledged since the last scan marked with what were worse.

    That is a CPA, m, and a time of the closest approach, s.
    """
    row = row_of(situation.id, alerts.id)
    new = dangers & ~np.isnan(alerts.until) & np.isnan(alerts.mark[:, 0]) & (row >= 0)
    nearer = np.maximum(NEARER * limits.cpa, SURELY * situation.cpa_sigma)
    sooner = np.maximum(SOONER * limits.tcpa, SURELY * situation.tcpa_sigma)
    mark = alerts.mark.copy()
    mark[new] = np.stack([situation.cpa - nearer, now + situation.tcpa - sooner], 1)[row[new]]
    return alerts._replace(mark=mark)


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
    mark = np.full((len(danger), 2), np.nan)
    known = dangers & ~np.isnan(alerts.until)
    row = row_of(situation.id, alerts.id[known])
    mark[row[row >= 0]] = alerts.mark[known][row >= 0]
    acknowledged = np.zeros(len(danger), bool)
    acknowledged[row[row >= 0]] = True
    within: NDArray[np.bool_] = (
        (situation.cpa < ENDED * limits.cpa)
        & (situation.tcpa >= 0)
        & (situation.tcpa < ENDED * limits.tcpa)
    ) | (situation.probability >= REMOTE)
    clear = (situation.danger == SAFE) & (~within | situation.harmless)
    worse = (situation.cpa < mark[:, 0]) | (now + situation.tcpa < mark[:, 1])
    return np.select(
        [acknowledged & (danger == OFF) & clear, acknowledged & (danger == ON) & worse],
        [CLEAR, WORSE],
        danger,
    ).astype(np.int8)
