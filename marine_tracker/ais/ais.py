"""Ships of AIS beside the radar targets: all steps on one page.

hear   reports come in                                            ships.py
step   once a revolution, or by the clock where radar is silent:
       ships in time, joined to tracks, how they pass own ship,
       which are activated, alarms
"""

from typing import NamedTuple

import numpy as np

from .. import m1371
from ..arpa.alerts import Alerts
from ..arpa.arpa import Arpa
from ..arpa.cpa import Approach, OwnMotion
from ..arpa.stabilisation import OwnSensors
from ..geometry import NAUTICAL_MILE
from ..parameters import AisParameters
from ..types import Array, BoolArray, CodeArray, IntArray, OwnShip, among
from . import ais_alarms, join, pairs, passing, registration, ships
from .join import Joined, Seen
from .pairs import Pairs
from .registration import Registration
from .reports import Reports
from .ship_motion import Moving, at
from .ship_table import Ships, none

ACTIVATED, SLEEPING, LEFT_OUT = range(3)
SHOWN = ('activated', 'sleeping', 'left out')
MOST_STEP = 30.0  # s; evidence of a longer silence counts as of so much


class AisMemory(NamedTuple):
    """What is remembered between two steps.

    ships         S rows
    pairs         ships and tracks that may be the same
    registration  how far radar and AIS stand off each other as a whole
    next_id       of a new ship
    time          s, of the last scan; nan: none yet
    awake, asleep  ids of ships that the operator activated, or put to sleep
    active        ids of those that were activated; a lost one stays so
    trusted       [K, 2]  ids of ships that agree with their tracks, and of these
    """

    ships: Ships
    pairs: Pairs
    registration: Registration
    next_id: int
    time: float
    awake: IntArray
    asleep: IntArray
    active: IntArray
    trusted: IntArray


class AisPicture(NamedTuple):
    """The S ships at a time.

    time      s
    ships, moving, joined  S rows
    approach  S rows, of those that are not joined; nan for what is not known
    danger    [S]  one of situation.SAFE, NEARLY, DANGEROUS
    shown     [S]  ACTIVATED, SLEEPING or LEFT_OUT
    registration  radar less AIS
    """

    time: float
    ships: Ships
    moving: Moving
    joined: Joined
    approach: Approach
    danger: CodeArray
    shown: CodeArray
    registration: Registration


class Ais:
    """The pure core: it takes parameters and has no state. Limits and zones are of the ARPA."""

    def __init__(self, parameters: AisParameters, arpa: Arpa) -> None:
        self.parameters, self.arpa = parameters, arpa
        self.rules = set(parameters.ais_activation.split())
        self.kinds = [m1371.WORDS.index(word) for word in parameters.ais_kinds.split()]

    def start(self) -> AisMemory:
        """No ships yet."""
        ids = np.zeros(0, np.int64)
        return AisMemory(
            *(none(), pairs.nothing(), registration.begin(), 1, np.nan, ids, ids, ids),
            ids.reshape(0, 2),
        )

    def hear(self, memory: AisMemory, reports: Reports, position: Array) -> AisMemory:
        """The memory with reports, whose places are at `position` [R, 2] m; nan for none."""
        own = self.parameters.ais_own_mmsi
        if own and (reports.mmsi == own).any():
            rows = reports.mmsi != own
            reports, position = Reports(*(column[rows] for column in reports)), position[rows]
        known, next_id = ships.hear(memory.ships, reports, position, memory.next_id)
        return memory._replace(ships=known, next_id=next_id)

    def step(
        self,
        memory: AisMemory,
        seen: Seen | None,
        alerts: Alerts,
        own: OwnMotion,
        samples: OwnShip,
        drift: Array,
        sensors: OwnSensors,
        now: float,
    ) -> tuple[AisMemory, Alerts, Alerts, AisPicture]:
        """The ships at the time now, s: the memory, the alerts, those that changed, the picture.

        seen     the radar's tracks then; None: no scan came, what was joined is so for a while
        own      own ship, stabilised as the targets are; samples: hers
        drift    [2] m/s, what was subtracted from all motion for that
        """
        p = self.parameters
        known = ships.pass_time(memory.ships, now, p.ais_own_mmsi)
        moving = at(known, now)

        # joined: which of them are radar tracks
        before = memory.time
        elapsed = 0.0 if np.isnan(before) else float(np.clip(now - before, 0.0, MOST_STEP))
        known_pairs, errors, now_seen = memory.pairs, memory.registration, now
        joined = join.alone(len(known.id))
        if seen is None:
            if elapsed < MOST_STEP:
                joined = join.as_before(known_pairs, known)
            seen, now_seen = join.nothing_seen(), before
        elif p.ais_join:
            known_pairs, errors, joined = join.step(
                known_pairs, errors, known, moving, seen, own.position, now, elapsed
            )
        trusted = np.stack([known.id, joined.track], 1)[joined.agrees]
        memory = memory._replace(
            ships=known, pairs=known_pairs, registration=errors, time=now_seen, trusted=trusted
        )

        # passing: how they pass own ship
        passes = passing.look(self.arpa, known, moving, joined, own, samples, drift, sensors, now)
        memory, shown = self._shown(memory, passes, joined)

        # alarms
        changes = ais_alarms.step(
            alerts, self.arpa, p, known, joined, passes, shown == ACTIVATED, seen, now
        )
        told = passes.approach, passes.danger, shown, errors
        return memory, *changes, AisPicture(now, known, moving, joined, *told)

    def activate(self, memory: AisMemory, mmsi: int, awake: bool) -> AisMemory:
        """The operator activates a ship, or puts it to sleep. ValueError if there is none."""
        ids = memory.ships.id[memory.ships.mmsi == mmsi]
        if not len(ids):
            raise ValueError(f'there is no ship of AIS with the MMSI {mmsi}')
        roused, rests = (
            np.union1d(held, ids) if chosen else np.setdiff1d(held, ids)
            for held, chosen in ((memory.awake, awake), (memory.asleep, not awake))
        )
        return memory._replace(awake=roused, asleep=rests)

    def _shown(
        self, memory: AisMemory, passes: passing.Passing, joined: Joined
    ) -> tuple[AisMemory, CodeArray]:
        """Which ships are activated, sleeping, left out; the nearest first where room ends."""
        p, known = self.parameters, memory.ships
        memory = memory._replace(
            awake=memory.awake[among(memory.awake, known.id)],
            asleep=memory.asleep[among(memory.asleep, known.id)],
        )
        by_hand, rests = among(known.id, memory.awake), among(known.id, memory.asleep)
        danger = passes.danger == passing.DANGEROUS
        miles = passes.approach.range / NAUTICAL_MILE
        active = by_hand | (known.kind == m1371.SART) | (joined.state != join.AIS_ONLY)
        for rule, holds in (
            ('all', np.ones(len(known.id), bool)),
            ('danger', danger),
            ('zones', passes.guarded),
            ('range', miles <= p.ais_activation_range_nm),
        ):
            if rule in self.rules:
                active |= holds
        active |= known.lost & among(known.id, memory.active)
        active &= ~rests
        order = np.lexsort((np.nan_to_num(miles, nan=np.inf), ~danger, ~by_hand))
        active = _first(active, order, p.ais_max_activated)
        ahead = np.where(passes.approach.tcpa < 0, miles, passes.approach.cpa / NAUTICAL_MILE)
        asleep = ~active & np.isin(known.kind, self.kinds)
        asleep &= ~(miles > p.ais_range_nm) & ~(ahead > p.ais_cpa_nm)  # unknown ones stay
        asleep = _first(asleep, order, p.ais_max_sleeping)
        memory = memory._replace(active=known.id[active])
        shown = np.where(active, ACTIVATED, np.where(asleep, SLEEPING, LEFT_OUT))
        return memory, shown.astype(np.int8)


def _first(chosen: BoolArray, order: IntArray, most: int) -> BoolArray:
    """Of the chosen [S] the first `most` in the order."""
    rows = order[chosen[order]][:most]
    found = np.zeros(len(chosen), bool)
    found[rows] = True
    return found
