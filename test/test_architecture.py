"""Dependencies point one way, and only nodes/ knows ROS."""

import ast
from pathlib import Path

import pytest

import marine_tracker

PACKAGE = Path(marine_tracker.__file__).resolve().parent

# What each part of the package may import of the others: the table of doc/architecture.md.
BASE = {'types', 'geometry', 'parameters', 'config'}
CORE = BASE | {'networks', 'estimators', 'tracking', 'extent'}
MAY_IMPORT = {
    'config': set(),
    'types': set(),
    'geometry': {'types'},
    'parameters': set(),
    'heap': set(),
    'processes': set(),
    'parameter_files': BASE,
    'simulation': BASE,
    'recording': BASE,
    'networks': BASE,
    'estimators': BASE | {'networks'},
    'tracking': BASE | {'networks', 'estimators'},
    'extent': BASE | {'estimators'},
    'arpa': CORE,
    'evaluation': CORE | {'simulation', 'recording', 'arpa', 'heap', 'processes'},
    'display': CORE | {'arpa'},
    'nodes': CORE | {'simulation', 'recording', 'arpa', 'display', 'parameter_files', 'heap',
                        'processes'},
    'commands': CORE | {'simulation', 'recording', 'arpa', 'display', 'evaluation', 'nodes',
                        'parameter_files', 'heap', 'processes'},
    'cli': {'commands', 'processes'},
    '__main__': {'cli'},
    '__init__': set(),
}
MODULES = sorted(PACKAGE.rglob('*.py'))


def part_of(file):
    """The part of the package a file belongs to: its folder, or its own name at the top."""
    inside = file.relative_to(PACKAGE).with_suffix('')
    return inside.parts[0]


def imports(file, text):
    """Full dotted names of all that a file's text imports, at its top or inside functions."""
    home = ('marine_tracker', *file.relative_to(PACKAGE).parent.parts)
    for node in ast.walk(ast.parse(text, file)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = home[:len(home) - node.level + 1] if node.level else ()
            base += (node.module,) if node.module else ()
            yield from ('.'.join((*base, alias.name)) for alias in node.names)


def is_ros(name):
    top = name.split('.')[0]
    return (top in {'rclpy', 'rosgraph_msgs', 'rosidl_runtime_py', 'rpyutils', 'ament_index_python',
                    'tf2_ros'}
            or top.endswith(('_msgs', '_srvs', '_interfaces')))


@pytest.mark.parametrize('file', MODULES, ids=lambda f: str(f.relative_to(PACKAGE)))
def test_imports_follow_the_architecture(file):
    part = part_of(file)
    assert part in MAY_IMPORT, f'{part} has no place in the architecture yet: give it one here'
    for name in imports(file, file.read_text()):
        top, *rest = name.split('.')
        if top == 'marine_tracker' and rest:
            assert rest[0] == part or rest[0] in MAY_IMPORT[part], f'{part} imports {name}'
        if is_ros(name):
            assert part == 'nodes', f'{part} imports {name}; only nodes/ may import ROS packages'


def test_no_part_depends_on_itself_through_others():
    def below(part, seen=()):
        assert part not in seen, ' -> '.join((*seen, part))
        for other in MAY_IMPORT.get(part, ()):
            below(other, (*seen, part))
    for part in MAY_IMPORT:
        below(part)


@pytest.mark.parametrize(('line', 'expected'), [
    ('import rclpy.node', ['rclpy.node']),
    ('from ..types import Scan', ['marine_tracker.types.Scan']),
    ('from . import gate', ['marine_tracker.tracking.gate']),
    ('from .. import geometry', ['marine_tracker.geometry']),
    ('def f():\n    from ..nodes.run import main', ['marine_tracker.nodes.run.main']),
])
def test_every_form_of_import_is_seen(line, expected):
    assert list(imports(PACKAGE / 'tracking' / 'gate.py', line)) == expected
