"""The tracker without one of its parts, to see what the part is good for.

Two parts have a parameter, because users gain by it. For the others a simpler piece takes their
place, in this process and only within `without`.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import ModuleType
from typing import Any

import numpy as np

from ...tracking import clutter_map, detection_map, existence, split_plots, unresolved
from ...types import Array

# Of each part the parameters without it.
PARAMETERS: dict[str, dict[str, Any]] = {
    'joint': {'association': 'nearest'},  # which knows of no merged plots either
    'places': {'stationary_places': False},
}
SURE = 0.999
_density = clutter_map.density


def _exists(before: Array, *_: Any) -> Array:
    """Every track: what is left is M of N."""
    return np.full_like(before, SURE)


def _in_large_cells(clutter: clutter_map.ClutterMap, range_: Array, bearing: Array) -> Array:
    """The density of a map without small cells: their plots are spread over the large one."""
    rings, sectors = clutter_map.LARGE_RINGS, clutter_map.LARGE_SECTORS
    grid = clutter.plots.reshape(clutter_map.RINGS // rings, rings, -1, sectors)
    spread = np.broadcast_to(grid.mean((1, 3), keepdims=True), grid.shape)
    return _density(clutter._replace(plots=spread.reshape(-1)), range_, bearing)


# Of each part the functions that take its place.
FUNCTIONS: dict[str, tuple[tuple[ModuleType, str, Callable[..., Any]], ...]] = {
    'existence': ((existence, 'after', _exists),),
    'P_D': (
        (detection_map, 'probability', lambda known, range_, *rest: np.full_like(range_, rest[-1])),
        (existence, 'detection', lambda tracks, prior: prior),
    ),
    'fine map': ((clutter_map, 'density', _in_large_cells),),
    'merged plots': ((unresolved, 'shared', lambda *_: unresolved.NOBODY),),
    'split plots': (
        (split_plots, 'fused', lambda pairs, plot_of, plots, *_: plots),
        (split_plots, 'alone', lambda second, *_: np.ones(len(second), bool)),
    ),
}
PARTS = ('existence', 'P_D', 'fine map', 'joint', 'merged plots', 'split plots', 'places')


@contextmanager
def without(part: str | None) -> Iterator[dict[str, Any]]:
    """The tracker parameters with which a part is left out, where it can be left out; None: all
    parts work. ValueError for an unknown part."""
    if part is not None and part not in PARTS:
        raise ValueError(f'there is no part {part}; there are {", ".join(PARTS)}')
    changed = FUNCTIONS.get(part or '', ())
    whole = [(module, name, getattr(module, name)) for module, name, _ in changed]
    try:
        for module, name, piece in changed:
            setattr(module, name, piece)
        yield PARAMETERS.get(part or '', {})
    finally:
        for module, name, function in whole:
            setattr(module, name, function)
