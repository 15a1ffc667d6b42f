"""What the tracker says to people and tools of ROS: logs, names of its own, the clock's fault."""

import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.msg import Log
from rosgraph_msgs.msg import Clock
from std_msgs.msg import UInt32
from std_srvs.srv import Trigger

from marine_tracker.nodes import topics

WARN, INFO = 30, 20
MEETING, BESIDE = (2.5, 5, 175, 11), (2, 95, 0, 9)


@pytest.fixture(scope='module')
def sea(simulated):
    """One ship that meets own ship, and one that goes along with her."""
    return simulated([MEETING, BESIDE], 400)


@pytest.fixture
def logs(graph, node_helpers):
    """Level and text of what is logged, by anybody in this test."""
    ears = node_helpers[1](graph.bystander('log_reader'), Log, '/rosout', topics.latched(1000))

    def said():
        return [(one.level, one.msg) for one in ears.messages]

    return said


def test_a_danger_is_logged_once_as_a_warning_and_a_loss_as_information(bridge, sea, logs):
    here = bridge(sea)
    here.sail_on(lambda: here.standing())
    name = here.name_of(1)
    here.sail(4)
    here.without(1, 12)
    dangers = [level for level, text in logs() if text.startswith(f'{name} dangerous')]
    losses = [level for level, text in logs() if text.startswith(f'{name} lost')]
    assert dangers == [WARN] and losses == [INFO]


def test_who_comes_late_is_told_the_alarms_that_stand_and_no_history(bridge, sea, node_helpers):
    here = bridge(sea)
    here.sail_on(lambda: here.standing())
    here.ask(topics.ACKNOWLEDGE)
    here.sail(1)
    assert len(here.alarms) > 1
    late = node_helpers[1](here.other, DiagnosticArray, topics.ALARMS, topics.latched(30))
    here.wait(lambda: len(late))
    here.sail(1)
    assert late[0] == here.alarms[-1] and len(late) == 1


def test_names_that_others_use_too_are_also_there_under_the_nodes_own(rig, clean):
    here = rig()
    private = here.listen(DiagnosticArray, f'tracker/{topics.TARGETS}', topics.latched(50))
    here.play(clean[0][:9])
    here.wait(lambda: len(private) == 9)
    assert private.messages == here.targets.messages
    cancel = here.other.create_publisher(UInt32, 'tracker/cancel', topics.reliable())
    here.wait(cancel.get_subscription_count)
    gone = int(here.names()[0].removeprefix('TT'))
    cancel.publish(UInt32(data=gone))
    here.wait(lambda: gone not in here.tracker._operator.memory.arpa.acquisition.targets.id)
    here.play(clean[0][9:10])
    here.wait(lambda: len(private) == 10)
    assert f'TT{gone:02d}' not in here.names()
    for service, said in (('acknowledge', '0 alerts acknowledged'), ('cancel_all', '5 targets')):
        client = here.client(Trigger, f'tracker/{service}')
        assert here.call(client, Trigger.Request()).message.startswith(said)


def test_plots_of_another_time_are_late_by_the_clock_and_the_cure_is_told(rig, clean):
    here = rig()
    health = here.listen(DiagnosticArray, topics.DIAGNOSTICS)

    def says(text):
        return any(text in one.message for message in health.messages for one in message.status)

    here.play(clean[0][:3])  # stamps of 2023
    here.wait(lambda: says('if they are of a recording, play its /clock and set use_sim_time'))
    clock = here.other.create_publisher(Clock, '/clock', 10)
    here.wait(lambda: here.tracker.count_publishers('/clock'))
    here.wait(lambda: says('/clock is published: set use_sim_time'))
    here.other.destroy_publisher(clock)


def test_a_change_of_parameters_is_named(rig, clean, logs):
    here = rig(estimator='imm')
    assert here.set(estimator='cs_kalman')[0].successful
    here.wait(lambda: (INFO, 'parameters changed: estimator imm -> cs_kalman') in logs())
    assert not here.set(estimator='none such')[0].successful
    assert here.set(range_sigma_m=21.5)[0].successful
    here.wait(lambda: any('range_sigma_m 10.0 -> 21.5' in text for _, text in logs()))
    assert not any('none such' in text for _, text in logs() if 'changed' in text)


def test_of_a_file_and_a_parameter_on_one_line_the_last_counts(launch, tmp_path):
    file = tmp_path / 'own.yaml'
    file.write_text('/**:\n  ros__parameters:\n    estimator: wavelet_cs\n')
    words = {
        'wavelet_cs': ('-p', 'estimator:=imm', '--params-file', str(file)),
        'imm': ('--params-file', str(file), '-p', 'estimator:=imm'),
    }
    for expected, arguments in words.items():
        process = launch('nodes.run tracker', '--ros-args', *arguments)
        assert process.says(f'estimator {expected}'), process.said
        process.stop()
