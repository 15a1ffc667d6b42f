"""The one main of all nodes: start, spin, stop.

`rclpy.spin` with rclpy's own signal handlers may hang on SIGTERM or exit with 1. Here the
handlers only set an event; the loop ends within its time-out, and everything is closed in order.
They stand before anything large is imported: a signal during the start ends the node as well.
"""

import importlib
import os
import signal
import sys
import threading
import time

from ..processes import keep_freed_memory

NODES = {
    'tracker': 'TrackerNode',
    'radar_simulator': 'RadarSimulatorNode',
    'recording_player': 'RecordingPlayerNode',
    'nmea_output': 'NmeaOutputNode',
}
ASKED = (signal.SIGINT, signal.SIGTERM)
GRACE_S = 10.0  # to close in order, after a signal


def end_in_time(name: str, stop: threading.Event) -> None:
    """See to it that the process ends GRACE_S after a signal, whatever the middleware does.

    Once in some hundreds of signals a node was seen to hang in its shutdown. The signal's number
    comes through a pipe, so this holds even where the main thread never returns to Python.
    """
    read, write = os.pipe()
    os.set_blocking(write, False)
    signal.set_wakeup_fd(write)

    def watch():
        while os.read(read, 1)[0] not in ASKED:
            pass
        stop.set()
        time.sleep(GRACE_S)
        print(
            f'{name}: not closed within {GRACE_S:g} s of the signal, ended at once',
            file=sys.stderr,
            flush=True,
        )
        os._exit(0)

    threading.Thread(target=watch, daemon=True).start()


def run(name: str) -> int:
    """Run a node of NODES until it is done or SIGINT or SIGTERM comes.

    The node is the class that NODES names, in the module `NAME_node`.

    The exit code: 0 after a stop that was asked for, 1 with one line on stderr when the node
    cannot start.
    """
    stop = threading.Event()
    for number in ASKED:
        signal.signal(number, lambda *_: stop.set())
    end_in_time(name, stop)
    # ament looks packages up by this; a virtual environment is a prefix like any other.
    os.environ.setdefault('AMENT_PREFIX_PATH', sys.prefix)
    import rclpy
    from rclpy.exceptions import NameValidationException, ParameterException
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.impl.implementation_singleton import rclpy_implementation as implementation
    from rclpy.signals import SignalHandlerOptions

    keep_freed_memory()
    make_node = getattr(importlib.import_module(f'.{name}_node', __package__), NODES[name])
    try:
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        node = make_node()
    except (
        ValueError,
        OSError,
        ParameterException,
        NameValidationException,
        implementation.RCLError,
        implementation.UnknownROSArgsError,
        implementation.RCLInvalidROSArgsError,
    ) as error:
        print(f'{name}: {" ".join(str(error).split())}', file=sys.stderr, flush=True)
        rclpy.try_shutdown()
        return 1
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        while not stop.is_set() and not node.done:
            executor.spin_once(timeout_sec=0.1)
        node.close()
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
    return 0


# The executables. `python -m marine_tracker.nodes.run NAME --ros-args ...` runs the same.


def tracker() -> int:
    """The exit code of the tracker."""
    return run('tracker')


def radar_simulator() -> int:
    """The exit code of the radar simulator."""
    return run('radar_simulator')


def recording_player() -> int:
    """The exit code of the recording player."""
    return run('recording_player')


def nmea_output() -> int:
    """The exit code of the NMEA output."""
    return run('nmea_output')


if __name__ == '__main__':
    sys.exit(run(sys.argv.pop(1)))
