"""The deviation of a radar's plots from the targets they belong to."""

from typing import NamedTuple, TypeVar

import numpy as np

from ..geometry import locate
from ..parameters import TrackerParameters
from ..types import Array, Plots, Scan
from .expected import Expected

Spread = TypeVar('Spread', Plots, Expected)  # what has a covariance [..., 2, 2] m^2


class Noise(NamedTuple):
    """The noise of the plots of one scan. Only this module knows of glint.

    range_sigma    m
    bearing_sigma  rad
    glint_sigma    m, each axis: the echoing point of a target, about the target's middle
    widest         m, deviation of the least certain plot if plots have their own covariance; else 0
    """

    range_sigma: float
    bearing_sigma: float
    glint_sigma: float
    widest: float

    def locate(self, scan: Scan) -> Plots:
        """The scan's plots as measured: where the echoes are."""
        return locate(scan.plots, scan.measured_from, self.range_sigma, self.bearing_sigma)

    def with_glint(self, spread: Spread) -> Spread:
        """The same with the covariance of glint added.

        Plots then show where the middle of the target is; expected targets show where they echo.
        """
        if not self.glint_sigma:
            return spread
        return spread._replace(covariance=spread.covariance + self.glint_sigma**2 * np.eye(2))

    def variance(self, distance: Array) -> Array:
        """m^2 [N], sum of both axes, of a plot's position at the distances [N] m, with glint."""
        across = distance * self.bearing_sigma
        return self.range_sigma**2 + across**2 + 2 * self.glint_sigma**2


def noise_of(radar: TrackerParameters, scan: Scan) -> Noise:
    """The noise of a scan's plots; the parameters are those of its radar."""
    told, widest = scan.plots.covariance, 0.0
    if told is not None:
        widest = float(np.sqrt(np.trace(told, axis1=1, axis2=2).max(initial=0.0)))
    return Noise(
        radar.range_sigma_m, float(np.radians(radar.bearing_sigma_deg)), radar.glint_sigma, widest
    )
