"""The options of a command that set the tracker's parameters."""

import math
from argparse import ArgumentParser, Namespace
from typing import Any

from .. import yaml_file
from ..estimators import ESTIMATORS
from ..evaluation.video_source import VideoOptions
from ..parameters import TrackerParameters, VideoParameters, from_mapping


def add_arguments(parser: ArgumentParser) -> None:
    """Adds --estimator, --parameters and --set."""
    parser.add_argument(
        '--estimator', choices=sorted(ESTIMATORS), help='filter to use (default: the shipped one)'
    )
    parser.add_argument(
        '--parameters',
        metavar='FILE.yaml',
        help="tracker parameters, as `name: value` lines or as a node's YAML",
    )
    parser.add_argument(
        '--set',
        metavar='NAME=VALUE',
        action='append',
        default=[],
        help='one tracker parameter; may be given more than once',
    )


def add_video_arguments(parser: ArgumentParser, heading: bool = True) -> None:
    """Adds --video and --heading, for sources of spokes."""
    parser.add_argument(
        '--video',
        metavar='NAME=VALUE',
        action='append',
        default=[],
        help='one parameter of the extraction of plots from spokes, as beam_width_deg=1.2',
    )
    if not heading:
        parser.set_defaults(heading=None)
        return
    parser.add_argument(
        '--heading',
        type=float,
        metavar='DEG',
        help="own ship's true heading, where spokes tell none",
    )


def video(args: Namespace) -> VideoOptions:
    """How plots are taken out of spokes."""
    heading = args.heading
    if heading is not None and not -360 <= heading <= 360:
        raise ValueError(f'--heading is {heading:g}; it must be between -360 and 360')
    return VideoOptions(
        from_mapping(VideoParameters, _assigned('--video', args.video)),
        None if heading is None else math.radians(heading),
    )


def parameters(args: Namespace, from_source: dict[str, Any]) -> TrackerParameters:
    """The parameters: defaults, then the source's, then --parameters, then --set, --estimator.

    Later ones replace earlier ones.
    """
    values = dict(from_source)
    if args.parameters:
        values.update(_read(args.parameters))
    values.update(_assigned('--set', args.set))
    if args.estimator:
        values['estimator'] = args.estimator
    return from_mapping(TrackerParameters, values)


def _assigned(option: str, texts: list[str]) -> dict[str, Any]:
    """The values of options NAME=VALUE."""
    values = {}
    for text in texts:
        name, equals, value = text.partition('=')
        if not equals:
            raise ValueError(f'{option} {text[:60]}: it must be NAME=VALUE')
        values[name.strip()] = yaml_file.parse(value, f'{option} {name.strip()}')
    return values


def _read(path) -> dict:
    """A flat mapping, or the `ros__parameters` of the tracker in a node's YAML."""
    values = yaml_file.read_mapping(path)
    of_nodes = {
        name: node['ros__parameters']
        for name, node in values.items()
        if isinstance(node, dict) and 'ros__parameters' in node
    }
    if not of_nodes:
        return values
    mine = [name for name in of_nodes if name.strip('/*').split('/')[-1] in ('', 'tracker')]
    if not mine:
        raise ValueError(
            f'{path} has no parameters of the tracker; it has those of {", ".join(of_nodes)}'
        )
    return {key: value for name in mine for key, value in (of_nodes[name] or {}).items()}
