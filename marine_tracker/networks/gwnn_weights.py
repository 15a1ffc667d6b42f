"""The trained weights of `gwnn`: one file that says what it is and notices when it is damaged."""

import hashlib
import json
import zipfile
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .wavelet_network import Layout, Network, group_size

FORMAT = 1
FOLDER = Path(__file__).parent / 'weights'
ARRAYS = ('centre', 'scale', 'inner', 'outer', 'bias')
NETWORKS = ('fusion', 'spread')


class Weights(NamedTuple):
    """fusion: weighs and corrects the experts; spread: says how sure that is.

    manifest: how they came about; made known to people, not used. All arrays are float32: half
    the time, for a micrometre or so.
    """

    fusion: Network
    spread: Network
    manifest: dict[str, Any]


def shipped(vessel_class: str) -> Path:
    """The file of weights that comes with the package for a vessel class."""
    return FOLDER / f'gwnn_{vessel_class}.npz'


def _arrays(weights: Weights) -> dict[str, np.ndarray]:
    return {f'{name}_{array}': np.asarray(getattr(getattr(weights, name), array), np.float32)
            for name in NETWORKS for array in ARRAYS}


def checksum(arrays) -> str:
    """SHA-256 over names, shapes and values of the arrays."""
    digest = hashlib.sha256()
    for name in sorted(arrays):
        digest.update(f'{name}{arrays[name].shape}'.encode())
        digest.update(np.ascontiguousarray(arrays[name], '<f4').tobytes())
    return digest.hexdigest()


def save(path, weights: Weights) -> dict[str, Any]:
    """Write the file; returns its manifest, with format, layouts and checksum filled in."""
    arrays = _arrays(weights)
    manifest = {**weights.manifest, 'format': FORMAT, 'checksum': checksum(arrays),
                'layouts': {name: list(getattr(weights, name).layout) for name in NETWORKS}}
    with open(path, 'wb') as file:
        np.savez(file, manifest=np.array(json.dumps(manifest)), **arrays)  # type: ignore[arg-type]
    return manifest


def load(path, inputs: int, outputs: dict[str, int]) -> Weights:
    """Read a file of weights for networks of so many inputs, and outputs by network.

    Raises ValueError for a file that cannot be read, is damaged, or belongs to other networks.
    """
    what = f'GWNN weights {path}'
    try:
        with np.load(path, allow_pickle=False) as file:
            manifest = json.loads(str(file['manifest']))
            arrays = {name: file[name] for name in file.files if name != 'manifest'}
    except OSError as error:
        raise ValueError(f'{what} cannot be read: {error.strerror or error}') from error
    except (ValueError, KeyError, EOFError, TypeError, RuntimeError, MemoryError,
            zipfile.BadZipFile) as error:       # a wrong bit anywhere, or another kind of file
        raise ValueError(f'{what}: this is no file of `marine_tracker train gwnn`, or it is '
                         'damaged') from error
    if not isinstance(manifest, dict) or 'format' not in manifest:
        raise ValueError(f'{what}: this is no file of `marine_tracker train gwnn`')
    if manifest['format'] != FORMAT:
        raise ValueError(f'{what} has format {manifest["format"]}; this version reads '
                         f'{FORMAT}: train anew')
    wanted = {f'{name}_{array}' for name in NETWORKS for array in ARRAYS}
    if set(arrays) != wanted:
        odd = ', '.join(sorted(set(arrays) ^ wanted))
        raise ValueError(f'{what} does not hold the right arrays: {odd}')
    if checksum(arrays) != manifest.get('checksum'):
        raise ValueError(f'{what} is damaged: the checksum does not match')
    networks = [_network(name, arrays, manifest['layouts'][name], inputs, outputs[name], what)
                for name in NETWORKS]
    return Weights(networks[0], networks[1], manifest)


def _network(name, arrays, layout, inputs, outputs, what) -> Network:
    form = Layout(int(layout[0]), int(layout[1]), float(layout[2]), int(layout[3]), *layout[4:])
    group = group_size(form)
    shapes = {'centre': (inputs,), 'scale': (inputs,), 'inner': (inputs + 1, outputs * group),
              'outer': (outputs, group), 'bias': (outputs,)}
    found = []
    for array in ARRAYS:
        values = arrays[f'{name}_{array}'].astype(np.float32)
        if values.shape != shapes[array]:
            raise ValueError(f'{what} belongs to another network: {name}_{array} has shape '
                             f'{values.shape}; it must be {shapes[array]}')
        if not np.isfinite(values).all():
            raise ValueError(f'{what}: {name}_{array} holds values that are not finite')
        found.append(values)
    return Network._make([*found, form])
