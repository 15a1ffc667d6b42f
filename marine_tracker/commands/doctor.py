"""Reports what is installed, what is missing, and what to do about it.

If ROS is there, it also listens for a few seconds: are plots, own ship and a tracker on the graph?
If a tracker runs, are there plots of each radar that it uses? The exit code is 0 if the core
(replay, score, bench, scenario) works, and 1 if something that the core requires is missing.
"""

import importlib
import json
import os
import subprocess
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator
from importlib import metadata
from importlib.util import find_spec
from typing import NamedTuple

from .. import config
from ..files import write_text

HELP = 'report what is installed, what is missing and what to do'

PYTHON = (3, 11)
START_S = 20.0  # for a middleware to start and stop on a slow machine
# Names to import, and the packages they come in.
REQUIRED = {
    'numpy': 'numpy',
    'scipy': 'scipy',
    'pywt': 'PyWavelets',
    'ruamel.yaml': 'ruamel.yaml',
    'rich': 'rich',
    'pynmea2': 'pynmea2',
    'pyproj': 'pyproj',
}
OPTIONAL = {
    'matplotlib': ('matplotlib', 'to draw plots'),
    'mcap_ros2': ('mcap-ros2-support', 'to record topics and read such recordings'),
    'stonesoup': ('stonesoup', 'bench compares with it'),
    'distributed': ('distributed', 'to run experiments on a cluster'),
    'textual': ('textual', 'the picture in a terminal: top'),
}
SHIPPED = ('tracker.yaml', 'scenarios', 'fastdds_local.xml')
PROFILE = 'FASTRTPS_DEFAULT_PROFILES_FILE'
MESSAGES = (
    'builtin_interfaces',
    'diagnostic_msgs',
    'geometry_msgs',
    'nav_msgs',
    'rosgraph_msgs',
    'sensor_msgs',
    'std_msgs',
    'std_srvs',
    'visualization_msgs',
)
INSTALL_ROS = (
    "in the source folder: pip install '.[ros]'; or where ROS 2 is installed: source "
    '/opt/ros/jazzy/setup.bash (only demo and the nodes need it)'
)
# What to start if nobody publishes a topic, by the end of its name. Plots may be on any other name.
PLOTS = 'plots', 'start radar_simulator, recording_player or a radar driver'
STARTERS = {
    'own_ship/odometry': (
        'own ship',
        'start what publishes own ship (radar_simulator and '
        'recording_player do), or the tracker takes it to be at rest',
    ),
    'tracks': ('tracker', 'start tracker'),
}


class Check(NamedTuple):
    """One line of the report.

    name      what was checked              found     what is there
    ok        whether that is right         required  whether the core needs it
    advice    what to do; '' if nothing
    """

    name: str
    ok: bool
    found: str
    advice: str = ''
    required: bool = False


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the command line of `doctor`."""
    parser.add_argument(
        '--listen',
        type=float,
        default=3.0,
        metavar='S',
        help='how long to listen on the ROS graph, s; 0: do not listen (default: 3)',
    )
    parser.add_argument('--namespace', default='/', help='of the radar to look for (default: /)')
    parser.add_argument(
        '--json', metavar='FILE', help='write the checks as JSON instead; - for standard output'
    )


def run(args: Namespace) -> int:
    """Prints the checks. Returns 0 if all required things are there, else 1."""
    if not 0 <= args.listen <= 60:
        raise ValueError(f'--listen is {args.listen:g} s; it must be between 0 and 60')
    checks = []
    for check in examine(args.listen, args.namespace):
        checks.append(check)
        if args.json != '-':
            print(line(check), flush=True)
    if args.json:
        text = json.dumps({'checks': [check._asdict() for check in checks]}, indent=1) + '\n'
        if args.json == '-':
            print(text, end='')
        else:
            write_text(args.json, text)
    return 1 if any(check.required and not check.ok for check in checks) else 0


def line(check: Check) -> str:
    """A check as a line of text."""
    mark = 'ok  ' if check.ok else 'MISS' if check.required else 'note'
    advice = f'\n{"":7}-> {check.advice}' if check.advice else ''
    return f'{mark}   {check.name}: {check.found}{advice}'


def examine(listen: float, namespace: str = '/') -> Iterator[Check]:
    """All checks. Those of the graph only if rclpy is there and `listen` s is above 0."""
    yield _python()
    for module, package in REQUIRED.items():
        yield _module(module, package, f'pip install {package}', required=True)
    for module, (package, use) in OPTIONAL.items():
        yield _module(module, package, f'pip install {package} ({use})', required=False)
    yield _configuration()
    yield from _environment()
    here = find_spec('rclpy') is not None  # not imported: a broken rclpy may end the process
    yield Check(
        'rclpy',
        here,
        _version('ros-jazzy-rclpy') if here else 'not installed',
        '' if here else INSTALL_ROS,
    )
    missing = [name for name in MESSAGES if find_spec(name) is None]
    yield Check(
        'ROS message packages',
        not missing,
        f'missing {", ".join(missing)}' if missing else f'all {len(MESSAGES)}',
        INSTALL_ROS if missing else '',
    )
    if here and not missing and listen > 0:
        yield from _graph(listen, namespace)


def _python() -> Check:
    found = '.'.join(map(str, sys.version_info[:3]))
    ok = sys.version_info >= PYTHON
    wanted = '.'.join(map(str, PYTHON))
    return Check(
        'Python',
        ok,
        f'{found}, {sys.executable}',
        '' if ok else f'install Python {wanted} or later',
        True,
    )


def _module(module: str, package: str, advice: str, *, required: bool) -> Check:
    try:
        importlib.import_module(module)
    except Exception as error:  # a broken installation may raise anything
        absent = isinstance(error, ModuleNotFoundError) and module.startswith(str(error.name))
        found = 'not installed' if absent else f'cannot be imported: {_words(error)}'
        return Check(package, False, found, advice, required)
    return Check(package, True, _version(package), '', required)


def _version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:  # not installed by pip
        return 'installed'


def _configuration() -> Check:
    again = 'install marine_tracker again'
    try:
        folder = config.path()
    except FileNotFoundError as error:
        return Check('configuration', False, _words(error), again, True)
    lacks = [name for name in SHIPPED if not (folder / name).exists()]
    if lacks:
        return Check('configuration', False, f'{folder} lacks {", ".join(lacks)}', again, True)
    return Check('configuration', True, str(folder), '', True)


def _environment() -> Iterator[Check]:
    profile = os.environ.get(PROFILE)
    if profile:
        there = os.path.isfile(profile)
        yield Check(
            'Fast DDS profile',
            there,
            profile if there else f'{profile} does not exist',
            '' if there else f'correct or unset {PROFILE}',
        )
    else:
        yield Check(
            'Fast DDS profile',
            True,
            f'{PROFILE} is not set: nodes started by hand may '
            'take 3 s to find each other (demo sets it)',
        )
    for name, otherwise in (
        ('ROS_DISTRO', 'not set: no ROS set-up file was sourced'),
        ('AMENT_PREFIX_PATH', f'not set: {sys.prefix} is used'),
        ('ROS_DOMAIN_ID', 'not set: domain 0 is used'),
    ):
        yield Check(name, True, os.environ.get(name) or otherwise)


def _graph(listen: float, namespace: str) -> Iterator[Check]:
    """The middleware, and whether plots, own ship and tracks are published."""
    try:
        listener = subprocess.run(
            [
                sys.executable,
                '-m',
                f'{__package__.rpartition(".")[0]}.nodes.graph',
                str(listen),
                namespace,
            ],
            capture_output=True,
            text=True,
            timeout=listen + START_S,
        )
        seen = json.loads(listener.stdout)
    except subprocess.TimeoutExpired:
        seen, why = None, f'no answer in {listen + START_S:g} s'
    except json.JSONDecodeError:
        seen, why = None, _last_line(listener.stderr) or f'exit code {listener.returncode}'
    if seen is None:
        yield Check(
            'ROS middleware',
            False,
            f'does not start: {why}',
            'set ROS_LOG_DIR to a folder that can be written'
            if 'logging' in why
            else f"pip install 'ros-jazzy-rclpy[fastrtps]'; check RMW_IMPLEMENTATION "
            f'({os.environ.get("RMW_IMPLEMENTATION") or "not set"}) and ROS_DOMAIN_ID',
        )
        return
    yield Check('ROS middleware', True, seen['middleware'])
    yield Check(
        'nodes running',
        bool(seen['nodes']),
        ', '.join(seen['nodes']) or 'none',
        '' if seen['nodes'] else 'try: marine_tracker demo',
    )
    for topic, (publishers, subscribers) in seen['topics'].items():
        what, start = next(
            (about for name, about in STARTERS.items() if topic.endswith(f'/{name}')), PLOTS
        )
        if publishers:
            yield Check(topic, True, f'{publishers} publish, {subscribers} listen')
        else:
            yield Check(topic, False, f'no {what} on {topic}', start)


def _last_line(text: str) -> str:
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[-1] if lines else ''


def _words(error: Exception) -> str:
    return ' '.join(str(error).split()) or type(error).__name__
