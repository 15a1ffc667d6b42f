"""The package for pip and for colcon (ament_python)."""

import os

from setuptools import find_packages, setup

NAME = 'marine_tracker'


def tree(folder):
    """data_files entries that put a folder of the source, as it stands, under share/NAME."""
    for place, _, files in os.walk(folder):
        if files:
            yield f'share/{NAME}/{place}', [os.path.join(place, file) for file in sorted(files)]


setup(
    name=NAME,
    version='0.2.0',
    description='ARPA marine-radar tracking for ROS 2, with a radar simulator.',
    author='marine_tracker maintainers',
    maintainer='marine_tracker maintainers',
    maintainer_email='maintainers@marine-tracker.example',
    license='Apache-2.0',
    packages=find_packages(include=[NAME, f'{NAME}.*']),
    package_data={NAME: ['py.typed', 'networks/weights/*', 'display/static/*']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
        *tree('config'),
        *tree('launch'),
        *tree('layouts'),
    ],
    zip_safe=False,
    python_requires='>=3.11',
    install_requires=[
        'numpy>=1.26.4',
        'PyWavelets>=1.4',
        'pyais>=3.0',
        'pynmea2>=1.19',
        'pyproj>=3.4',
        'rich>=13.3',
        'ruamel.yaml>=0.17.21',
        'scipy>=1.11.4',
    ],
    extras_require={
        # On a machine with ROS 2 the system provides these: never in install_requires.
        'ros': ['ros-jazzy-rclpy[fastrtps]', 'ros-jazzy-common-interfaces'],
        'test': [
            'hypothesis>=6.98',
            'psutil>=5.9',
            'pytest>=7.4',
            'pytest-timeout>=2.2',
            'rosbags>=0.9.20',
            'ros-jazzy-domain-coordinator',
            'setuptools>=64',
        ],
        # The PPI in a browser: node ppi_display.
        'display': ['aiohttp>=3.9'],
        # The picture in a terminal: marine_tracker top.
        'top': ['textual>=1.0'],
        # Recordings of topics: node recorder, replay and score of MCAP files.
        'record': ['mcap>=1.6', 'mcap-ros2-support>=0.6'],
        # Targets on NMEA 2000: nmea_output with nmea2000_udp.
        'nmea2000': ['nmea2000>=2026.10'],
        'parallel': ['pytest-xdist>=3.3'],
        # Parts of experiments on other machines: --scheduler.
        'cluster': ['distributed>=2024.1', 'threadpoolctl>=3.1'],
        'bench': ['stonesoup>=1.4'],
        'plot': ['matplotlib>=3.6'],
        'dev': ['mypy>=1.8', 'pdoc>=14.5', 'pre-commit>=3.0', 'ruff>=0.4'],
    },
    entry_points={
        'console_scripts': [
            'marine_tracker = marine_tracker.cli:main',
            'ais_input = marine_tracker.nodes.run:ais_input',
            'nmea_output = marine_tracker.nodes.run:nmea_output',
            'plot_extractor = marine_tracker.nodes.run:plot_extractor',
            'ppi_display = marine_tracker.nodes.run:ppi_display',
            'recorder = marine_tracker.nodes.run:recorder',
            'radar_simulator = marine_tracker.nodes.run:radar_simulator',
            'recording_player = marine_tracker.nodes.run:recording_player',
            'tracker = marine_tracker.nodes.run:tracker',
        ]
    },
)
