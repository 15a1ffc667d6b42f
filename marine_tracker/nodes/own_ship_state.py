"""What is known of own ship and by what, in words: on /diagnostics and on `own_ship/state`."""

import math

import numpy as np

from ..arpa.arpa import Picture
from ..arpa.stabilisation import LOG, NO_HEADING, NO_SPEED, NONE, POSITIONS, SEA
from ..geometry import KNOT, to_range_bearing
from ..parameters import ArpaParameters
from ..tracking import own_ship
from .own_sensors import SensorsInput
from .targets_message import degrees, figure

PLACED = {
    own_ship.OWN_NEVER_HEARD: 'never heard: the origin',
    own_ship.OWN_SILENT: 'last known',
    own_ship.OWN_RECKONED: 'reckoned',
}


def sources(
    picture: Picture | None,
    sensors: SensorsInput,
    velocity: str,
    fallback: str,
    p: ArpaParameters,
    offsets: bool,
) -> tuple[list[str], dict[str, str]]:
    """What is to worry about, and the values, as they were in the last scan.

    sensors   own ship's, as heard
    velocity  what tells the velocity, where the positions are heard
    fallback  of own ship's place in the scan (own_ship.own_ship_for)
    offsets   whether the parameters give offsets of antennas
    """
    if picture is None:
        return [], {}
    own, against, heard = picture.own, picture.stabilised, sensors.heading
    values = {
        'position from': PLACED.get(fallback, 'odometry'),
        'velocity from': velocity,
        'heading from': 'odometry' if own.north else 'last known',
    }
    worries = []
    if math.isnan(heard):
        values['heading from'] = 'never heard'
    if fallback == own_ship.OWN_RECKONED:
        values['velocity from'] = 'last known' if against.by == NO_SPEED else against.by
    elif fallback in (own_ship.OWN_SILENT, own_ship.OWN_NO_VELOCITY):
        values['velocity from'] = 'not known'
    if not own.north:
        last = 'none was heard' if math.isnan(heard) else f'the last was {degrees_of(heard)} deg'
        worries.append(f'{NO_HEADING}: relative bearings only; {last}')
    elif math.isnan(heard) and offsets:
        worries.append('no heading: the offsets of the antennas are not applied')
    if against.reference == NONE:
        worries.append(f'{against.by}: courses and speeds are not told')
    if p.reference_target and against.target != p.reference_target:
        worries.append(f'target {p.reference_target} is not tracked: it is no reference')
    elif p.stabilisation != 'current' and against.by == POSITIONS:
        worries.append(f'no speed through the water from {p.stabilisation}: over ground instead')
    elif p.stabilisation == LOG and against.reference == SEA and against.by != LOG:
        worries.append('the log is silent: speed by hand')
    speed, course = to_range_bearing(own.velocity)
    known = against.reference != NONE
    drift, set_ = to_range_bearing(against.drift)
    drifts = against.reference == SEA and fallback not in PLACED
    return worries, {
        **values,
        'heading_deg': degrees_of(own.heading) if own.north else '',
        'last_heading_deg': degrees_of(heard),
        'course_deg': degrees_of(float(course)) if known and own.north and speed > 0 else '',
        'speed_kn': figure(float(speed) / KNOT, 2) if known else '',
        'water_speed_kn': figure(float(np.hypot(*sensors.way(p)[0])) / KNOT, 2),
        'stabilised': against.reference,
        'stabilised by': against.by,
        'set_deg': degrees_of(float(set_)) if drifts and own.north and drift > 0 else '',
        'drift_kn': figure(float(drift) / KNOT, 2) if drifts else '',
    }


def degrees_of(angle: float) -> str:
    """000.0 to 359.9 of rad; '' of nan."""
    return degrees(float(np.degrees(angle)))
