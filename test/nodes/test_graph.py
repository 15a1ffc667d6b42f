"""What `doctor` finds on a graph of its own."""

import pytest

rclpy = pytest.importorskip('rclpy')

from marine_tracker.commands import doctor  # noqa: E402
from marine_tracker.nodes import domain, graph  # noqa: E402


@pytest.fixture(scope='module')
def own_domain():
    """A domain where nobody else is, set in the environment of this module's tests."""
    with pytest.MonkeyPatch.context() as patch, domain.free_domain() as number:
        environment: dict[str, str] = {}
        domain.set_local(environment, number)
        for name, value in environment.items():
            patch.setenv(name, value)
        yield number


@pytest.fixture
def publisher(own_domain):
    """A node `driver` that publishes plots and listens to tracks."""
    from nav_msgs.msg import Odometry
    from rclpy.context import Context
    from rclpy.signals import SignalHandlerOptions
    from sensor_msgs.msg import PointCloud2

    context = Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node('driver', context=context)
    node.create_publisher(PointCloud2, 'radar/plots', 10)
    node.create_subscription(Odometry, 'tracks', lambda _: None, 10)
    yield node
    node.destroy_node()
    context.try_shutdown()


def test_an_empty_graph_says_who_to_start(own_domain):
    checks = {check.name: check for check in doctor.examine(0.3)}
    assert checks['ROS middleware'].ok
    assert checks['nodes running'].found == 'none'
    plots = checks['/radar/plots']
    assert not plots.ok and not plots.required
    assert plots.found == 'no plots on /radar/plots' and plots.advice.startswith('start ')
    assert checks['/own_ship/odometry'].found == 'no own ship on /own_ship/odometry'
    assert checks['/tracks'].advice == 'start tracker'


def test_publishers_and_subscribers_are_counted(publisher):
    seen = graph.look(3.0, names=('radar/plots',))
    assert seen.topics == {'/radar/plots': (1, 0)}
    assert seen.nodes == ('/driver',) and seen.middleware.startswith('rmw_')
    assert graph.look(0.5, names=('radar/plots', 'tracks')).topics['/tracks'] == (0, 1)


def test_a_namespace_has_its_own_topics(publisher):
    seen = graph.look(0.3, namespace='/forward', names=('radar/plots',))
    assert seen.topics == {'/forward/radar/plots': (0, 0)}


def test_the_plots_of_every_radar_that_a_tracker_listens_to_are_looked_for(own_domain, publisher):
    from marine_tracker.nodes.tracker_node import TrackerNode

    tracker = TrackerNode(
        context=publisher.context,
        parameter_overrides=[
            rclpy.Parameter('radars', value='[{topic: radar/plots}, {topic: port/echoes}]')
        ],
    )
    try:
        checks = {check.name: check for check in doctor.examine(3.0)}
    finally:
        tracker.destroy_node()
    assert checks['/radar/plots'].found == '1 publish, 1 listen'
    echoes = checks['/port/echoes']
    assert echoes.found == 'no plots on /port/echoes' and echoes.advice.startswith('start radar')
    assert checks['/tracks'].ok and '/tracker' in checks['nodes running'].found


def test_a_middleware_that_does_not_start_is_told(command):
    done = command('doctor', RMW_IMPLEMENTATION='rmw_of_nobody')
    assert done.returncode == 0 and done.stderr == ''
    assert 'note   ROS middleware: does not start: ' in done.stdout
    assert 'check RMW_IMPLEMENTATION (rmw_of_nobody)' in done.stdout
