"""Rows of one table matched to those of another by their ids."""

import numpy as np
from numpy.typing import NDArray


def row_of(ids, wanted) -> NDArray[np.int64]:
    """Row [K] in ids [N], all different, of each wanted id [K]; -1 where it is not there."""
    if not len(ids):
        return np.full(len(wanted), -1)
    order = np.argsort(ids)
    place = np.minimum(np.searchsorted(ids, wanted, sorter=order), len(ids) - 1)
    row = order[place]
    return np.where(ids[row] == wanted, row, -1)
