"""The trained weights of `gwnn`: one file that describes itself and detects damage."""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..files import shortened, shown
from . import weight_file
from .wavelet_network import Layout, Network, group_size, units
from .weight_file import FOLDER

FORMAT = 1
ARRAYS = ('centre', 'scale', 'inner', 'outer', 'bias')
NETWORKS = ('fusion', 'spread')


class Weights(NamedTuple):
    """fusion: weights and corrects the experts; spread: the uncertainty of the result.

    manifest: how the weights were made, for people; not used. All arrays are float32: half the
    time, at a cost of about a micrometre.
    """

    fusion: Network
    spread: Network
    manifest: dict[str, Any]


def shipped(vessel_class: str) -> Path:
    """The file of weights that comes with the package for a vessel class."""
    return FOLDER / f'gwnn_{vessel_class}.npz'


def _arrays(weights: Weights) -> dict[str, NDArray[np.float32]]:
    return {
        f'{name}_{array}': np.asarray(getattr(getattr(weights, name), array), np.float32)
        for name in NETWORKS
        for array in ARRAYS
    }


def save(path: str | Path, weights: Weights) -> dict[str, Any]:
    """Writes the file; returns its manifest with format, layouts and checksum."""
    arrays = _arrays(weights)
    manifest = {
        **weights.manifest,
        'format': FORMAT,
        'checksum': weight_file.checksum(arrays),
        'layouts': {name: list(getattr(weights, name).layout) for name in NETWORKS},
    }
    weight_file.write(path, arrays, manifest)
    return manifest


def load(path: str | Path, inputs: int, outputs: dict[str, int]) -> Weights:
    """Reads a file of weights for networks with `inputs` inputs, and with the number of outputs by
    network.

    Raises ValueError if the file cannot be read, is damaged, or belongs to other networks.
    """
    what = f'GWNN weights {shortened(path)}'
    names = [f'{name}_{array}' for name in NETWORKS for array in ARRAYS]
    arrays, manifest = weight_file.read(path, 'GWNN', 'marine_tracker train gwnn', FORMAT, names)
    layouts = [_layout(manifest, name, what) for name in NETWORKS]
    networks = [
        _network(name, arrays, layout, inputs, outputs[name], what)
        for name, layout in zip(NETWORKS, layouts)
    ]
    return Weights(networks[0], networks[1], manifest)


def _layout(manifest: dict[str, Any], name: str, what: str) -> Layout:
    layouts = manifest.get('layouts')
    given = layouts.get(name) if isinstance(layouts, dict) else None
    try:
        levels, translations, q, outputs, *kind = given  # type: ignore[misc]
        return Layout(int(levels), int(translations), float(q), int(outputs), *kind)
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(f'{what}: the layout of {name} is {shown(given)}: {error}') from error


def _network(
    name: str, arrays: dict[str, NDArray[Any]], form: Layout, inputs: int, outputs: int, what: str
) -> Network:
    group = group_size(form)
    shapes = {
        'centre': (inputs,),
        'scale': (inputs,),
        'inner': (inputs + 1, outputs * group),
        'outer': (outputs, group),
        'bias': (outputs,),
    }
    found = [
        weight_file.checked(
            arrays[f'{name}_{array}'].astype(np.float32), f'{name}_{array}', shapes[array], what
        )
        for array in ARRAYS
    ]
    try:
        units(form)
    except (TypeError, ValueError, ArithmeticError) as error:
        raise ValueError(f'{what}: the layout of {name} is {shown(form)}: {error}') from error
    return Network._make([*found, form])
