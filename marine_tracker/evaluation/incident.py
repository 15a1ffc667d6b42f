"""An incident in a recording: what the picture was, and which manoeuvre would have cleared it.

The recording goes through the service again. A manoeuvre is judged twice: by what was known when it
would have begun (the trial manoeuvre of the ARPA, its limits and its risk), and by how the targets
then really moved.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from ..arpa.alarm_text import text
from ..arpa.alerts import Raised
from ..arpa.arpa import Picture
from ..arpa.own_path import TrialManoeuvre, paths
from ..arpa.targets import label
from ..arpa.trial_manoeuvre import safe_courses, trial_approach
from ..geometry import to_range_bearing, wrap_angle
from ..service import Output, Service
from ..types import Array, IntArray, Scan

LEADS_MIN = (15, 12, 10, 8, 6, 5, 4, 3, 2, 1)
SPEEDS = (0.75, 0.5, 0.25, 0.0)  # of own ship's, highest first
RISK = 0.05
STARBOARD, PORT, SLOWER = 'starboard', 'port', 'slower'


class Remedy(NamedTuple):
    """A manoeuvre that would have kept all targets outside the CPA limit, with a risk below 5 %.

    before   s before the incident
    kind     STARBOARD, PORT or SLOWER
    change   rad of course, for SLOWER m/s
    course   rad        speed  m/s, after the manoeuvre
    nearest  m, of all targets, by what was known then
    really   m, of all targets, as they then moved, until the recording ends
    way      [W, 2] m, own ship's way with it
    """

    before: float
    kind: str
    change: float
    course: float
    speed: float
    nearest: float
    really: float
    way: Array


class Incident(NamedTuple):
    """What happened.

    time      s, of the last scan up to the moment asked for
    output    of that scan
    subject   row of its target that was most in danger; -1 without targets
    alarms    (s, text) of those raised in the minutes before
    remedies  the latest first
    pictures  of all scans from the minutes before on
    """

    time: float
    output: Output
    subject: int
    alarms: tuple[tuple[float, str], ...]
    remedies: tuple[Remedy, ...]
    pictures: tuple[Picture, ...]


def find(
    service: Service, scans: Iterable[Scan], at: float, before: float, after: float
) -> Incident:
    """The incident at `at` s, with what was up to `before` s earlier, and `after` s later.

    ValueError if the recording has no scan until then.
    """
    memory = service.start()
    pictures: list[Picture] = []
    alarms: list[tuple[float, str]] = []
    raised = Raised()
    found: Output | None = None
    for scan in scans:
        if scan.end > at + after:
            break
        memory, output = service.step(memory, scan)
        picture = output.picture
        if scan.end < at - before:
            raised.rows(picture.changed)
            continue
        pictures.append(picture)
        if scan.end <= at:
            found = output
            radars = [radar.name for radar in service.arpa.radars]
            told = text(picture.changed, service.arpa.zones, radars)
            alarms += [(picture.time, told[row]) for row in raised.rows(picture.changed)]
    if found is None:
        raise ValueError(f'no scan ends between {at - before:.1f} and {at:.1f} s')
    now = found.picture
    remedies = _remedies(service, pictures, now.time)
    return Incident(now.time, found, _subject(now), tuple(alarms), tuple(remedies), tuple(pictures))


def _subject(picture: Picture) -> int:
    """The row of the target most in danger: by probability, then by range."""
    if not len(picture.targets.id):
        return -1
    order = np.lexsort((picture.approach.range, -picture.approach.danger_probability))
    return int(order[0])


def _remedies(service: Service, pictures: list[Picture], at: float) -> list[Remedy]:
    found: list[Remedy] = []
    for lead in reversed(LEADS_MIN):
        began = at - 60.0 * lead
        earlier = [k for k, one in enumerate(pictures) if one.time <= began]
        if not earlier:
            continue
        k = earlier[-1]
        if len(pictures[k].targets.id) and pictures[k].own.velocity.any():
            found += _at(service, pictures[k], pictures[k:], at - pictures[k].time)
    return found


def _at(service: Service, then: Picture, later: list[Picture], before: float) -> list[Remedy]:
    """The least change to either side, and the least loss of speed, that would do."""
    arpa, own = service.arpa, then.own
    p, limits = arpa.parameters, arpa.limits
    speed, course = (float(value) for value in to_range_bearing(own.velocity))
    turn = np.radians(p.trial_turn_rate_deg_min) / 60

    def trial(to_course: float, to_speed: float) -> TrialManoeuvre:
        return TrialManoeuvre(to_course, to_speed, 0.0, turn, p.trial_acceleration_mps2)

    found = []
    safe = safe_courses(then.motion, own, trial(course, speed), limits.cpa, risk=RISK)
    turned = wrap_angle(safe.course - course)
    for kind, side in ((STARBOARD, turned > 0), (PORT, turned < 0)):
        rows = np.flatnonzero(safe.safe & side)
        if len(rows):
            row = rows[np.abs(turned[rows]).argmin()]
            new = trial(float(safe.course[row]), speed)
            found.append((kind, abs(float(turned[row])), new, float(safe.cpa[row])))
    for share in SPEEDS:
        new = trial(course, share * speed)
        passing = trial_approach(then.motion, own, new, limits.cpa, np.inf)
        if 1 - np.prod(1 - passing.danger_probability) < RISK:
            ahead = np.where(passing.tcpa > 0, passing.cpa, then.approach.range)
            nearest = float(np.nanmin(ahead, initial=np.inf))
            found.append((SLOWER, (1 - share) * speed, new, nearest))
            break
    remedies = []
    for kind, change, new, nearest in found:
        way, really = _really(then, later, new)
        remedies.append(Remedy(before, kind, change, new.course, new.speed, nearest, really, way))
    return remedies


def _really(then: Picture, later: list[Picture], trial: TrialManoeuvre) -> tuple[Array, float]:
    """Own ship's way [W, 2] m with the manoeuvre, a row a scan; and how near any of the targets
    of then would have come, as they moved."""
    path = paths(then.own, trial, np.array([trial.course]))
    times, places = path.time[0], path.position[0]
    way, nearest = [], np.inf
    for picture in later:
        since = picture.time - then.time
        place = np.array([np.interp(since, times, column) for column in places.T])
        place = place + max(since - times[-1], 0.0) * path.velocity[0]
        way.append(place)
        known = np.isin(picture.targets.id, then.targets.id)
        away = np.hypot(*(picture.motion.position[known] - place).T)
        nearest = min(nearest, float(away.min(initial=np.inf)))
    return np.array(way), nearest


def names(picture: Picture, numbers: IntArray) -> list[str]:
    """TT07, ... of the picture's targets; numbers [N] of the tracker's report."""
    return label(picture.targets.id, numbers[picture.row])
