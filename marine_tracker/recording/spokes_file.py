"""Radar video in a file: spokes as the radar sent them, and own ship.

A file NAME.npz (numpy, without pickles) holds one row a spoke:

  time_s        [S]     from any moment on, not decreasing
  angle_deg     [S]     clockwise from the bow
  heading_deg   [S]     as the radar told it; nan where it did not
  heading_true  [S]     bool: the heading is true, else magnetic
  range_m       [S]     of the end of the last sample; samples are even from 0 on
  sample        [S, B]  uint8 or uint16: echo strength in the radar's own scale

and may hold K samples of own ship: `own_ship` [K, 6] with time s, east m, north m, velocity east
and north m/s, heading deg (nan: not known). Without it own ship lies at rest.
"""

import contextlib
import zipfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..files import Place, regular, shortened
from ..types import Array, BoolArray, OwnShip, Sweep, take

ARRAYS = ('time_s', 'angle_deg', 'heading_deg', 'heading_true', 'range_m', 'sample')
OWN_SHIP = 'own_ship'
MOST_BYTES = 8_000_000_000  # of all strengths
SPOKES_AT_ONCE = 128


class Video(NamedTuple):
    """A recording of radar video.

    name          the file's name
    sweep         all its spokes; headings are as told, true or not
    heading_true  [S]  which headings are true
    own_ship      K samples; at rest at the origin, without a heading, where the file tells none
    """

    name: str
    sweep: Sweep
    heading_true: BoolArray
    own_ship: OwnShip

    @property
    def remarks(self) -> tuple[str, ...]:
        """What people should know of it."""
        told = np.isfinite(self.sweep.heading)
        remarks = []
        if not told.any() and self.own_ship.heading is None:
            remarks.append(
                f'recording {self.name} tells no heading, so no true bearings: state one '
                '(--heading) if own ship lay still'
            )
        if (told & ~self.heading_true).any():
            remarks.append(
                f'recording {self.name} has magnetic headings: bearings count from magnetic north'
            )
        return tuple(remarks)


def is_spokes_file(path: Place) -> bool:
    """Whether the path has the ending of such a file."""
    return Path(path).suffix == '.npz'


def read(path: Place, heading: float | None = None) -> Video:
    """The recording in a file; ValueError names the file, the array and what is wrong with it.

    heading  rad, own ship's where the file tells none; None: none
    """
    try:
        with np.load(regular(path), allow_pickle=False) as file:
            arrays = _arrays(file, path)
    except (zipfile.BadZipFile, EOFError, KeyError) as error:
        raise ValueError(f'{shortened(path)} is not a whole .npz file: {error}') from None
    except ValueError as error:
        text = str(error)
        named = text if text.startswith(shortened(path)) else f'{shortened(path)}: {text}'
        raise ValueError(named) from None
    time, angle, told, true, range_, sample = (arrays[name] for name in ARRAYS)
    own_ship = _own_ship(arrays.get(OWN_SHIP), time, path)
    told = np.radians(told.astype(float))
    if heading is not None:
        true = true | np.isnan(told)
        told = np.where(np.isnan(told), heading, told)
    sweep = Sweep(
        time.astype(float), np.radians(angle.astype(float)), told, range_.astype(float), sample
    )
    return Video(Path(path).stem, sweep, true.astype(bool), own_ship)


def _arrays(file, path) -> dict[str, np.ndarray]:
    missing = [name for name in ARRAYS if name not in file.files]
    if missing:
        raise ValueError(f'{shortened(path)} has no array {missing[0]}')
    arrays = {name: file[name] for name in (*ARRAYS, OWN_SHIP) if name in file.files}
    sample = arrays['sample']
    if sample.dtype not in (np.uint8, np.uint16) or sample.ndim != 2:
        raise ValueError(
            f'{shortened(path)}: sample is {sample.dtype} with shape {sample.shape}; it must be '
            'uint8 or uint16 with one row a spoke'
        )
    if not sample.size or sample.nbytes > MOST_BYTES:
        raise ValueError(
            f'{shortened(path)}: sample has {sample.nbytes} bytes; it must have 1 to {MOST_BYTES}'
        )
    for name in ARRAYS[:-1]:
        array = arrays[name]
        if array.shape != sample.shape[:1] or array.dtype.kind not in 'fiub':
            raise ValueError(
                f'{shortened(path)}: {name} is {array.dtype} with shape {array.shape}; it must be '
                f'numbers, one for each of the {len(sample)} spokes'
            )
    return arrays


def _own_ship(rows, time, path) -> OwnShip:
    if rows is None:
        ends = np.array([time[0], max(time[-1], time[0] + 1e-3)], float)
        return OwnShip(ends, np.zeros((2, 2)), np.zeros((2, 2)))
    rows = np.asarray(rows, float)
    if rows.ndim != 2 or rows.shape[1] != 6 or not len(rows):
        raise ValueError(
            f'{shortened(path)}: {OWN_SHIP} has shape {rows.shape}; it must be rows of six numbers'
        )
    if not np.isfinite(rows[:, :5]).all() or (np.diff(rows[:, 0]) <= 0).any():
        raise ValueError(f'{shortened(path)}: {OWN_SHIP} must be finite, with times that increase')
    told = np.isfinite(rows[:, 5]).any()
    heading = np.radians(rows[:, 5]) if told else None
    return OwnShip(rows[:, 0], rows[:, 1:3], rows[:, 3:5], heading)


def write(path: Place, sweeps: Iterable[Sweep], own_ship: OwnShip) -> int:
    """Writes spokes and own ship into a file; returns the number of spokes.

    Headings are true. ValueError where sweeps have different numbers of samples, or there is none.
    """
    parts = list(sweeps)
    if len({(part.strength.shape[1], part.strength.dtype) for part in parts}) != 1:
        raise ValueError(
            f'{len(parts)} sweeps for {shortened(path)}; there must be some, all with the same '
            'number of samples'
        )
    time, angle, heading, range_, strength = (
        np.concatenate(column) for column in zip(*parts, strict=True)
    )
    stated = np.full(len(own_ship.time), np.nan) if own_ship.heading is None else own_ship.heading
    rows = np.column_stack(
        [own_ship.time, own_ship.position, own_ship.velocity, np.degrees(stated)]
    )
    part = Path(f'{path}.part')
    try:
        with open(part, 'wb') as file:
            np.savez_compressed(
                file,
                time_s=time,
                angle_deg=np.degrees(angle).astype(np.float32),
                heading_deg=np.degrees(heading).astype(np.float32),
                heading_true=np.isfinite(heading),
                range_m=range_.astype(np.float32),
                sample=strength,
                own_ship=rows,
            )
        part.replace(path)
    finally:
        with contextlib.suppress(OSError):
            part.unlink()
    return len(time)


def sweeps(video: Video, spokes: int = SPOKES_AT_ONCE) -> Iterator[Sweep]:
    """The recording in parts of so many spokes."""
    for first in range(0, len(video.sweep.time), spokes):
        yield take(video.sweep, slice(first, first + spokes))


def own_ship_between(own_ship: OwnShip, start: float, end: float) -> OwnShip:
    """Own ship's samples from the last one before `start` to the first one after `end`."""
    time: Array = own_ship.time
    first = max(int(np.searchsorted(time, start, 'right')) - 1, 0)
    last = min(int(np.searchsorted(time, end)) + 1, len(time))
    return take(own_ship, slice(min(first, len(time) - 1), max(last, first + 1)))
