"""The main function of all nodes: start, spin, stop.

`rclpy.spin` with rclpy's own signal handlers may hang on SIGTERM or exit with 1. Here the handlers
only set an event. The loop ends within its time-out, and everything is closed in order. The
handlers are set before any large import, so a signal during the start ends the node as well. A node
that has not closed 10 s after the signal is ended, whatever it is doing (processes.py).

Exit codes, in doc/nodes.md for users:

0   stopped as requested, or nothing left to do; closed in order
1   could not start, with one line on stderr; or failed, with a traceback or a warning on stderr
14  not closed in time; stderr shows where each thread was
The signal itself (-2, -15; 130, 143 in a shell), or 1 for SIGINT, if it came while Python itself
was starting, before the first line here.
"""

import importlib
import os
import signal
import sys
import threading
from collections.abc import Callable
from types import FrameType
from typing import Any, NoReturn

from ..processes import closing, end_in_time, keep_freed_memory, leave
from . import arguments, log_folder

NODES = {
    'tracker': 'TrackerNode',
    'radar_simulator': 'RadarSimulatorNode',
    'plot_extractor': 'PlotExtractorNode',
    'recording_player': 'RecordingPlayerNode',
    'nmea_output': 'NmeaOutputNode',
    'ppi_display': 'PpiDisplayNode',
    'recorder': 'RecorderNode',
    'ais_input': 'AisInputNode',
}
LONGEST = 600  # characters of why a node cannot start
ASKED = (signal.SIGINT, signal.SIGTERM)


def on_signals(handler: Callable[[int, FrameType | None], Any] | signal.Handlers) -> None:
    """From now on this handler handles SIGINT and SIGTERM."""
    for number in ASKED:
        signal.signal(number, handler)


def run(name: str) -> int:
    """Runs a node of NODES until it is done, or until SIGINT or SIGTERM comes.

    The node is the class that NODES names, in the module `NAME_node`.

    Returns the exit code, 0 or 1; see the module.
    """
    code = arguments.answer(name, sys.argv[1:])
    if code is not None:
        return code
    on_signals(lambda *_: os._exit(0))  # nothing is open yet; imports take long on a busy machine
    end_in_time()
    # ament uses this to find packages. A virtual environment is a prefix like any other.
    os.environ.setdefault('AMENT_PREFIX_PATH', sys.prefix)
    log_folder.provide()
    import rclpy
    from rclpy.exceptions import NameValidationException, ParameterException
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.impl.implementation_singleton import rclpy_implementation as implementation
    from rclpy.signals import SignalHandlerOptions

    from .diagnostics import one_line

    keep_freed_memory()
    make_node = getattr(importlib.import_module(f'.{name}_node', __package__), NODES[name])
    stop = threading.Event()

    def on_signal(*_):
        closing()
        stop.set()

    on_signals(on_signal)
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
        print(f'{name}: {one_line(error, LONGEST)}', file=sys.stderr, flush=True)
        rclpy.try_shutdown()
        return 1
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        while not stop.is_set() and not node.done:
            executor.spin_once(timeout_sec=0.1)
        closing()
        node.close()
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
    on_signals(signal.SIG_IGN)  # from here on no signal changes the exit code
    return 1 if node.done and node.failures.counts else 0


def main(name: str) -> NoReturn:
    """As `run`, and then this process ends."""
    leave(run(name))


# The executables. `python -m marine_tracker.nodes.run NAME --ros-args ...` runs the same.


def tracker() -> NoReturn:
    """The tracker."""
    main('tracker')


def radar_simulator() -> NoReturn:
    """The radar simulator."""
    main('radar_simulator')


def plot_extractor() -> NoReturn:
    """The plot extractor."""
    main('plot_extractor')


def recording_player() -> NoReturn:
    """The recording player."""
    main('recording_player')


def nmea_output() -> NoReturn:
    """The NMEA output."""
    main('nmea_output')


def ais_input() -> NoReturn:
    """The AIS input."""
    main('ais_input')


def ppi_display() -> NoReturn:
    """The PPI."""
    main('ppi_display')


def recorder() -> NoReturn:
    """The recorder."""
    main('recorder')


if __name__ == '__main__':
    main(sys.argv.pop(1))
