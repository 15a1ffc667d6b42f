"""Radar video as messages: `radar/spokes`, and marine_sensor_msgs/RadarSector.

`radar/spokes` is a PointCloud2 with one point a spoke: time_offset s from the stamp, angle rad
clockwise from the bow, heading rad true or nan, range m of the end of the last sample, and
strength, uint8 or uint16, whose count is the number of samples.
"""

import math
from typing import Any

import numpy as np
from sensor_msgs.msg import PointCloud2

from ..types import Array, Sweep
from . import cloud_layout, convert
from .cloud_layout import FLOATS, INTEGERS, Wanted
from .faults import BAD_LAYOUT, ConversionError
from .topics import OWN_SHIP_FRAME

NUMBERS = ('time_offset', 'angle', 'heading', 'range')
STRENGTH = 'strength'
MOST_SAMPLES = 16_384
FULL = 255  # strength of the strongest echo of a RadarSector
FRAMES = (OWN_SHIP_FRAME, 'radar')
NO_SWEEP = Sweep(np.empty(0), np.empty(0), np.empty(0), np.empty(0), np.empty((0, 0), np.uint8))
WANTED = (
    *(Wanted(name, FLOATS) for name in NUMBERS),
    Wanted(STRENGTH, INTEGERS, most=MOST_SAMPLES),
)


def sweep_to_cloud(sweep: Sweep, start: float, start_ns: int) -> PointCloud2:
    """The message; its stamp `start_ns` stands for the time `start` s of the sweep."""
    kind = sweep.strength.dtype.str[1:]
    count = sweep.strength.shape[1]
    rows = np.zeros(
        len(sweep.time), [*((name, '<f4') for name in NUMBERS), (STRENGTH, f'<{kind}', (count,))]
    )
    columns = (sweep.time - start, sweep.angle, sweep.heading, sweep.range, sweep.strength)
    for name, column in zip((*NUMBERS, STRENGTH), columns):
        rows[name] = column
    return cloud_layout.message(rows, convert.header(start_ns, OWN_SHIP_FRAME))


def cloud_to_sweep(message: PointCloud2, start: float) -> Sweep:
    """The spokes of a message whose stamp is the time `start` s; not judged here.

    ConversionError where its layout is wrong.
    """
    if not message.width * message.height:
        return NO_SWEEP
    rows = cloud_layout.rows(message, WANTED)
    with np.errstate(invalid='ignore'):  # signalling NaNs from a torn buffer
        offset, angle, heading, range_ = (rows[name].astype(float) for name in NUMBERS)
    strength = rows[STRENGTH]
    kind = np.uint8 if strength.dtype.itemsize == 1 else np.uint16
    return Sweep(start + offset, angle, heading, range_, strength.astype(kind))


def sector_to_sweep(message: Any, start: float) -> Sweep:
    """The spokes of a RadarSector whose stamp is the time `start` s of its first spoke.

    Angles of the message are counter-clockwise from ahead; a negative increment is a beam that
    turns clockwise. Its samples begin at range_min; what lies before is 0. Echoes are numbers from
    0 on in a scale of their own; they are put into 0 to 255, by the first power of two that holds
    them. ConversionError where lengths differ or values are no numbers.
    """
    spokes = message.intensities
    samples = {len(spoke.echoes) for spoke in spokes}
    if len(samples) > 1:
        raise ConversionError(BAD_LAYOUT, f'spokes of {min(samples)} to {max(samples)} samples')
    if not samples or not max(samples):
        return NO_SWEEP
    echoes: Array = np.array([spoke.echoes for spoke in spokes], float)
    near, far = float(message.range_min), float(message.range_max)
    if not (math.isfinite(near) and 0 <= near < far):
        raise ConversionError(BAD_LAYOUT, f'range_min is {near:g}, range_max is {far:g}')
    with np.errstate(invalid='ignore'):
        echoes = np.where(echoes > 0, echoes, 0.0)
    top = float(echoes.max())
    if not math.isfinite(top):
        raise ConversionError(BAD_LAYOUT, 'an echo is not finite')
    count = echoes.shape[1]
    before = round(near / (far - near) * count)
    if before + count > MOST_SAMPLES:
        raise ConversionError(BAD_LAYOUT, f'range_min is {near:g} of {far:g} m: too near its end')
    strength = np.zeros((len(spokes), before + count), np.uint8)
    strength[:, before:] = np.rint(echoes * (FULL / _scale(top)))
    number = np.arange(len(spokes))
    step = message.time_increment.sec + 1e-9 * message.time_increment.nanosec
    angle = -(message.angle_start + number * message.angle_increment)
    return Sweep(
        start + number * step,
        np.mod(angle, 2 * math.pi),
        np.full(len(spokes), np.nan),
        np.full(len(spokes), far),
        strength,
    )


def _scale(top: float) -> float:
    """What full strength is: 1, 15, 255 or the power of two that holds it."""
    return next(
        (full for full in (1.0, 15.0, 255.0) if top <= full),
        2.0 ** math.ceil(math.log2(max(top, 1.0))),
    )
