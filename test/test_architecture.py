"""Dependencies point one way, and only nodes/ knows ROS."""

import ast
from pathlib import Path

import pytest

import marine_tracker

PACKAGE = Path(marine_tracker.__file__).resolve().parent

# What each part of the package may import of the others: the table of doc/architecture.md.
BASE = {
    'types',
    'geometry',
    'geodesy',
    'parameters',
    'config',
    'processes',
    'files',
    'yaml_file',
    'tables',
    'm1371',
}
CORE = BASE | {'gaussian', 'networks', 'estimators', 'tracking', 'extent'}
SOURCES = {'simulation', 'recording', 'video'}
SERVICE = CORE | {'arpa', 'ais', 'service'}
MAY_IMPORT = {
    'config': set(),
    'types': set(),
    'geometry': {'types'},
    'geodesy': {'types', 'geometry'},
    'files': set(),
    'yaml_file': {'files'},
    'tables': {'files', 'types'},
    'parameters': {'files'},
    'm1371': {'types', 'geometry'},
    'processes': set(),
    'parameter_files': BASE,
    'simulation': BASE,
    'recording': BASE,
    'video': BASE,
    'gaussian': BASE,
    'networks': BASE,
    'estimators': BASE | {'gaussian', 'networks'},
    'tracking': BASE | {'gaussian', 'networks', 'estimators'},
    'extent': BASE | {'gaussian', 'networks', 'estimators'},
    'arpa': CORE,
    'ais': CORE | {'arpa'},
    'service': CORE | {'arpa', 'ais'},
    'evaluation': SERVICE | SOURCES,
    'conformance': SERVICE | SOURCES | {'evaluation'},
    'training': SERVICE | SOURCES | {'evaluation'},
    'lab': SERVICE | SOURCES | {'evaluation', 'conformance', 'training'},
    'display': SERVICE,
    'nodes': SERVICE | SOURCES | {'display', 'parameter_files'},
    'commands': SERVICE
    | SOURCES
    | {'display', 'evaluation', 'conformance', 'training', 'lab', 'nodes', 'parameter_files'},
    'cli': {'commands', 'processes'},
    '__main__': {'cli'},
    '__init__': SERVICE,
}
# Of the lab, whoever is outside sees the register of experiments only.
LAB = 'marine_tracker.lab.registry'
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
            base = home[: len(home) - node.level + 1] if node.level else ()
            base += (node.module,) if node.module else ()
            yield from ('.'.join((*base, alias.name)) for alias in node.names)


def is_ros(name):
    top = name.split('.')[0]
    return top in {
        'rclpy',
        'rosgraph_msgs',
        'rosidl_runtime_py',
        'rpyutils',
        'ament_index_python',
        'tf2_ros',
    } or top.endswith(('_msgs', '_srvs', '_interfaces'))


@pytest.mark.parametrize('file', MODULES, ids=lambda f: str(f.relative_to(PACKAGE)))
def test_imports_follow_the_architecture(file):
    part = part_of(file)
    assert part in MAY_IMPORT, f'{part} has no place in the architecture yet: give it one here'
    for name in imports(file, file.read_text()):
        top, *rest = name.split('.')
        if top == 'marine_tracker' and rest:
            assert rest[0] == part or rest[0] in MAY_IMPORT[part], f'{part} imports {name}'
            assert rest[0] != 'lab' or part == 'lab' or name.startswith(LAB), (
                f'{part} imports {name}; only the lab sees its own insides'
            )
        if is_ros(name):
            assert part == 'nodes', f'{part} imports {name}; only nodes/ may import ROS packages'


def test_no_part_depends_on_itself_through_others():
    def below(part, seen=()):
        assert part not in seen, ' -> '.join((*seen, part))
        for other in MAY_IMPORT.get(part, ()):
            below(other, (*seen, part))

    for part in MAY_IMPORT:
        below(part)


def test_only_the_service_puts_extents_tracker_and_arpa_together():
    """Whoever else made one of them, or took its step, would run something else than is shipped."""
    for file in MODULES:
        for node in ast.walk(ast.parse(file.read_text())):
            if not isinstance(node, ast.Call) or file.name == 'service.py':
                continue
            called = node.func
            name = called.id if isinstance(called, ast.Name) else getattr(called, 'attr', '')
            assert name not in ('Tracker', 'Extents', 'Arpa'), f'{file}, line {node.lineno}'
            if name == 'step' and isinstance(called, ast.Attribute):
                owner = ast.unparse(called.value).split('.')[-1].strip('_')
                parts = ('tracker', 'arpa', 'extents', 'ais')
                assert owner not in parts, f'{file}, line {node.lineno}'


def longest(file, name):
    """Lines of the longest function of that name."""
    return max(
        node.end_lineno - node.lineno + 1
        for node in ast.walk(ast.parse((PACKAGE / file).read_text()))
        if isinstance(node, ast.FunctionDef) and node.name == name
    )


@pytest.mark.parametrize(
    ('file', 'most'), [('tracking/tracker.py', 60), ('arpa/arpa.py', 50), ('service.py', 40)]
)
def test_the_main_steps_read_as_a_page(file, most):
    assert longest(file, 'step') <= most


def lines_of(files):
    return sum(len(file.read_text().splitlines()) for file in files)


def test_no_room_holds_more_than_a_fifth_of_the_package():
    whole = lines_of(MODULES)
    rooms = {part_of(file) for file in MODULES if file.parent != PACKAGE}
    share = {room: lines_of((PACKAGE / room).rglob('*.py')) / whole for room in rooms}
    assert max(share.values()) <= 0.2, share


def test_no_file_is_longer_than_a_few_screens():
    long = {str(file.relative_to(PACKAGE)): lines_of([file]) for file in MODULES}
    assert max(long.values()) <= 350, max(long, key=long.get)


def test_modules_import_each_other_in_one_direction():
    """No circle, within the parts either."""
    names = {
        '.'.join(('marine_tracker', *file.relative_to(PACKAGE).with_suffix('').parts)): file
        for file in MODULES
    }
    below = {}
    for name, file in names.items():
        full = set(imports(file, file.read_text()))
        below[name] = {
            other
            for other in names
            if other != name and (other in full or any(one.startswith(other + '.') for one in full))
        }

    def walk(name, path):
        assert name not in path, ' -> '.join((*path, name))
        if name not in done:
            for other in below[name]:
                walk(other, (*path, name))
            done.add(name)

    done = set()
    for name in names:
        walk(name, ())


@pytest.mark.parametrize(
    ('line', 'expected'),
    [
        ('import rclpy.node', ['rclpy.node']),
        ('from ..types import Scan', ['marine_tracker.types.Scan']),
        ('from . import gate', ['marine_tracker.tracking.gate']),
        ('from .. import geometry', ['marine_tracker.geometry']),
        ('def f():\n    from ..nodes.run import main', ['marine_tracker.nodes.run.main']),
    ],
)
def test_every_form_of_import_is_seen(line, expected):
    assert list(imports(PACKAGE / 'tracking' / 'gate.py', line)) == expected
