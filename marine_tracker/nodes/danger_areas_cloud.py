"""`danger_areas`: where own ship, on a steady course, would pass a target too near.

Points of area 0 are the ring of courses around own ship: one for each course, at her place, with
the probability that at least one target passes within the limits, and whether the course is safe.
Those of the areas from 1 on stand in the middle of the stretch of a course that is in the area.
Lengths in m, angles in rad clockwise from true north, as the targets' motion is stabilised. No
point at all: own ship's course and speed are not known. See arpa/danger_areas.py.
"""

import numpy as np
from sensor_msgs.msg import PointCloud2

from ..ais.ais import AisPicture
from ..arpa.arpa import Arpa, Picture
from ..arpa.danger_areas import dangers
from ..geometry import unit_vector
from . import convert
from .arpa_messages import all_targets, lacking

RING = 0  # of the field area
AREA_TYPE = np.dtype(
    [(name, '<f4') for name in ('x', 'y', 'z')]
    + [(name, '<u4') for name in ('area', 'number', 'id')]
    + [(name, '<f4') for name in ('course', 'near', 'far', 'probability')]
    + [('safe', 'u1')]
)


def message(arpa: Arpa, picture: Picture, ships: AisPicture | None, time_ns: int) -> PointCloud2:
    """The areas and the ring of a picture, within the limits of the alarm; of radar targets and of
    activated ships of AIS, which have the id 0 and their MMSI for a number."""
    if lacking(picture):
        return convert.cloud_message(np.zeros(0, AREA_TYPE), time_ns)
    own, limits = picture.own, arpa.limits
    motion, ids, numbers = all_targets(picture, ships)
    found = dangers(motion, own, limits.cpa, limits.tcpa)
    ring = np.zeros(len(found.course), AREA_TYPE)
    ring['x'], ring['y'] = own.position
    ring['course'], ring['probability'] = found.course, found.probability
    ring['near'] = ring['far'] = np.nan
    ring['safe'] = found.safe
    areas = found.areas
    rows = np.zeros(areas.course.shape, AREA_TYPE)
    middle = (areas.near + areas.far) / 2
    place = own.position + middle[..., None] * unit_vector(areas.course)
    rows['x'], rows['y'] = place[..., 0], place[..., 1]
    rows['area'] = 1 + np.arange(len(areas.row))[:, None]
    rows['number'] = numbers[areas.row][:, None]
    rows['id'] = np.maximum(ids, 0)[areas.row][:, None]
    rows['course'] = areas.course
    rows['near'], rows['far'] = areas.near, areas.far
    rows['probability'] = areas.probability
    return convert.cloud_message(np.concatenate([ring, rows.ravel()]), time_ns)
