"""config/*.yaml and doc/parameters.md, written from the dataclasses of parameters/.

`python -m marine_tracker.parameter_files` writes them into the source tree.
"""

import dataclasses
import json
import textwrap
from pathlib import Path
from typing import Any

from . import yaml_file
from .files import write_text
from .parameters import NODES

COMMAND = 'python -m marine_tracker.parameter_files'


def fields(node: str) -> list[dataclasses.Field[Any]]:
    """All parameters of a node."""
    return [field for kind in NODES[node] for field in dataclasses.fields(kind)]


def limits(field: dataclasses.Field[Any]) -> str:
    """The values a parameter may take, in words; '' when any will do."""
    about = field.metadata
    if about['choices']:
        return 'one of ' + ', '.join(about['choices'])
    if about['low'] is None and about['high'] is None:
        return ''
    if about['high'] is None:
        return f'at least {about["low"]:g}'
    if about['low'] is None:
        return f'at most {about["high"]:g}'
    return f'{about["low"]:g} to {about["high"]:g}'


def yaml_value(value: Any) -> str:
    """A parameter's value as YAML that every reader takes for the same type."""
    if isinstance(value, str):
        # Not null, and none of the words that YAML 1.1, which ROS reads, takes for a bool.
        word = value.isidentifier() and value.lower() not in ('y', 'n', 'yes', 'no', 'on', 'off')
        plain = word and yaml_file.parse(value, '') == value
        return value if plain else json.dumps(value)
    return json.dumps(value)


def node_yaml(node: str) -> str:
    """The parameter file of a node: every parameter at its default, described above it."""
    lines = [
        f'# Parameters of the node `{node}` at their defaults. Written by',
        f'# `{COMMAND}`.',
        '# What comes last on the command line counts: write -p NAME:=VALUE after --params-file.',
        '/**:',
        '  ros__parameters:',
    ]
    for field in fields(node):
        facts = [
            part
            for part in (
                f'unit {field.metadata["unit"]}' if field.metadata['unit'] else '',
                limits(field),
                'may change while running' if field.metadata['live'] else '',
            )
            if part
        ]
        text = field.metadata['text'] + (f' ({"; ".join(facts)})' if facts else '')
        lines += textwrap.wrap(text, 96, initial_indent='    # ', subsequent_indent='    #   ')
        lines.append(f'    {field.name}: {yaml_value(field.default)}')
    return '\n'.join(lines) + '\n'


def document() -> str:
    """doc/parameters.md: one table for each node."""
    lines = [
        '# Parameters',
        '',
        f'Written by `{COMMAND}`; do not edit by hand.',
        '',
        'A node refuses to start on an unknown, mistyped or out-of-range parameter and names',
        'it. A double is written with its point (`15.0`, not `15`). Those marked live may',
        'change while the node runs; no track is lost by it.',
    ]
    for node in NODES:
        lines += [
            '',
            f'## {node}',
            '',
            '| name | default | unit | limits | live | meaning |',
            '|---|---|---|---|---|---|',
        ]
        for field in fields(node):
            about = field.metadata
            cells = (
                f'`{field.name}`',
                f'`{yaml_value(field.default)}`',
                about['unit'],
                limits(field),
                'live' if about['live'] else '',
                about['text'],
            )
            lines.append('| ' + ' | '.join(cells) + ' |')
    return '\n'.join(lines) + '\n'


def files() -> dict[str, str]:
    """Every file that derives from the dataclasses: path in the source tree and text."""
    written = {f'config/{node}.yaml': node_yaml(node) for node in NODES}
    written['doc/parameters.md'] = document()
    return written


def main() -> None:
    """Write the files into the source tree this module stands in."""
    root = Path(__file__).resolve().parents[1]
    for name, text in files().items():
        path = root / name
        path.parent.mkdir(exist_ok=True)
        write_text(path, text)


if __name__ == '__main__':
    main()
