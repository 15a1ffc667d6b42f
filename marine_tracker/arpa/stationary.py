"""Places where plots always are, as the navigator sees them: objects that are stationary.

They are no targets, so each has no alarm of its own: a quay would ring all the time. But what own
ship heads for is told: one warning for all of them that are dangerous.
"""

from typing import NamedTuple

import numpy as np

from ..tracking.at_rest import Shown
from ..types import Array, CodeArray
from . import situation
from .cpa import Approach, OwnMotion, approach
from .motion import STEADY, Motion
from .situation import DANGEROUS, SAFE, Limits


class Stationary(NamedTuple):
    """S objects, in the order of their numbers.

    shown     the places
    approach  S rows: range, bearing, CPA and TCPA as of a target at rest
    danger    [S]  one of situation.SAFE, NEARLY, DANGEROUS
    """

    shown: Shown
    approach: Approach
    danger: CodeArray

    @property
    def way(self) -> tuple[tuple[float, ...], bool]:
        """Of the dangerous objects: their number, and of the one that is reached first range m,
        bearing rad, CPA m and TCPA s; nan where there is none. And whether any is nearly so."""
        rows = (self.danger == DANGEROUS).nonzero()[0]
        nearly = bool((self.danger > SAFE).any())
        if not len(rows):
            return (0.0, np.nan, np.nan, np.nan, np.nan), nearly
        tcpa: Array = np.nan_to_num(self.approach.tcpa[rows], nan=np.inf)
        first = rows[tcpa.argmin()]
        passing = self.approach
        values = (passing.range, passing.bearing, passing.cpa, passing.tcpa)
        return (float(len(rows)), *(float(value[first]) for value in values)), nearly


def look(shown: Shown, own: OwnMotion, limits: Limits, now: float) -> Stationary:
    """The objects as own ship, over ground, meets them; now s."""
    count = len(shown.number)
    covariance = np.zeros((count, 4, 4))
    covariance[:, [0, 1], [0, 1]] = shown.variance[:, None]
    motion = Motion(
        shown.position,
        np.zeros((count, 2)),
        covariance,
        np.full(count, STEADY),
        np.full(count, now),
        np.ones(count, bool),
        np.ones(count, bool),
    )
    passing = approach(motion, own, limits.cpa, limits.tcpa)
    return Stationary(shown, passing, situation.danger(passing, np.zeros(count, bool), limits))
