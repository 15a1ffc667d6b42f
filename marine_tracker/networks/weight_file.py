"""A file of trained weights: arrays and their description. Damage is detected."""

import hashlib
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import yaml_file
from ..files import shortened, shown, written
from ..types import Array
from . import array_file

FOLDER = Path(__file__).parent / 'weights'


def checksum(arrays: Mapping[str, NDArray[Any]]) -> str:
    """SHA-256 over names, shapes and values of the arrays."""
    digest = hashlib.sha256()
    for name in sorted(arrays):
        digest.update(f'{name}{arrays[name].shape}'.encode())
        digest.update(np.ascontiguousarray(arrays[name], '<f4').tobytes())
    return digest.hexdigest()


def write(path: str | Path, arrays: Mapping[str, NDArray[Any]], manifest: dict[str, Any]) -> None:
    """Writes arrays of float32 and the manifest, which holds `format` and `checksum`."""
    with written(path, 'wb') as file:
        np.savez(file, manifest=np.array(json.dumps(manifest)), **arrays)  # type: ignore[arg-type]


def read(
    path: str | Path, kind: str, command: str, form: int, names: Iterable[str]
) -> tuple[dict[str, NDArray[Any]], dict[str, Any]]:
    """The arrays with the given names, and the manifest.

    kind: what the weights are for; command: what writes such files; form: their format. Raises
    ValueError if the file cannot be read, is damaged, or has another kind or format.
    """
    what = f'{kind} weights {shortened(path)}'
    try:
        arrays = array_file.read(path)
    except OSError as error:
        raise ValueError(f'{what} cannot be read: {error.strerror or error}') from error
    except ValueError as error:  # a wrong bit, or another kind of file
        raise ValueError(
            f'{what}: this is no file of `{command}`, or it is damaged: {error}'
        ) from error
    if 'manifest' not in arrays:
        raise ValueError(f'{what}: this is no file of `{command}`')
    manifest = yaml_file.parse_json(str(arrays.pop('manifest')), f'{what}: its manifest')
    if manifest.get('format') != form:
        raise ValueError(
            f'{what} has format {shown(manifest.get("format"))}; this version reads {form}: '
            'train again'
        )
    wanted = set(names)
    if set(arrays) != wanted:
        odd = ', '.join(shortened(name) for name in sorted(set(arrays) ^ wanted)[:10])
        raise ValueError(f'{what} does not hold the right arrays: {odd}')
    if checksum(arrays) != manifest.get('checksum'):
        raise ValueError(f'{what} is damaged: the checksum does not match')
    return arrays, manifest


def checked(values: Array, name: str, shape: tuple[int, ...], what: str) -> Array:
    """The array, if it has the shape and is finite; else ValueError."""
    if values.shape != shape:
        raise ValueError(
            f'{what} belongs to another network: {name} has shape '
            f'{values.shape}; it must be {shape}'
        )
    if not np.isfinite(values).all():
        raise ValueError(f'{what}: {name} holds values that are not finite')
    return values
