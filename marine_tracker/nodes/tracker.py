"""The executable `tracker`; the node is in tracker_node.py."""

import sys

from .run import run


def main() -> int:
    """Run the node; the exit code."""
    return run('tracker', 'TrackerNode')


if __name__ == '__main__':
    sys.exit(main())
