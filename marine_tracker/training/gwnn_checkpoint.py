"""Checkpoints of the training of `gwnn`: one file, replaced as a whole."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from .. import yaml_file
from ..files import written
from ..networks import array_file, gwnn_weights
from ..networks import wavelet_network as net
from ..types import Array
from . import adam
from .gwnn_fusion import Training


def _arrays(training: Training) -> dict[str, Array]:
    """All arrays of a training, by name."""
    arrays = {name: getattr(training.network, name) for name in gwnn_weights.ARRAYS}
    for kind in ('mean', 'square'):
        for i, array in enumerate(getattr(training.moments, kind)):
            arrays[f'{kind}{i}'] = array
    return arrays | {
        'emphasis': training.emphasis,
        'size': training.size,
        'against': training.against,
    }


def save(path: Path, settings: dict[str, Any], training: Training) -> None:
    """Writes a checkpoint. If the process is stopped meanwhile, the previous file stays."""
    with written(path, 'wb') as file:
        np.savez(
            file,
            settings=np.array(json.dumps(settings)),
            steps=np.array(training.moments.steps),
            **_arrays(training),  # type: ignore[arg-type]
        )


def resume(path: Path, settings: dict[str, Any], layout: net.Layout) -> Training | None:
    """The training in a checkpoint; None if there is no such file.

    Raises ValueError if it is damaged, or if it belongs to another training, naming the difference.
    """
    if not path.exists():
        return None
    try:
        found = array_file.read(path)
        theirs = yaml_file.parse_json(str(found['settings']), 'settings')
        network = net.Network._make([*(found[name] for name in gwnn_weights.ARRAYS), layout])
        mean, square = ([found[f'{kind}{i}'] for i in range(3)] for kind in ('mean', 'square'))
        moments = adam.Moments(mean, square, int(found['steps']))
        training = Training(network, moments, found['emphasis'], found['size'], found['against'])
    except (ValueError, KeyError) as error:
        raise ValueError(f'checkpoint {path} is damaged: remove it') from error
    ours = json.loads(json.dumps(settings))
    differing = [
        f'{name} {theirs.get(name)}, not {ours[name]}'
        for name in ours
        if theirs.get(name) != ours[name]
    ]
    if differing:
        raise ValueError(
            f'checkpoint {path} is of another training ({"; ".join(differing)}); '
            'remove it, or train with its settings'
        )
    return training
