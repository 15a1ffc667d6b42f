"""The executable `recording_player`; the node is in recording_player_node.py."""

import sys

from .run import run


def main() -> int:
    """Run the node; the exit code."""
    return run('recording_player', 'RecordingPlayerNode')


if __name__ == '__main__':
    sys.exit(main())
