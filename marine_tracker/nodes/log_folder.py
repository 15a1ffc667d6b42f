"""A place for the logs of ROS, on machines where ROS finds none."""

import os
import tempfile
from collections.abc import MutableMapping


def provide(environment: MutableMapping[str, str] = os.environ) -> None:
    """Sets a folder for logs if ROS would find none, or none that can be written.

    ROS looks for ROS_LOG_DIR, then ROS_HOME/log, then HOME/.ros/log. A service or a container may
    have none of them. A folder set by ROS_LOG_DIR is not changed.
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
