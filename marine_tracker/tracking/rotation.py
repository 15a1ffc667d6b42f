"""How an antenna turns that sends its plots in sectors: told by the plots themselves.

A message of plots does not say which part of a revolution it is. But a plot's bearing is that of
the beam at the plot's time. So period and phase of the rotation are those for which bearing and
time of all recent plots agree best.
"""

from typing import NamedTuple

import numpy as np

from ..geometry import wrap_angle, wrap_bearing
from ..types import Array, Sector

TURN = 2 * np.pi
PART = 0.75  # of the stated period; messages that follow one another faster may be sectors
SPAN = 2.5  # stated periods that are remembered
LEAST, MOST = 4, 600  # plots
TRIED = np.exp2(np.linspace(-1.0, 1.0, 121))  # periods, of the stated one
AGREE = 0.9  # mean resultant length of the phases, 1 if all are the same
NEARLY = (
    0.98  # of the best: a few plots may fit several periods, then the one nearest to that stated
)


class Rotation(NamedTuple):
    """What is known of an antenna: plots heard lately, and how it turns.

    time, bearing  [P] s, rad, of the plots
    begun   s, the first message; nan: none
    period  s; nan where it is not known
    phase   rad, direction of the beam at time 0
    """

    time: Array
    bearing: Array
    begun: float
    period: float
    phase: float

    @property
    def known(self) -> bool:
        """Whether it is known how the antenna turns."""
        return bool(np.isfinite(self.period))

    def sector(self, start: float, end: float) -> Sector | None:
        """The part of a revolution between two times, s; None: a whole one, or more."""
        angle = TURN * (end - start) / self.period
        if angle > PART * TURN:
            return None
        return Sector(float(wrap_bearing(self.phase + TURN * start / self.period)), angle)


def begin() -> Rotation:
    """Nothing is known."""
    return Rotation(np.zeros(0), np.zeros(0), np.nan, np.nan, 0.0)


def hear(
    before: Rotation, start: float, time: Array, bearing: Array, stated: float, spacing: float
) -> Rotation:
    """What is known after one more message, which begins at `start` s.

    time, bearing  [M] s, rad, of its plots
    stated         s, period of a revolution by parameter
    spacing        s, usual time between two messages
    """
    since, begun = start - SPAN * stated, np.fmin(before.begun, start)
    time, bearing = np.append(before.time, time)[-MOST:], np.append(before.bearing, bearing)[-MOST:]
    keep = time > since
    keep[-LEAST:] = True
    heard = before._replace(time=time[keep], bearing=bearing[keep], begun=begun)
    if start + spacing - begun < stated or len(heard.time) < LEAST:
        return heard
    period = _period(heard.time - start, heard.bearing, np.append(stated * TRIED, spacing), stated)
    if np.isnan(period):
        return heard._replace(period=np.nan)
    for _ in range(2):  # a straight line through what is left
        phase, off = _phase(heard.time, heard.bearing, period)
        late = heard.time - heard.time.mean()
        period = TURN / (TURN / period + (late @ off) / max(late @ late, 1e-9))
    phase, _ = _phase(heard.time, heard.bearing, period)
    return heard._replace(period=float(period), phase=phase)


def _period(time: Array, bearing: Array, tried: Array, stated: float) -> float:
    """The period at which bearings and times agree best; nan where they do not."""
    phases = bearing - TURN * time / tried[:, None]
    agree = np.abs(np.exp(1j * phases).mean(1))
    if agree.max() < AGREE:
        return np.nan
    fit = tried[agree >= NEARLY * agree.max()]
    return float(fit[np.abs(np.log(fit / stated)).argmin()])


def _phase(time: Array, bearing: Array, period: float) -> tuple[float, Array]:
    """Direction of the beam at time 0, and how far [P] rad the bearings are from it."""
    phases = bearing - TURN * time / period
    middle = float(np.angle(np.exp(1j * phases).mean()))
    return middle, wrap_angle(phases - middle)
