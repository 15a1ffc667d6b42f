"""A tracker node in this process over real DDS, and all that it takes to feed it and to listen."""

import asyncio
import json

import numpy as np
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped
from nav_msgs.msg import Odometry
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import UInt32
from std_srvs.srv import SetBool, Trigger

from marine_tracker.geometry import NAUTICAL_MILE, own_ship_at, unit_vector
from marine_tracker.nodes import convert, topics
from marine_tracker.nodes.tracker_node import TrackerNode
from marine_tracker.parameters import TrackerParameters, from_mapping
from marine_tracker.service import Service
from marine_tracker.simulation import radar, scenario
from marine_tracker.types import Scan, take

EPOCH_NS = 1_700_000_000 * 1_000_000_000  # stamps as a real radar has them


@pytest.fixture(scope='module')
def clean():
    """The scenario's first 40 scans and its tracker parameters."""
    chosen = scenario.load('clean')
    scans = [scan for (scan, _), _ in zip(radar.simulate(chosen, 3), range(40))]
    return scans, from_mapping(TrackerParameters, chosen.tracker_parameters())


class Rig:
    """A tracker node, a radar and an own ship to feed it with, and ears for what it says."""

    def __init__(self, graph, node_helpers, sea, namespace='', **parameters):
        self.wait, self._listener = node_helpers
        self.scans, self.parameters, *_ = sea
        given = {
            name: getattr(self.parameters, name)
            for name in ('range_sigma_m', 'bearing_sigma_deg', 'max_range_m')
        }
        self.tracker = graph.make(
            TrackerNode,
            ('-r', f'__ns:=/{namespace}') if namespace else (),
            **{**given, **parameters},
        )
        self.other = graph.bystander(namespace=namespace)
        self.radar = self.other.create_publisher(PointCloud2, topics.PLOTS, topics.reliable(50))
        self.own_ship = self.other.create_publisher(Odometry, topics.ODOMETRY, topics.reliable(500))
        self.targets = self._listener(
            self.other, DiagnosticArray, topics.TARGETS, topics.latched(50)
        )
        self.wait(
            lambda: (
                self.radar.get_subscription_count()
                and self.own_ship.get_subscription_count()
                and self.targets.connected
            )
        )
        self.shift_ns = EPOCH_NS
        self.odometry = convert.own_ship_to_odometry  # a message of stamp, position, velocity

    # -- in ------------------------------------------------------------------------------------

    def stamp(self, seconds):
        return self.shift_ns + round(seconds * 1e9)

    def send_own_ship(self, time, position, velocity):
        self.own_ship.publish(self.odometry(self.stamp(time), position, velocity))

    def send_own_ship_of(self, scans):
        """Own ship at the ends of the scans, waited for."""
        for scan in scans:
            before = self.tracker._samples
            self.send_own_ship(scan.end, *own_ship_at(scan.own_ship, scan.end))
            self.wait(lambda before=before: self.tracker._samples > before)

    def send(self, scans):
        """Scans one by one, each waited for."""
        for scan in scans:
            before = len(self.targets)
            self.radar.publish(convert.plots_to_cloud(scan, self.stamp(scan.start)))
            self.wait(lambda before=before: len(self.targets) > before)

    def play(self, scans):
        for scan in scans:
            self.send_own_ship_of([scan])
            self.send([scan])

    def set(self, **values):
        """Parameters changed by the node's service, all at once; its answers."""
        client = self.client(SetParameters, f'{self.tracker.get_name()}/set_parameters')
        return self.call(
            client,
            SetParameters.Request(
                parameters=[
                    Parameter(name, value=value).to_parameter_msg()
                    for name, value in values.items()
                ]
            ),
        ).results

    def client(self, kind, name):
        client = self.other.create_client(kind, name)
        self.wait(client.service_is_ready)
        return client

    def call(self, client, request):
        future = client.call_async(request)
        self.wait(future.done)
        return future.result()

    # -- out -----------------------------------------------------------------------------------

    def listen(self, kind, topic, quality=400):
        ears = self._listener(self.other, kind, topic, quality)
        self.wait(lambda: ears.connected)
        # The publisher has to know us, too: it does not speak to an empty room.
        self.wait(lambda: self.tracker.count_subscribers(ears.subscription.topic_name))
        return ears

    def names(self):
        return [entry.name for entry in self.targets[-1].status]

    def told(self, reason):
        """How often the tracker has counted this."""
        return (self.tracker.inputs[0].bad.counts + self.tracker.bad_own_ship.counts)[reason]

    def rows(self):
        """The last targets as dicts by name, with `status` and `level`."""
        last = self.targets[-1].status if len(self.targets) else ()
        return {
            entry.name: {
                'status': entry.message,
                'level': entry.level,
                **{pair.key: pair.value for pair in entry.values},
            }
            for entry in last
        }


@pytest.fixture
def rig(graph, node_helpers, clean):
    """rig(**parameters): a Rig that sails the scenario `clean`."""
    return lambda **parameters: Rig(graph, node_helpers, clean, **parameters)


class Bridge(Rig):
    """A Rig with an operator: hears alarms and diagnostics, and gives commands."""

    def __init__(self, graph, node_helpers, sea, **parameters):
        super().__init__(graph, node_helpers, sea, **parameters)
        self._truth = sea[2]
        self.alarms = self.listen(DiagnosticArray, topics.ALARMS, topics.latched(100))
        self._played = 0
        self._commands = {}

    def sail(self, count):
        """The next scans."""
        for scan in self.scans[self._played : self._played + count]:
            self._played += 1
            self.play([scan])

    def sail_on(self, condition, patience=60):
        """Scan by scan until the condition holds; how many it took."""
        for k in range(patience):
            if condition():
                return k
            self.sail(1)
        raise AssertionError(f'not so within {patience} scans')

    def place(self, ship):
        """Where the scenario's ship (1 ...) is after the scan that was played last: east, north."""
        truth = self._truth[self._played - 1]
        return truth.position[truth.target == ship][0]

    def name_of(self, ship, within=400.0):
        """The target that shows where the scenario's ship is; None where there is none."""
        own, _ = own_ship_at(self.last.own_ship, self.last.end)
        away = {
            name: np.hypot(
                *(
                    own
                    + float(row['range_nm'])
                    * NAUTICAL_MILE
                    * unit_vector(np.radians(float(row['bearing_deg'])))
                    - self.place(ship)
                )
            )
            for name, row in self.rows().items()
            if row['status'] != 'LOST'
        }
        near = [name for name in away if away[name] < within]
        return near[0] if near else None

    def without(self, ship, count, within=300.0):
        """The next scans, without any plot near the scenario's ship."""
        for _ in range(count):
            scan = self.scans[self._played]
            self._played += 1
            off = np.hypot(*(convert.plots_positions(scan) - self.place(ship)).T)
            self.play([scan._replace(plots=take(scan.plots, off > within))])

    @property
    def last(self):
        """The scan that was played last."""
        return self.scans[self._played - 1]

    def say(self, kind, topic, message):
        """Publish a command, and wait until the node has it in its queue or beyond."""
        if topic not in self._commands:
            publisher = self.other.create_publisher(kind, topic, topics.reliable())
            self.wait(publisher.get_subscription_count)
            self._commands[topic] = publisher
        self._commands[topic].publish(message)

    def click(self, east, north, frame='map', topic=topics.ACQUIRE):
        """A point to acquire; waited for, taken or refused."""
        point = PointStamped()
        point.header.frame_id = frame
        point.point.x, point.point.y = float(east), float(north)
        before = self.heard_clicks()
        self.say(PointStamped, topic, point)
        self.wait(lambda: self.heard_clicks() > before)

    def heard_clicks(self):
        operator = self.tracker._operator
        return len(operator.memory.arpa.acquisition.clicks.since) + operator.refused.counts.total()

    def cancel(self, number):
        operator = self.tracker._operator
        before, refused = (
            len(operator.memory.arpa.acquisition.targets.id),
            operator.refused.counts.total(),
        )
        self.say(UInt32, topics.CANCEL, UInt32(data=number))
        self.wait(
            lambda: (
                len(operator.memory.arpa.acquisition.targets.id) < before
                or operator.refused.counts.total() > refused
            )
        )

    def acknowledge_target(self, number):
        self.say(UInt32, topics.ACKNOWLEDGE_TARGET, UInt32(data=number))

    def ask(self, service):
        """Call a Trigger service; what it answers."""
        answer = self.call(self.client(Trigger, service), Trigger.Request())
        assert answer.success
        return answer.message

    def trial(self, on):
        answer = self.call(self.client(SetBool, topics.TRIAL_MANOEUVRE), SetBool.Request(data=on))
        assert answer.success
        return answer.message

    def refused(self):
        return self.tracker._operator.refused.counts.total()

    def standing(self):
        """The alarms of the last message as state by name."""
        if not len(self.alarms):
            return {}
        return {entry.name: self.about(entry)['state'] for entry in self.alarms[-1].status}

    def about(self, entry):
        return {pair.key: pair.value for pair in entry.values}

    def alarm(self, name):
        """Entry of the last message on `alarms`."""
        return next(entry for entry in self.alarms[-1].status if entry.name == name)

    def awaits(self, name, state):
        """Wait until the last message on `alarms` has this alarm in this state."""
        self.wait(lambda: self.standing().get(name) == state)

    def told_of(self, kind):
        """States that alarms of this kind went through, by name, repetitions left out."""
        seen = {}
        for message in self.alarms.messages:
            for entry in message.status:
                about = self.about(entry)
                states = seen.setdefault(entry.name, [])
                if about['kind'] == kind and states[-1:] != [about['state']]:
                    states.append(about['state'])
        return {name: states for name, states in seen.items() if states}


@pytest.fixture(scope='session')
def simulated():
    """simulated(ships, seconds, own speed in kn): scans, tracker parameters and truths.

    ships: (range NM, bearing deg, course deg, speed kn), numbered from 1. Own ship goes north.
    Clear weather: every ship shows in every scan, and nothing else.
    """

    def make(ships, seconds, own_speed=10):
        built = scenario.build(
            {
                'duration_s': seconds,
                'own_ship': {'course_deg': 0, 'speed_kn': own_speed},
                'radar': {
                    'max_range_nm': 6,
                    'range_sigma_m': 10,
                    'bearing_sigma_deg': 0.3,
                    'pd_near': 1,
                    'pd_far': 1,
                },
                'targets': [
                    {
                        'start': {'range_nm': away, 'bearing_deg': bearing},
                        'speed_kn': speed,
                        'course_deg': course,
                    }
                    for away, bearing, course, speed in ships
                ],
            },
            'sea',
        )
        scans, truths = zip(*radar.simulate(built, 1))
        return scans, from_mapping(TrackerParameters, built.tracker_parameters()), truths

    return make


@pytest.fixture
def bridge(graph, node_helpers):
    """bridge(sea, **parameters): a Bridge that sails the scans of `simulated`."""
    return lambda sea, **parameters: Bridge(graph, node_helpers, sea, **parameters)


@pytest.fixture
def core():
    """core(scans, heading, node): the pure core's picture after each scan that a node has had."""

    def run(scans, heading, node):
        base = (node._base_ns - EPOCH_NS) * 1e-9  # the node's times begin there
        running = node._operator.service
        service = Service(running.tracker.parameters, running.arpa.parameters)
        memory = service.start()
        for scan in scans:
            scan = Scan(
                scan.start - base,
                scan.end - base,
                scan.plots._replace(time=scan.plots.time - base),
                scan.own_ship._replace(time=scan.own_ship.time - base),
            )
            memory, output = service.step(memory, scan, heading)
            yield output.picture

    return run


class Viewer:
    """A viewer's connection: the newest message of each kind, and answers to commands."""

    def __init__(self, link):
        self.link, self.newest, self.answers = link, {}, []

    async def until(self, condition, patience=60):
        async def read():
            while not condition(self):
                heard = json.loads((await self.link.receive()).data)
                self.newest[heard['kind']] = heard
                if heard['kind'] == 'answer':
                    self.answers.append(heard)

        await asyncio.wait_for(read(), patience)

    async def command(self, command, /, **values):
        count = len(self.answers)
        await self.link.send_json({'command': command, **values})
        await self.until(lambda me: len(me.answers) > count)
        return self.answers[-1]


@pytest.fixture(scope='session')
def look():
    return looked


def looked(display, act, token='pass'):
    """Run act(viewer) with a connection to the display."""

    async def run():
        base = display.server.url.split('#')[0]
        import aiohttp  # of the extra `display`

        async with aiohttp.ClientSession() as session, session.ws_connect(base + 'live') as link:
            viewer = Viewer(link)
            await link.send_json({'command': 'login', 'token': token})
            await viewer.until(lambda me: 'role' in me.newest)
            return await act(viewer)

    return asyncio.run(run())


@pytest.fixture
def display(graph, node_helpers):
    """display(tracker rig, **parameters): a PPI that hears it, and is heard."""
    from marine_tracker.nodes.ppi_display_node import PpiDisplayNode

    wait, _ = node_helpers
    made = []

    def make(here, **parameters):
        node = graph.make(PpiDisplayNode, address='127.0.0.1:0', token='pass', **parameters)
        made.append(node)
        for topic in (topics.TARGETS_CLOUD, topics.ALARMS, topics.ACQUIRE, topics.CANCEL):
            wait(
                lambda topic=topic: (
                    here.tracker.count_publishers(topic) and (node.count_subscribers(topic))
                )
            )
        wait(lambda: here.tracker._output._to_numeric.get_subscription_count())
        wait(lambda: here.own_ship.get_subscription_count() > 1)
        wait(lambda: here.radar.get_subscription_count() > 1)
        return node

    yield make
    for node in made:
        node.close()
