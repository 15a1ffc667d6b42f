"""What every estimator is: three pure functions over arrays with a leading track axis."""

from collections.abc import Callable
from typing import Any, NamedTuple

from ..types import Array, Extrapolation, Plots


class Velocity(NamedTuple):
    """Velocities known beforehand: mean [K, 2] m/s and covariance [K, 2, 2] m^2/s^2."""

    mean: Array
    covariance: Array


class Estimator(NamedTuple):
    """A filter bank that runs any number of tracks at once.

    init(plots, velocity=None) -> state
        One new row for each plot. What is known of the targets' velocities, where something is:
        `Velocity`; by default they are anywhere within the targets' greatest speed.
    extrapolate(state, time) -> Extrapolation
        Every row to its own time [N] s, which may lie before or after the row's last plot;
        state is untouched.
    update(state, plots, rows) -> state
        The K named rows (int [K], each at most once) take one plot each. Rows not named had no
        plot: their time stays behind and the next `extrapolate` covers the gap.

    State is a NamedTuple of arrays with one row a track (it may nest), to be handled with
    `types.take`, `append` and `where` only. The functions never write to their arguments.
    """

    init: Callable[..., Any]
    extrapolate: Callable[[Any, Array], Extrapolation]
    update: Callable[[Any, Plots, Any], Any]
