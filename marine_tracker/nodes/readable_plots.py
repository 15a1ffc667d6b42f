"""`radar/plots_readable`: one revolution for people to read."""

import array

import numpy as np
from geometry_msgs.msg import Point32
from sensor_msgs.msg import ChannelFloat32, PointCloud

from ..types import Array, Scan
from .convert import header, plots_positions


def plots_to_readable(scan: Scan, start_ns: int) -> PointCloud:
    """One revolution for people's eyes.

    Channels range_m, bearing_deg, amplitude_db, time_offset_s, and radial_speed_mps where the radar
    tells it. Values are rounded to binary fractions, which float32 holds exactly, so that an echo
    prints 123.25 and not 123.249996.
    """
    plots = scan.plots
    points = [Point32(x=x, y=y) for x, y in _rounded(plots_positions(scan), 2).tolist()]
    columns = [
        ('range_m', plots.range, 2),
        ('bearing_deg', np.degrees(plots.bearing), 8),
        ('amplitude_db', plots.amplitude, 2),
        ('time_offset_s', plots.time - scan.start, 8),
    ]
    if plots.radial_speed is not None:
        columns.append(('radial_speed_mps', plots.radial_speed, 16))
    channels = [
        ChannelFloat32(name=name, values=array.array('f', _rounded(values, parts).tolist()))
        for name, values, parts in columns
    ]
    return PointCloud(header=header(start_ns), points=points, channels=channels)


def _rounded(values: Array, parts: int) -> Array:
    found: Array = np.round(np.asarray(values) * parts) / parts
    return found
