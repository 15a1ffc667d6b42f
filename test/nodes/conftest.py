"""Nodes over real DDS: a domain of our own, nodes in this process, nodes as processes."""

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

os.environ['ROS_PYTHON_CHECK_FIELDS'] = '1'  # before any message is imported

import pytest

from marine_tracker.processes import end_with_parent

HERE = Path(__file__).resolve().parent
CHECKOUT = HERE.parents[1]
PATIENCE = 60.0  # s, for what takes one second when idle


def pytest_collection_modifyitems(items):
    """What runs in real time is marked, to be run by itself (Makefile)."""
    for item in items:
        if HERE in item.path.parents:
            item.add_marker(pytest.mark.nodes)


@pytest.fixture(scope='session', autouse=True)
def domain():
    """A ROS domain that nobody else on this machine uses."""
    pytest.importorskip('rclpy', reason='no rclpy: the nodes are not tested')
    from marine_tracker.nodes import domain as domains

    os.environ.setdefault('AMENT_PREFIX_PATH', sys.prefix)
    with contextlib.ExitStack() as stack:
        try:
            from domain_coordinator import domain_id
        except ModuleNotFoundError:
            domain_id = domains.free_domain
        number = stack.enter_context(domain_id())
        domains.set_local(os.environ, number)
        yield number


def wait_until(condition, patience=PATIENCE):
    """Poll until the condition holds, and return what it gave."""
    until = time.monotonic() + patience
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > until:
            raise AssertionError(f'not so within {patience:g} s: {condition.__doc__ or condition}')
        time.sleep(0.004)


class Graph:
    """Nodes of one test in this process: own context, an executor in a thread."""

    def __init__(self):
        import rclpy
        from rclpy.context import Context
        from rclpy.executors import SingleThreadedExecutor

        self.context = Context()
        rclpy.init(
            context=self.context, signal_handler_options=rclpy.signals.SignalHandlerOptions.NO
        )
        self.executor = SingleThreadedExecutor(context=self.context)
        self.nodes, self.errors = [], []
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._spin, daemon=True)

    def _spin(self):
        from rclpy.exceptions import InvalidHandle

        while not self._stop.is_set():
            try:
                self.executor.spin_once(timeout_sec=0.1)
            except InvalidHandle:
                continue  # of what a test took away while rclpy looked at it
            except Exception as error:
                self.errors.append(error)

    def add(self, node):
        self.nodes.append(node)
        self.executor.add_node(node)
        if not self._thread.is_alive():
            self._thread.start()
        return node

    def make(self, kind, arguments=(), **parameters):
        """A node of this package with parameters and ROS arguments."""
        from rclpy.parameter import Parameter

        return self.add(
            kind(
                context=self.context,
                cli_args=['--ros-args', *arguments] if arguments else None,
                parameter_overrides=[
                    Parameter(name, value=value) for name, value in parameters.items()
                ],
            )
        )

    def bystander(self, name='bystander', namespace=''):
        """A plain node to publish and listen with."""
        from rclpy.node import Node

        return self.add(Node(name, namespace=namespace, context=self.context))

    def close(self):
        self._stop.set()
        self.executor.wake()
        if self._thread.ident is not None:
            self._thread.join(20)
            assert not self._thread.is_alive()
        self.executor.shutdown()
        for node in self.nodes:
            node.destroy_node()
        self.context.try_shutdown()
        assert not self.errors, self.errors


@pytest.fixture
def graph(domain):
    graph = Graph()
    yield graph
    graph.close()


class Listener:
    """Copies of all messages of a topic, in order."""

    def __init__(self, node, kind, topic, quality=400):
        self.messages = []
        self.subscription = node.create_subscription(kind, topic, self.messages.append, quality)

    def __len__(self):
        return len(self.messages)

    def __getitem__(self, index):
        return self.messages[index]

    @property
    def connected(self):
        return self.subscription.get_publisher_count() > 0


class Process:
    """A node as a process of its own."""

    def __init__(self, folder, module, arguments, prefix=()):
        self.log = folder / f'{module.split()[-1]}_{time.monotonic_ns()}.log'
        with open(self.log, 'wb') as log:
            self.process = subprocess.Popen(
                [*prefix, sys.executable, '-m', *f'marine_tracker.{module}'.split(), *arguments],
                cwd=CHECKOUT,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                env={**os.environ, 'PYTHONUNBUFFERED': '1'},
                preexec_fn=end_with_parent,
            )

    @property
    def said(self):
        return self.log.read_text(errors='replace')

    def says(self, text):
        """Wait until it has written the text."""
        return wait_until(lambda: text in self.said or self.process.poll() is not None) and (
            text in self.said
        )

    def send(self, number):
        self.process.send_signal(number)

    def ends(self):
        """Its exit code, waited for."""
        return self.process.wait(PATIENCE)

    def stop(self, number=signal.SIGINT):
        """Signal it, and what it says on the way must be its exit code 0."""
        self.send(number)
        assert self.ends() == 0, self.said


@pytest.fixture
def launch(domain, tmp_path):
    """launch('nodes.run tracker', '--ros-args', ...) -> Process; whatever still runs is ended.

    prefix: the words of a command that runs it.
    """
    processes = []

    def start(module, *arguments, prefix=()):
        processes.append(Process(tmp_path, module, arguments, prefix))
        return processes[-1]

    yield start
    for one in processes:
        if one.process.poll() is None:
            one.process.kill()
            one.process.wait()


@pytest.fixture
def private_hosts(tmp_path):
    """private_hosts(text) -> words that run a command where this is /etc/hosts, for it alone."""

    def prefix(text):
        if subprocess.run(['unshare', '-m', 'true'], capture_output=True).returncode:
            pytest.skip('no mount namespace of our own: unshare -m fails here')
        file = tmp_path / 'hosts'
        file.write_text(text + '\n')
        script = 'mount --bind "$0" /etc/hosts && exec "$@"'
        return ['unshare', '-m', 'sh', '-c', script, str(file)]

    return prefix


@pytest.fixture
def node_helpers():
    """wait_until and Listener, for test modules cannot import a conftest by name."""
    return wait_until, Listener
