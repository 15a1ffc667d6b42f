"""The trained networks of `cs_rough_nn` and `cs_bp_nn`: one file each, with their normalisation."""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..files import shortened
from ..types import Array
from . import weight_file
from .rough_network import Network, shapes

FORMAT = 1
NEURONS = {'rough': 2, 'bp': 1}  # neurons of a node, by kind of network
INPUTS, HIDDEN = 3, 6


class Quiet(NamedTuple):
    """Difference between the two filters by noise alone: the unit of the inputs.

    log_gamma  [G]        log of sigma_a1 T^2 / sigma_plot, ascending
    log_y      [Y]        log of alpha T, ascending
    variance   [G, Y, 3]  variance of d_i over s_i, while the target does not manoeuvre
    """

    log_gamma: Array
    log_y: Array
    variance: Array


NAMES = Network._fields + Quiet._fields  # of the arrays in a file


class Weights(NamedTuple):
    """manifest: how the weights were made, for people; not used."""

    network: Network
    quiet: Quiet
    manifest: dict[str, Any]


def shipped(kind: str) -> Path:
    """The file that comes with the package for a kind of network."""
    return weight_file.FOLDER / f'cs_{kind}_nn.npz'


def save(path: str | Path, weights: Weights) -> dict[str, Any]:
    """Writes the file; returns its manifest with format and checksum."""
    arrays = {
        name: np.asarray(array, np.float32)
        for part in (weights.network, weights.quiet)
        for name, array in part._asdict().items()
    }
    manifest = {**weights.manifest, 'format': FORMAT, 'checksum': weight_file.checksum(arrays)}
    weight_file.write(path, arrays, manifest)
    return manifest


def load(path: str | Path, kind: str) -> Weights:
    """Reads a file of weights of a `rough` or `bp` network.

    Raises ValueError if the file cannot be read, is damaged, or belongs to other networks.
    """
    what = f'rough network weights {shortened(path)}'
    arrays, manifest = weight_file.read(
        path, 'rough network', 'marine_tracker train rough_nn', FORMAT, NAMES
    )
    gammas, ys = arrays['log_gamma'].size, arrays['log_y'].size
    form = (*shapes(INPUTS, HIDDEN, NEURONS[kind]), (gammas,), (ys,), (gammas, ys, INPUTS))
    found = [
        weight_file.checked(arrays[name].astype(float), name, shape, what)
        for name, shape in zip(NAMES, form)
    ]
    parts = len(Network._fields)
    return Weights(Network._make(found[:parts]), Quiet._make(found[parts:]), manifest)
