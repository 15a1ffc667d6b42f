"""No failing callback ends a node; every failure is counted, and told once."""

import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.clock import Clock, ClockType
from rclpy.parameter import Parameter
from std_msgs.msg import String, UInt32
from std_srvs.srv import Empty, Trigger

from marine_tracker.nodes import topics
from marine_tracker.nodes.base_node import RunnableNode
from marine_tracker.nodes.diagnostics import FAILED, LONGEST, one_line
from marine_tracker.nodes.operator import REFUSED


def recurse(depth=0):
    return recurse(depth + 1)


def fill_memory():
    return bytearray(1 << 62)


class Failing(RunnableNode):
    """Each of its callbacks fails in another way, until it is told to work."""

    def __init__(self, **arguments):
        super().__init__('failing', **arguments)
        self.works, self.heard, self.ticks, self.said = False, [], 0, []
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_subscription(String, 'words', self.hear, 10)
        self.subscription(String, 'more_words', self.hear, 10)
        self.create_timer(0.02, self.tick, clock=steady)
        self.create_service(Trigger, 'trigger', self.answer)
        self.create_service(Empty, 'empty', self.answer)
        self.declare_parameter('depth', 1)
        self.add_on_set_parameters_callback(self.judge)
        self.add_post_set_parameters_callback(self.change)
        self.watch(steady, 'failing', lambda: (DiagnosticStatus.OK, 'works', {'ticks': self.ticks}))

    def tell(self, reason, detail):
        self.said.append(reason)
        super().tell(reason, detail)

    def hear(self, message):
        self.works or recurse()
        self.heard.append(message.data)

    def tick(self):
        self.works or fill_memory()
        self.ticks += 1

    def answer(self, request, response):
        return response if self.works else {}['nothing']

    def judge(self, changed):
        from rcl_interfaces.msg import SetParametersResult

        self.works or recurse()
        return SetParametersResult(successful=True)

    def change(self, changed):
        raise OSError('x' * 100_000)


def call(node, wait, kind, name, request):
    client = node.create_client(kind, name)
    wait(client.service_is_ready)
    future = client.call_async(request)
    wait(future.done)
    return future.result()


def set_one(node, wait, name, parameter):
    request = SetParameters.Request(parameters=[parameter])
    return call(node, wait, SetParameters, f'{name}/set_parameters', request).results


def test_no_failing_callback_ends_a_node_and_each_kind_is_told_once(graph, node_helpers):
    wait, listener = node_helpers
    node, other = graph.make(Failing), graph.bystander()
    diagnostics = listener(other, DiagnosticArray, topics.DIAGNOSTICS)
    senders = [other.create_publisher(String, topic, 10) for topic in ('words', 'more_words')]
    wait(lambda: all(sender.get_subscription_count() for sender in senders))
    for sender in senders:
        sender.publish(String(data='lost'))
    answer = call(other, wait, Trigger, 'trigger', Trigger.Request())
    assert not answer.success and answer.message == "KeyError: 'nothing'"
    call(other, wait, Empty, 'empty', Empty.Request())
    depth = Parameter('depth', value=77).to_parameter_msg()
    (refused,) = set_one(other, wait, 'failing', depth)
    assert not refused.successful
    assert refused.reason.startswith('parameter depth: RecursionError: maximum recursion depth')
    assert node.get_parameter('depth').value == 1
    kinds = {
        f'{FAILED}: RecursionError in hear': 2,
        f'{FAILED}: MemoryError in tick': 3,
        f'{FAILED}: KeyError in answer': 2,
        f'{FAILED}: RecursionError in judge': 1,
    }
    wait(lambda: all(node.failures.counts[kind] >= count for kind, count in kinds.items()))
    assert sorted(node.said) == sorted(kinds)

    def told():
        return [entry for message in diagnostics.messages for entry in message.status]

    wait(lambda: any(entry.level == DiagnosticStatus.ERROR for entry in told()))
    wait(lambda: {pair.key for pair in told()[-1].values} == {'ticks', FAILED, *kinds})
    assert told()[-1].name == 'failing: failing' and told()[-1].hardware_id == 'failing'

    node.works = True
    senders[0].publish(String(data='heard'))
    wait(lambda: node.heard == ['heard'] and node.ticks)
    assert set_one(other, wait, 'failing', depth)[0].successful  # and what follows it fails
    wait(lambda: node.failures.counts[f'{FAILED}: OSError in change'] == 1)
    assert node.get_parameter('depth').value == 77


@pytest.mark.parametrize(
    ('module', 'parameters', 'says'),
    [
        ('tracker', (), 'waiting for'),
        ('radar_simulator', ('-p', 'scenario:=clean', '-p', 'loop:=true'), 'scenario clean'),
        ('nmea_output', ('-p', 'udp:=""'), 'no UDP'),
    ],
)
def test_a_parameter_of_a_type_that_does_not_exist_ends_no_node(
    launch, graph, node_helpers, module, parameters, says
):
    wait, _ = node_helpers
    other = graph.bystander()
    process = launch(f'nodes.run {module}', '--ros-args', *parameters)
    assert process.says(says), process.said
    for kind in (41, 200):
        wrong = ParameterMessage(name='use_sim_time', value=ParameterValue(type=kind))
        set_one(other, wait, module, wrong)
    request = GetParameters.Request(names=['use_sim_time', 'none.such'])
    call(other, wait, GetParameters, f'{module}/get_parameters', request)
    process.stop()
    assert process.said.count(f'{FAILED}: ValueError in _set_parameters_callback') == 1


def test_commands_refused_are_logged_once_and_then_counted(launch, graph, node_helpers):
    wait, listener = node_helpers
    other = graph.bystander()
    diagnostics = listener(other, DiagnosticArray, topics.DIAGNOSTICS)
    cancel = other.create_publisher(UInt32, topics.CANCEL, topics.reliable(50))
    process = launch('nodes.run tracker')
    wait(cancel.get_subscription_count)
    for number in range(500, 509):  # fewer than may wait
        cancel.publish(UInt32(data=number))

    def counted():
        return any(
            pair.key == REFUSED and pair.value == '9'
            for message in diagnostics.messages
            for entry in message.status
            for pair in entry.values
        )

    wait(counted)
    process.stop()
    assert process.said.count(REFUSED) == 1 and '500' in process.said and '501' not in process.said


def test_what_others_write_is_cut_to_one_printable_line():
    assert one_line('as it is: Öresund') == 'as it is: Öresund'
    assert one_line('two\nlines\t\x1b[31m\x00') == 'two lines [31m'
    for text in ('x' * 100_000, 'ä\n' * 60_000, '\udcff' * 5_000):
        line = one_line(text)
        assert len(line) < LONGEST + 50 and line.isprintable() and str(len(text)) in line
        line.encode()
    began = one_line('begin ' + 'y' * 4_000 + ' end')
    assert began.startswith('begin ') and began.endswith(' end')
