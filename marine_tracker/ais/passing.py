"""How ships of AIS pass own ship: for those that are not joined as for radar targets."""

from typing import NamedTuple

import numpy as np

from ..arpa import situation
from ..arpa.arpa import Arpa
from ..arpa.cpa import LEAST_SPEED, Approach, OwnMotion, approach, cpa_of
from ..arpa.motion import STEADY, Motion
from ..arpa.situation import DANGEROUS, NEARLY, Situation
from ..arpa.stabilisation import OwnSensors
from ..arpa.zones import inside
from ..geometry import to_range_bearing
from ..tracking.lifecycle import CONFIRMED
from ..types import Array, BoolArray, CodeArray, OwnShip
from .join import AIS_ONLY, Joined
from .ship_motion import Moving
from .ship_table import Ships

LIKELY = 2.0  # times the limits; beyond them CPA and TCPA have no deviations


class Passing(NamedTuple):
    """S rows.

    approach  nan for what is not known
    danger    [S]  one of situation.SAFE, NEARLY, DANGEROUS; SAFE for those that are joined
    guarded   [S]  in a guard zone
    seen      the same as the alarms take it
    """

    approach: Approach
    danger: CodeArray
    guarded: BoolArray
    seen: Situation


def look(
    arpa: Arpa,
    ships: Ships,
    moving: Moving,
    joined: Joined,
    own: OwnMotion,
    samples: OwnShip,
    drift: Array,
    sensors: OwnSensors,
    now: float,
) -> Passing:
    """The ships at the time now, s; arguments as of Ais.step."""
    count, limits = len(ships.id), arpa.limits
    motion = motion_of(moving, drift)
    own, no_danger = arpa.anchored(samples, motion, own, now, sensors)
    passes = _rough(motion, moving.told, own)
    alone = (joined.state == AIS_ONLY) & ships.placed & ~ships.lost & moving.told
    near = alone & (passes.cpa < LIKELY * limits.cpa) & (passes.tcpa > -limits.tcpa)
    near &= passes.tcpa < LIKELY * limits.tcpa
    rows = (near | (alone & (passes.range < LIKELY * limits.cpa))).nonzero()[0]
    fine = approach(Motion(*(column[rows] for column in motion)), own, limits.cpa, limits.tcpa)
    for whole, part in zip(passes, fine):
        whole[rows] = part
    danger = np.where(alone, situation.danger(passes, no_danger, limits), situation.SAFE)
    mask = inside(arpa.zones, moving.position, own.position, own.heading)
    excluded = np.any(mask & ~arpa.zones.guard, axis=1)
    guarded = np.any(mask & arpa.zones.guard, axis=1) & ~excluded
    seen = Situation(
        -ships.id,
        ships.mmsi,
        np.full(count, CONFIRMED, np.int8),
        np.zeros(count, np.int8),
        moving.position,
        passes.range,
        passes.bearing if own.north else np.full(count, np.nan),
        passes.cpa,
        passes.tcpa,
        passes.danger_probability,
        situation.nearest(passes, limits.tcpa),
        danger.astype(np.int8),
        mask,
        guarded,
        excluded,
        no_danger,
        passes.cpa_sigma,
        passes.tcpa_sigma,
    )
    return Passing(passes, danger.astype(np.int8), guarded, seen)


def motion_of(moving: Moving, drift: Array) -> Motion:
    """Their motion as that of radar targets; drift [2] m/s, what is subtracted from all."""
    count = len(moving.told)
    return Motion(
        moving.position,
        moving.velocity - drift,
        moving.covariance,
        np.full(count, STEADY),
        np.full(count, np.nan),
        moving.told,
        np.zeros(count, bool),
    )


def _rough(motion: Motion, told: BoolArray, own: OwnMotion) -> Approach:
    """The approach without deviations and bow crossing; nan where place or motion is not told."""
    position, velocity = motion.position - own.position, motion.velocity - own.velocity
    values = {name: np.full(len(position), np.nan) for name in Approach._fields}
    values['range'], values['bearing'] = to_range_bearing(position)
    speed, course = to_range_bearing(motion.velocity)
    values['speed'] = np.where(told, speed, np.nan)
    values['course'] = np.where(told & (speed > 0), course, np.nan)
    relative, way = to_range_bearing(velocity)
    values['relative_speed'] = np.where(told, relative, np.nan)
    values['relative_course'] = np.where(told, way, np.nan)
    cpa, tcpa = cpa_of(position, velocity)
    values['cpa'] = np.where(told, cpa, np.nan)
    values['tcpa'] = np.where(told & (relative >= LEAST_SPEED), tcpa, np.nan)
    values['danger_probability'] = np.zeros(len(position))
    return Approach(**values)


__all__ = ['DANGEROUS', 'NEARLY', 'Passing', 'look', 'motion_of']
