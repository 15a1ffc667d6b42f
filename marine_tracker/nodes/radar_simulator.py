"""The executable `radar_simulator`; the node is in radar_simulator_node.py."""

import sys

from .run import run


def main() -> int:
    """Run the node; the exit code."""
    return run('radar_simulator', 'RadarSimulatorNode')


if __name__ == '__main__':
    sys.exit(main())
