"""Causes of alarms, made of the tracks of a situation or of single numbers."""

import numpy as np

from ..types import Array, CodeArray, IntArray
from .alerts import KEEP, OFF, ON, VALUES, Causes
from .situation import Situation

NO_LONGER = 0.95  # share of a level that keeps an alert


def of_tracks(
    situation: Situation, rows: IntArray, level: CodeArray | IntArray, *told: Array
) -> Causes:
    """Causes of the tracks at the rows; level [N], and the other numbers of each [N]."""
    values = np.full((len(rows), VALUES), np.nan)
    for column, value in enumerate((situation.range, situation.bearing, *told)):
        values[:, column] = value[rows]
    return Causes(
        situation.id[rows],
        situation.number[rows],
        level[rows].astype(np.int8),
        situation.position[rows],
        values,
    )


def single(value: float, limit: float, *told: float) -> Causes:
    """The cause of a kind that concerns no track. It is present from a value of `limit` on."""
    return causes_of(value >= limit, *told, keep=value >= NO_LONGER * limit)


def causes_of(there: bool, *told: float, keep: bool = False) -> Causes:
    """The cause of a kind that concerns no track, with the numbers of its text."""
    values = np.full((1, VALUES), np.nan)
    values[0, : len(told)] = told
    none = np.zeros(1, np.int64)
    return Causes(
        none,
        none,
        np.array([ON if there else KEEP if keep else OFF], np.int8),
        np.full((1, 2), np.nan),
        values,
    )
