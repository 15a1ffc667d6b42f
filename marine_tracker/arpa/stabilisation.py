"""What courses and speeds are measured against: the ground, the water, or nothing that is known.

ground  from own ship's positions; or from a target that the operator knows to be stationary
sea     from her speed through the water, by a log or set by hand, along her heading; or from a
        current that is set by hand
none    her own way is not known, or not in which direction: courses and speeds are not told.
        What is relative (range, CPA, TCPA) is still right
"""

from typing import NamedTuple

import numpy as np

from ..geometry import KNOT, on_deck, unit_vector
from ..parameters import ArpaParameters
from ..types import Array
from .cpa import OwnMotion

GROUND, SEA, NONE = 'ground', 'sea', 'none'  # Stabilisation.reference
POSITIONS, CURRENT, LOG, HAND = 'positions', 'current by hand', 'log', 'speed by hand'
NO_HEADING, NO_SPEED = 'no heading', 'no speed'  # Stabilisation.by where the reference is NONE


class OwnSensors(NamedTuple):
    """What own ship's sensors tell beside her positions.

    north  whether the heading is known; else it is the last one, and tells only what is relative to
           the bow
    log    [2] m/s through the water, ahead and to starboard; nan where the log does not tell
    way    what moves own ship: POSITIONS; LOG or HAND where those are lost; NONE where nothing is
           known of her way any more
    """

    north: bool = True
    log: tuple[float, float] = (np.nan, np.nan)
    way: str = POSITIONS


ALL_WELL = OwnSensors()


class Stabilisation(NamedTuple):
    """What is in force.

    reference  GROUND, SEA or NONE
    by         what it is known by, or is lacking
    drift      [2] m/s: subtracted from all motion in the frame `map`
    target     number of the stationary target that the ground is known by; 0: none
    """

    reference: str
    by: str
    drift: Array
    target: int = 0


def through_water(p: ArpaParameters, log: tuple[float, float], heading: float) -> tuple[Array, str]:
    """Own ship's velocity [2] m/s through the water along the heading, and LOG or HAND; nan and ''
    where neither tells her speed, or the heading is nan.

    log  [2] m/s, ahead and to starboard; nan where it does not tell
    """
    by = LOG if p.stabilisation != 'hand' and np.isfinite(log).all() else HAND
    speed = log if by == LOG else (p.water_speed_kn * KNOT, 0.0)
    if np.isnan(heading) or (by == HAND and p.water_speed_kn < 0):
        return np.full(2, np.nan), ''
    return on_deck(speed[0], speed[1], heading), by


def stabilisation(
    p: ArpaParameters, own: OwnMotion, sensors: OwnSensors, stationary: Array
) -> Stabilisation:
    """What is in force, for own ship's motion in `map`.

    stationary  [2] m/s, velocity in `map` of the stationary target that was chosen; nan for none
    """
    still = np.zeros(2)
    if np.isfinite(stationary).all():
        number = p.reference_target
        return Stabilisation(GROUND, f'target TT{number:02d}', stationary, number)
    if sensors.way == NONE:
        return Stabilisation(NONE, NO_SPEED, still)
    if sensors.way != POSITIONS:
        return Stabilisation(SEA, sensors.way, still)
    if p.stabilisation != 'current':
        water, by = through_water(p, sensors.log, own.heading)
        if by:
            return Stabilisation(SEA, by, own.velocity - water)
    if not sensors.north:
        return Stabilisation(NONE, NO_HEADING, still)
    if p.stabilisation == 'current' and p.current_drift_kn:
        set_ = np.radians(p.current_set_deg)
        return Stabilisation(SEA, CURRENT, p.current_drift_kn * KNOT * unit_vector(set_))
    return Stabilisation(GROUND, POSITIONS, still)
