"""The executable `nmea_output`; the node is in nmea_output_node.py."""

import sys

from .run import run


def main() -> int:
    """Run the node; the exit code."""
    return run('nmea_output', 'NmeaOutputNode')


if __name__ == '__main__':
    sys.exit(main())
