"""Messages of other packages, generated from their field lists by ROS's own generators.

radar_msgs and marine_sensor_msgs are in no registry of Python packages. Their types are made here
in an environment of its own, from wheels, and the tests that need them run with them. Skipped where
a compiler, CMake, or the wheels are missing.
"""

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

pytest.importorskip('rclpy')

HERE = Path(__file__).resolve().parent
TOOLS = [tool for tool in ('cmake', 'ninja', 'g++') if shutil.which(tool) is None]
pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(900),
    pytest.mark.skipif(bool(TOOLS), reason=f'not installed: {", ".join(TOOLS)}'),
]

WHEELS = [
    *(f'ros-jazzy-rosidl-{name}-generators' for name in ('core', 'default')),
    *('ros-jazzy-common-interfaces', 'ros-jazzy-ament-package', 'ros-jazzy-domain-coordinator'),
    *('ros-jazzy-fastrtps-cmake-module', 'ros-jazzy-python-cmake-module', 'ros-jazzy-ament-cmake'),
    *(
        f'ros-jazzy-ament-cmake-{name}'
        for name in (
            *('core', 'export-dependencies', 'export-libraries', 'export-targets', 'gen-version-h'),
            *('gmock', 'gtest', 'include-directories', 'pytest', 'python', 'ros'),
            'target-dependencies',
        )
    ),
    *('catkin-pkg', 'empy<4', 'numpy<2.3'),
]
BUILT_AT = '/opt/python/cp3{0}-cp3{0}'  # where the wheels were made; their CMake files name it

PACKAGES = {
    'radar_msgs': {
        'RadarReturn': """
            float32 range
            float32 azimuth
            float32 elevation
            float32 doppler_velocity
            float32 amplitude""",
        'RadarScan': """
            std_msgs/Header header
            RadarReturn[] returns""",
        'RadarTrack': """
            unique_identifier_msgs/UUID uuid
            geometry_msgs/Point position
            geometry_msgs/Vector3 velocity
            geometry_msgs/Vector3 acceleration
            geometry_msgs/Vector3 size
            uint16 classification
            float32[6] position_covariance
            float32[6] velocity_covariance
            float32[6] acceleration_covariance
            float32[6] size_covariance""",
        'RadarTracks': """
            std_msgs/Header header
            RadarTrack[] tracks""",
    },
    'marine_sensor_msgs': {
        'RadarEcho': """
            float32[] echoes""",
        'RadarSector': """
            std_msgs/Header header
            float32 angle_start
            float32 angle_increment
            builtin_interfaces/Duration time_increment
            builtin_interfaces/Duration scan_time
            float32 range_min
            float32 range_max
            RadarEcho[] intensities""",
    },
}
NEEDED = ('std_msgs', 'geometry_msgs', 'builtin_interfaces', 'unique_identifier_msgs')


def write_package(folder, name, messages):
    """The sources of an interface package."""
    (folder / 'msg').mkdir(parents=True)
    for message, fields in messages.items():
        text = '\n'.join(line.strip() for line in fields.strip().splitlines())
        (folder / 'msg' / f'{message}.msg').write_text(text + '\n')
    depends = ''.join(f'<depend>{one}</depend>' for one in NEEDED)
    (folder / 'package.xml').write_text(
        f'<package format="3"><name>{name}</name><version>1.0.0</version><description>of a test'
        '</description><maintainer email="test@marine-tracker.example">test</maintainer>'
        '<license>Apache-2.0</license><buildtool_depend>ament_cmake</buildtool_depend>'
        f'<buildtool_depend>rosidl_default_generators</buildtool_depend>{depends}'
        '<member_of_group>rosidl_interface_packages</member_of_group>'
        '<export><build_type>ament_cmake</build_type></export></package>\n'
    )
    files = ' '.join(f'msg/{message}.msg' for message in messages)
    (folder / 'CMakeLists.txt').write_text(
        f'cmake_minimum_required(VERSION 3.8)\nproject({name})\n'
        + ''.join(
            f'find_package({one} REQUIRED)\n'
            for one in ('ament_cmake', 'rosidl_default_generators', *NEEDED)
        )
        + f'rosidl_generate_interfaces(${{PROJECT_NAME}} {files} DEPENDENCIES {" ".join(NEEDED)})\n'
        'ament_package()\n'
    )


def moved(prefix):
    """The CMake files of the wheels, made to name this prefix."""
    was = BUILT_AT.format(sys.version_info.minor)
    version = f'python3.{sys.version_info.minor}'
    for file in (prefix / 'share').rglob('*.cmake'):
        text = file.read_text()
        if was in text:
            text = text.replace(f'{was}/include/{version}', sysconfig.get_path('include'))
            file.write_text(text.replace(was, str(prefix)))


@pytest.fixture(scope='module')
def generated(tmp_path_factory):
    """Environment variables with which the types are found."""
    folder = tmp_path_factory.mktemp('generated')
    prefix, installed = folder / 'wheels', folder / 'install'
    python = prefix / 'bin' / 'python'
    subprocess.run([sys.executable, '-m', 'venv', prefix], check=True)
    pip = subprocess.run(
        [python, '-m', 'pip', 'install', '-q', *WHEELS], capture_output=True, text=True
    )
    if pip.returncode:
        pytest.skip(f'the wheels cannot be installed: {pip.stderr.strip().splitlines()[-1]}')
    moved(prefix)
    path = f'{prefix}/bin:{os.environ["PATH"]}'
    environment = {**os.environ, 'PATH': path, 'AMENT_PREFIX_PATH': str(prefix), 'PYTHONPATH': ''}
    for name, messages in PACKAGES.items():
        write_package(folder / name, name, messages)
        build = folder / f'{name}_build'
        options = {
            'CMAKE_PREFIX_PATH': prefix,
            'CMAKE_INSTALL_PREFIX': installed,
            'Python3_EXECUTABLE': python,
            'BUILD_TESTING': 'OFF',
        }
        defined = [f'-D{key}={value}' for key, value in options.items()]
        for words in (
            ['cmake', '-S', folder / name, '-B', build, '-G', 'Ninja', *defined],
            ['cmake', '--build', build],
            ['cmake', '--install', build],
        ):
            run = subprocess.run(words, env=environment, capture_output=True, text=True)
            assert run.returncode == 0, run.stdout[-3000:] + run.stderr[-3000:]
    site = installed / 'lib' / f'python3.{sys.version_info.minor}' / 'site-packages'
    # The wheels of rclpy find their libraries by these variables, too.
    first = {
        'PYTHONPATH': site,
        'LD_LIBRARY_PATH': installed / 'lib',
        'AMENT_PREFIX_PATH': installed,
    }
    return {
        name: ':'.join(filter(None, [str(place), os.environ.get(name, '')]))
        for name, place in first.items()
    }


@pytest.mark.parametrize(
    'test',
    [
        'test_messages_of_others.py::test_radar_scans_come_in_and_radar_tracks_go_out_over_dds',
        'test_spokes.py::test_radar_sectors_become_plots_over_dds',
    ],
)
def test_the_types_as_generated_go_over_dds(generated, test):
    run = subprocess.run(
        [sys.executable, '-m', 'pytest', '-q', '-p', 'no:cacheprovider', str(HERE / test)],
        env={**os.environ, **generated},
        cwd=HERE.parents[1],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert run.returncode == 0 and '1 passed' in run.stdout, run.stdout[-3000:]
