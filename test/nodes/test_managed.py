"""Tracker and display as lifecycle nodes: nothing happens before they are activated."""

import pytest

pytest.importorskip('rclpy')
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rcl_interfaces.srv import GetParameters
from std_srvs.srv import Trigger

from marine_tracker.nodes import topics
from marine_tracker.nodes.tracker_node import TrackerNode


@pytest.fixture
def bring_up(graph, node_helpers):
    """A managed tracker, and whoever manages it."""
    wait, listener = node_helpers
    node = graph.make(TrackerNode, managed=True)
    other = graph.bystander('lifecycle_manager')

    def call(kind, name, request=None):
        client = other.create_client(kind, f'tracker/{name}')
        wait(client.service_is_ready)
        future = client.call_async(request or kind.Request())
        wait(future.done)
        return future.result()

    def change(transition):
        return call(
            ChangeState, 'change_state', ChangeState.Request(transition=Transition(id=transition))
        ).success

    return node, other, call, change, wait, listener


def test_a_managed_tracker_works_only_while_it_is_active(bring_up):
    from diagnostic_msgs.msg import DiagnosticArray

    node, other, call, change, wait, listener = bring_up
    health = listener(other, DiagnosticArray, topics.DIAGNOSTICS)
    assert call(GetState, 'get_state').current_state.label == 'unconfigured'
    answer = call(Trigger, 'cancel_all')
    assert not answer.success and answer.message == 'the node is not active'
    assert call(GetParameters, 'get_parameters', GetParameters.Request(names=['estimator'])).values
    assert not change(Transition.TRANSITION_ACTIVATE)  # not configured yet
    assert change(Transition.TRANSITION_CONFIGURE) and change(Transition.TRANSITION_ACTIVATE)
    assert call(GetState, 'get_state').current_state.label == 'active'
    wait(lambda: len(health))
    assert call(Trigger, 'cancel_all').message == '0 targets cancelled'
    assert change(Transition.TRANSITION_DEACTIVATE)
    assert node.idle and not call(Trigger, 'cancel_all').success
    assert change(Transition.TRANSITION_ACTIVATE) and call(Trigger, 'cancel_all').success


def test_a_managed_display_waits_in_its_process(launch, graph, node_helpers):
    wait, _ = node_helpers
    process = launch(
        'nodes.run ppi_display', '--ros-args', '-p', 'managed:=true', '-p', 'address:=127.0.0.1:0'
    )
    assert process.says('ppi_display: http'), process.said
    other = graph.bystander('lifecycle_manager')
    client = other.create_client(GetState, 'ppi_display/get_state')
    wait(client.service_is_ready)
    future = client.call_async(GetState.Request())
    wait(future.done)
    assert future.result().current_state.label == 'unconfigured'
    process.stop()
