"""What every estimator is: three pure functions over arrays with a leading track axis."""

from collections.abc import Callable
from typing import Any, NamedTuple

from ..types import Array, Extrapolation, Plots


class Estimator(NamedTuple):
    """A filter bank that runs any number of tracks at once.

    init(plots) -> state
        One new row for each plot.
    extrapolate(state, time) -> Extrapolation
        Every row to its own time [N] s, which may lie before or after the row's last plot;
        state is untouched.
    update(state, plots, rows) -> state
        The K named rows (int [K], each at most once) take one plot each. Rows not named had no
        plot: their time stays behind and the next `extrapolate` covers the gap.

    State is a NamedTuple of arrays with one row a track (it may nest), to be handled with
    `types.take`, `append` and `where` only. The functions never write to their arguments.
    """

    init: Callable[[Plots], Any]
    extrapolate: Callable[[Any, Array], Extrapolation]
    update: Callable[[Any, Plots, Any], Any]
