"""A file of trained weights: arrays and what they are; damage is noticed."""

import hashlib
import json
import zipfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

FOLDER = Path(__file__).parent / 'weights'


def checksum(arrays) -> str:
    """SHA-256 over names, shapes and values of the arrays."""
    digest = hashlib.sha256()
    for name in sorted(arrays):
        digest.update(f'{name}{arrays[name].shape}'.encode())
        digest.update(np.ascontiguousarray(arrays[name], '<f4').tobytes())
    return digest.hexdigest()


def write(path: str | Path, arrays: dict[str, np.ndarray], manifest: dict[str, Any]) -> None:
    """Write arrays of float32 and the manifest, which holds `format` and `checksum`."""
    with open(path, 'wb') as file:
        np.savez(file, manifest=np.array(json.dumps(manifest)), **arrays)  # type: ignore[arg-type]


def read(
    path: str | Path, kind: str, command: str, form: int, names: Iterable[str]
) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """The arrays of the given names and the manifest.

    kind: what the weights are of; command: what writes such files; form: their format. Raises
    ValueError for a file that cannot be read, is damaged, or is of another kind or format.
    """
    what = f'{kind} weights {path}'
    try:
        with np.load(path, allow_pickle=False) as file:
            manifest = json.loads(str(file['manifest']))
            arrays = {name: file[name] for name in file.files if name != 'manifest'}
    except OSError as error:
        raise ValueError(f'{what} cannot be read: {error.strerror or error}') from error
    except (
        ValueError,
        KeyError,
        EOFError,
        TypeError,
        RuntimeError,
        MemoryError,
        zipfile.BadZipFile,
    ) as error:  # a wrong bit anywhere, or another kind of file
        raise ValueError(f'{what}: this is no file of `{command}`, or it is damaged') from error
    if not isinstance(manifest, dict) or 'format' not in manifest:
        raise ValueError(f'{what}: this is no file of `{command}`')
    if manifest['format'] != form:
        raise ValueError(
            f'{what} has format {manifest["format"]}; this version reads {form}: train anew'
        )
    wanted = set(names)
    if set(arrays) != wanted:
        odd = ', '.join(sorted(set(arrays) ^ wanted))
        raise ValueError(f'{what} does not hold the right arrays: {odd}')
    if checksum(arrays) != manifest.get('checksum'):
        raise ValueError(f'{what} is damaged: the checksum does not match')
    return arrays, manifest


def checked(values, name: str, shape: tuple[int, ...], what: str):
    """The array, if it has the shape and is finite; else ValueError."""
    if values.shape != shape:
        raise ValueError(
            f'{what} belongs to another network: {name} has shape '
            f'{values.shape}; it must be {shape}'
        )
    if not np.isfinite(values).all():
        raise ValueError(f'{what}: {name} holds values that are not finite')
    return values
