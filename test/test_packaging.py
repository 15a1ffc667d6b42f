"""What pip and colcon read says the same thing everywhere, and installs all that is needed."""

import ast
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
from importlib.metadata import Distribution
from pathlib import Path

import pytest
from ruamel.yaml import YAML

import marine_tracker

ROOT = Path(marine_tracker.__file__).resolve().parents[1]
MANIFEST = ET.parse(ROOT / 'package.xml').getroot()

# Distribution on PyPI -> key of rosdep. Wheels of ROS packages stand for ROS packages.
ROSDEP_KEY = {
    'aiohttp': 'python3-aiohttp',
    'hypothesis': 'python3-hypothesis',
    'mcap': 'python3-mcap',
    'mcap-ros2-support': 'python3-mcap-ros2-support',
    'numpy': 'python3-numpy',
    'psutil': 'python3-psutil',
    'pyais': 'python3-pyais',
    'pynmea2': 'python3-pynmea2',
    'pyproj': 'python3-pyproj',
    'pytest': 'python3-pytest',
    'pytest-timeout': 'python3-pytest-timeout',
    'PyWavelets': 'python3-pywavelets',
    'rich': 'python3-rich',
    'ruamel.yaml': 'python3-ruamel.yaml',
    'rosbags': 'python3-rosbags-pip',
    'ros-jazzy-domain-coordinator': 'domain_coordinator',
    'scipy': 'python3-scipy',
    'setuptools': 'python3-setuptools',
}


def read_yaml(name):
    return YAML(typ='safe', pure=True).load((ROOT / name).read_text())


def manifest(tag):
    return {element.text for element in MANIFEST.findall(tag)}


@pytest.fixture(scope='module')
def installed(tmp_path_factory):
    """A prefix into which the package was installed with the commands that colcon uses."""
    folder = tmp_path_factory.mktemp('packaging')
    source = folder / 'source'
    shutil.copytree(
        ROOT,
        source,
        ignore=shutil.ignore_patterns(
            '.*',
            'node_modules',
            '__pycache__',
            '*.egg-info',
            'build',
            'install',
            'log',
            'test',
            'tracks.csv',
        ),
    )
    run = subprocess.run(
        [
            sys.executable,
            '-W',
            'ignore',
            'setup.py',
            '-q',
            'egg_info',
            '--egg-base',
            folder,
            'build',
            '--build-base',
            folder / 'build',
            'install',
            '--prefix',
            folder / 'prefix',
            '--single-version-externally-managed',
            '--record',
            folder / 'record.txt',
        ],
        cwd=source,
        capture_output=True,
        text=True,
        timeout=100,
    )
    assert run.returncode == 0, run.stderr
    return folder / 'prefix'


@pytest.fixture(scope='module')
def distribution(installed):
    """What setup.py tells pip."""
    return Distribution.at(next(installed.rglob('*.egg-info')))


@pytest.fixture(scope='module')
def requirements(distribution):
    """Required distributions by extra; '' for those always required."""
    by_extra = {}
    for line in distribution.requires:
        name = re.match(r'[\w.-]+', line).group()
        extra = re.search(r'extra == .(\w+).', line)
        by_extra.setdefault(extra.group(1) if extra else '', set()).add(name)
    return by_extra


def test_version_is_the_same_everywhere(distribution):
    version = MANIFEST.findtext('version')
    latest = re.search(r'^(\d+\.\d+\.\d+) \(', (ROOT / 'CHANGELOG.rst').read_text(), re.M)
    cited = read_yaml('CITATION.cff')['version']
    assert distribution.version == version == latest.group(1) == cited


def test_requirements_of_setup_py_and_package_xml_agree(requirements):
    # A requirement that is not in ROSDEP_KEY needs its rosdep key there.
    def keys(names):
        return {ROSDEP_KEY[name] for name in names}

    # With pip display and recordings are extras; ROS packages have none.
    assert keys(requirements[''] | requirements['display'] | requirements['record']) == {
        key for key in manifest('exec_depend') if key.startswith('python3-')
    }
    assert keys(requirements['test']) == manifest('test_depend')


def test_ros_is_never_required_by_pip_outside_the_extra(requirements):
    assert not [name for name in requirements[''] if name.startswith('ros-')]
    assert {'ros-jazzy-rclpy', 'ros-jazzy-common-interfaces'} <= requirements['ros']


def test_every_ros_package_imported_is_in_package_xml():
    imported = set()
    for file in (ROOT / 'marine_tracker').rglob('*.py'):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.ImportFrom) and not node.level:
                imported.add(node.module.split('.')[0])
            elif isinstance(node, ast.Import):
                imported |= {alias.name.split('.')[0] for alias in node.names}
    ros = {
        name
        for name in imported
        if name == 'rclpy' or name.endswith(('_msgs', '_srvs', '_interfaces'))
    }
    assert ros == {key for key in manifest('exec_depend') if not key.startswith('python3-')}


def test_every_rosdep_key_of_our_own_has_a_rule_for_debian_and_ubuntu():
    rules = read_yaml('rosdep.yaml')
    lacking = {'python3-mcap', 'python3-mcap-ros2-support', 'python3-pyais', 'python3-pywavelets'}
    assert set(rules) == lacking <= manifest('exec_depend')
    assert all({'debian', 'ubuntu'} <= set(rule) for rule in rules.values())


def test_all_configuration_is_installed(installed):
    shipped = {
        file.relative_to(ROOT)
        for folder in ('config', 'launch', 'layouts')
        for file in (ROOT / folder).rglob('*')
        if file.is_file()
    }
    share = installed / 'share' / 'marine_tracker'
    assert shipped
    assert {file.relative_to(share) for file in share.rglob('*') if file.is_file()} == (
        shipped | {Path('package.xml')}
    )


def test_all_of_the_package_is_installed(installed):
    site = next(installed.rglob('site-packages'))
    source = {
        file.relative_to(ROOT)
        for file in (ROOT / 'marine_tracker').rglob('*')
        if file.is_file() and '__pycache__' not in file.parts
    }
    assert source <= {file.relative_to(site) for file in site.rglob('*')}
    assert not (site / 'test').exists()


def test_package_is_in_the_ament_index(installed):
    index = installed / 'share' / 'ament_index' / 'resource_index' / 'packages'
    assert (index / 'marine_tracker').is_file()
    assert MANIFEST.findtext('export/build_type') == 'ament_python'


def test_executables_stand_where_ros2_run_looks(installed, distribution):
    folder = installed / 'lib' / 'marine_tracker'
    names = {
        'ais_input',
        'marine_tracker',
        'nmea_output',
        'plot_extractor',
        'ppi_display',
        'radar_simulator',
        'recorder',
        'recording_player',
        'tracker',
    }
    assert {entry.name for entry in distribution.entry_points} == names
    assert {file.name for file in folder.iterdir() if os.access(file, os.X_OK)} == names


def test_executables_have_something_to_run(distribution):
    pytest.importorskip('rclpy')
    for entry in distribution.entry_points:
        assert callable(entry.load()), entry
