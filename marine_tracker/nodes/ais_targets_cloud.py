"""`ais/targets`: the ships of AIS after a scan as numbers, in one message. Fields: doc/ais.md.

Lengths in m, times in s, angles in rad clockwise from true north; nan where nothing is known.
"""

import numpy as np
from sensor_msgs.msg import PointCloud2

from ..ais.ais import LEFT_OUT, AisPicture
from ..recording import cloud_rows
from . import convert
from .ais_cloud import CALL_SIGN, NAME, NONE, codes, wanted

PASSING = ('range', 'bearing', 'course', 'speed', 'cpa', 'tcpa')  # fields of arpa.cpa.Approach
SHIP_TYPE = np.dtype(
    [('mmsi', '<u4'), ('track', '<u4'), ('id', '<u4')]
    + [(name, '<f4') for name in ('x', 'y', 'z', 'vx', 'vy', 'position_sd')]
    + [(name, '<f8') for name in PASSING]
    + [(name, '<f4') for name in ('cpa_sd', 'tcpa_sd', 'danger_probability', 'probability')]
    + [(name, '<f4') for name in ('heading', 'turn', 'length', 'beam', 'age')]
    + [(name, 'u1') for name in ('kind', 'status', 'state', 'shown', 'danger')]
    + [(name, 'u1') for name in ('lost', 'double', 'accurate', 'coarse')]
    + [('name', 'u1', (NAME,)), ('call_sign', 'u1', (CALL_SIGN,))]
)


WANTED = wanted(SHIP_TYPE)


def points(picture: AisPicture) -> np.ndarray:
    """The ships as an array, without those that the filter leaves out."""
    chosen = (picture.shown != LEFT_OUT).nonzero()[0]
    ships, moving, passing = picture.ships, picture.moving, picture.approach
    rows = np.zeros(len(chosen), SHIP_TYPE)
    rows['mmsi'], rows['id'] = ships.mmsi[chosen], ships.id[chosen]
    rows['track'] = picture.joined.track[chosen]
    rows['x'], rows['y'] = moving.position[chosen].T
    velocity = np.where(moving.told[:, None], moving.velocity, np.nan)
    rows['vx'], rows['vy'] = velocity[chosen].T
    spread = 0.5 * np.trace(moving.covariance[:, :2, :2], axis1=1, axis2=2)
    rows['position_sd'] = np.sqrt(spread)[chosen]
    for name in PASSING:
        rows[name] = getattr(passing, name)[chosen]
    rows['cpa_sd'], rows['tcpa_sd'] = passing.cpa_sigma[chosen], passing.tcpa_sigma[chosen]
    rows['danger_probability'] = passing.danger_probability[chosen]
    rows['probability'] = picture.joined.probability[chosen]
    rows['state'] = picture.joined.state[chosen]
    rows['shown'], rows['danger'] = picture.shown[chosen], picture.danger[chosen]
    rows['age'] = picture.time - ships.time[chosen]
    for name in ('heading', 'turn', 'length', 'beam', 'kind', 'lost', 'double', 'accurate'):
        rows[name] = getattr(ships, name)[chosen]
    rows['coarse'] = ships.coarse[chosen]
    rows['status'] = np.where(ships.status < 0, NONE, ships.status)[chosen]
    for name, length in (('name', NAME), ('call_sign', CALL_SIGN)):
        rows[name] = codes(getattr(ships, name)[chosen], length)
    return rows


def read(cloud: PointCloud2) -> np.ndarray:
    """The ships of a message. ConversionError where it is none."""
    return cloud_rows.rows(cloud, WANTED)


def message(picture: AisPicture, time_ns: int) -> PointCloud2:
    """The ships of a picture."""
    return convert.cloud_message(points(picture), time_ns)
