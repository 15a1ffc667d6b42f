"""Where ROS writes its logs, on machines where it finds no place by itself."""

import os
import tempfile
from collections.abc import MutableMapping


def provide(environment: MutableMapping[str, str] = os.environ) -> None:
    """Name a folder for logs where ROS would find none, or none that can be written.

    ROS looks for ROS_LOG_DIR, then ROS_HOME/log, then HOME/.ros/log; a service or a container may
    have none of them. One that ROS_LOG_DIR names stays as it is.
    """
    if environment.get('ROS_LOG_DIR'):
        return
    home = environment.get('ROS_HOME')
    if not home and environment.get('HOME'):
        home = os.path.join(environment['HOME'], '.ros')
    if home and _writable(os.path.join(home, 'log')):
        return
    folder = os.path.join(tempfile.gettempdir(), f'marine_tracker_log_{os.getuid()}')
    if _writable(folder):
        environment['ROS_LOG_DIR'] = folder


def _writable(folder: str) -> bool:
    try:
        os.makedirs(folder, mode=0o700, exist_ok=True)
    except OSError:
        return False
    return os.access(folder, os.W_OK | os.X_OK)
