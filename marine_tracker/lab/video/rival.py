"""What is usual elsewhere: a fixed threshold, and blobs on the grid of spokes and samples."""

import numpy as np
from scipy import ndimage

from ...types import Array, PolarPlots, StrengthArray

TOUCH = np.ones((3, 3), bool)
LEAST_CELLS = 3
SIGMA = 0.25  # of beam and pulse: what such plots are said to be accurate to


def blobs(
    strength: StrengthArray,
    time: Array,
    bearing: Array,
    step: float,
    threshold: int,
    largest: float,
) -> PolarPlots:
    """Centroids of the blobs over `threshold` in a revolution; none longer than `largest` m."""
    labels, count = ndimage.label(strength >= threshold, TOUCH)
    row, sample = np.nonzero(labels)
    which = labels[row, sample] - 1
    cells = np.bincount(which, minlength=count)
    weight = strength[row, sample].astype(float)
    total = np.bincount(which, weight, count)
    centre = [np.bincount(which, weight * a, count) / total for a in (row, sample + 0.5)]
    boxes = ndimage.find_objects(labels)
    spacing = 2 * np.pi / len(time)
    size = np.array(
        [
            max((b[1].stop - b[1].start) * step, (b[0].stop - b[0].start) * spacing * r * step)
            for b, r in zip(boxes, centre[1])
        ]
    )
    good = (cells >= LEAST_CELLS) & (size <= largest) if count else np.zeros(0, bool)
    rows, samples = centre[0][good], centre[1][good]
    at = np.arange(len(time))
    return PolarPlots(
        np.interp(rows, at, time),
        samples * step,
        np.interp(rows, at, bearing),
        np.full(len(rows), 20.0),
    )
