import numpy as np
import pytest

from marine_tracker.arpa import zones as zones_module
from marine_tracker.arpa.cpa import OwnMotion, approach
from marine_tracker.arpa.motion import Motion
from marine_tracker.arpa.situation import Limits, look
from marine_tracker.tracking.lifecycle import CONFIRMED, LOST, MISSED
from marine_tracker.types import Tracks


@pytest.fixture(scope='session')
def situate():
    """The situation of tracks at known positions, through the real CPA and zones.

    position [N, 2] m, velocity [N, 2] m/s or none; by default the tracks are confirmed and have
    the ids 1 ... N, which are their numbers too, except that tentative ones have none.
    """

    def make(
        position,
        velocity=None,
        status=CONFIRMED,
        id=None,
        number=None,
        reason=None,
        zones='',
        own_position=(0.0, 0.0),
        own_velocity=(0.0, 0.0),
        heading=0.0,
        harmless=False,
        limits=None,
        sigma=(10.0, 0.05),
    ):
        limits = limits or Limits()
        position = np.asarray(position, float).reshape(-1, 2)
        count = len(position)
        velocity = (
            np.zeros((count, 2))
            if velocity is None
            else np.reshape(np.asarray(velocity, float), (-1, 2))
        )
        id = np.arange(1, count + 1) if id is None else np.asarray(id, np.int64)
        status = np.broadcast_to(np.asarray(status, np.int8), count).copy()
        if number is None:
            number = np.where(status == 0, 0, id)
        if reason is None:
            reason = np.where(status == LOST, MISSED, 0)
        zero, whole = np.zeros(count), np.zeros(count, np.int64)
        tracks = Tracks(
            id, np.broadcast_to(number, count), status, whole, zero, whole, zero, zero, zero, whole
        )
        covariance = np.diag(np.repeat(np.square(np.asarray(sigma)), 2))
        motion = Motion(
            **{
                **dict.fromkeys(Motion._fields, zero),
                'position': position,
                'velocity': velocity,
                'covariance': np.tile(covariance, (count, 1, 1)),
            }
        )
        own = OwnMotion(
            np.asarray(own_position, float),
            np.asarray(own_velocity, float),
            heading,
            np.zeros((4, 4)),
        )
        if isinstance(zones, str):
            zones = zones_module.parse(zones)
        return look(
            tracks,
            np.broadcast_to(np.asarray(reason, np.int8), count),
            position,
            approach(motion, own, limits.cpa, limits.tcpa),
            np.broadcast_to(harmless, count),
            zones,
            own,
            limits,
        )

    return make
