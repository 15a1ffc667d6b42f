"""The estimator `gwnn` in a running tracker, over DDS: what it says of itself, and weights that
go bad and good again."""

import re

import numpy as np
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from nav_msgs.msg import Odometry
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from sensor_msgs.msg import PointCloud2
from visualization_msgs.msg import MarkerArray

from marine_tracker.estimators import ESTIMATORS
from marine_tracker.estimators.gwnn import gwnn, monitor
from marine_tracker.geometry import own_ship_at
from marine_tracker.networks import gwnn_weights
from marine_tracker.nodes import convert, topics
from marine_tracker.nodes.tracker_node import FAILED
from marine_tracker.simulation import radar, scenario

EPOCH_NS = 1_700_000_000 * 10**9
TARGETS = [f'TT{n:02d}' for n in range(1, 7)]
WARM = 30  # scans until all targets are confirmed and warm


@pytest.fixture(scope='module')
def scans():
    """The scenario `clean`: six ships, seen in every scan, and nothing else."""
    return [scan for scan, _ in radar.simulate(scenario.load('clean'), 3)]


class Watch:
    """A tracker process that is fed scan by scan, and all that it publishes."""

    def __init__(self, graph, launch, node_helpers, scans, **parameters):
        self.wait, listener = node_helpers
        self.scans = iter(scans)
        # Dangers have a level of their own, which would hide that of a fallback.
        given = {**scenario.load('clean').tracker_parameters(), 'cpa_limit_nm': 0.01, **parameters}
        self.process = launch(
            'nodes.run tracker',
            '--ros-args',
            *(
                word
                for name, value in given.items()
                for word in ('-p', f'{name}:={float(value) if type(value) is int else value}')
            ),
        )
        self.node = graph.bystander()
        self.plots = self.node.create_publisher(PointCloud2, topics.PLOTS, topics.reliable())
        self.own_ship = self.node.create_publisher(Odometry, topics.ODOMETRY, topics.reliable())
        self.client = self.node.create_client(SetParameters, '/tracker/set_parameters')
        self.ears = {
            topic: listener(self.node, kind, topic, quality)
            for kind, topic, quality in (
                (Odometry, topics.TRACKS, topics.reliable(topics.BURST)),
                (Odometry, topics.EXTRAPOLATIONS, topics.reliable(topics.BURST)),
                (PointCloud2, topics.TRACKS_CLOUD, topics.reliable()),
                (DiagnosticArray, topics.TARGETS, topics.latched(50)),
                (MarkerArray, topics.MARKERS, topics.reliable()),
                (DiagnosticArray, topics.ALARMS, topics.latched(100)),
                (DiagnosticArray, topics.DIAGNOSTICS, topics.reliable()),
            )
        }
        self.targets = self.ears[topics.TARGETS]
        self.wait(
            lambda: (
                self.plots.get_subscription_count()
                and self.own_ship.get_subscription_count()
                and self.client.service_is_ready()
                and all(ear.connected for ear in self.ears.values())
            )
        )
        self.wait(lambda: len(self.ears[topics.DIAGNOSTICS]))

    def play(self, count):
        """The next scans, each waited for; the targets' values after each, by name.

        Where a bad network lets a track stray from the ship at anchor, a stationary object stands
        beside them, too.
        """
        heard = len(self.targets)
        for scan in (next(self.scans) for _ in range(count)):
            before = len(self.targets)
            end = EPOCH_NS + round(scan.end * 1e9)
            self.own_ship.publish(
                convert.own_ship_to_odometry(end, *own_ship_at(scan.own_ship, scan.end))
            )
            self.plots.publish(convert.plots_to_cloud(scan, EPOCH_NS + round(scan.start * 1e9)))
            self.wait(lambda before=before: len(self.targets) > before)
        return [
            {
                entry.name: {
                    'level': entry.level,
                    'message': entry.message,
                    **{pair.key: pair.value for pair in entry.values},
                }
                for entry in message.status
                if entry.name in TARGETS
            }
            for message in self.targets.messages[heard:]
        ]

    def set(self, name, value):
        """What the node answers to a change of a parameter."""
        future = self.client.call_async(
            SetParameters.Request(parameters=[Parameter(name, value=str(value)).to_parameter_msg()])
        )
        self.wait(future.done)
        return future.result().results[0]

    def tracking(self, key, value):
        """The entry `tracker: tracking` of /diagnostics, once it says so."""

        def said():
            entry = next(
                entry
                for entry in self.ears[topics.DIAGNOSTICS][-1].status
                if entry.name == 'tracker: tracking'
            )
            values = {pair.key: pair.value for pair in entry.values}
            return (entry, values) if values.get(key) == value else None

        return self.wait(said)

    def fallback_alarm(self, state):
        """The entry `fallback` of `alarms`, once it is in this state."""

        def said():
            entries = self.ears[topics.ALARMS][-1].status if len(self.ears[topics.ALARMS]) else ()
            return next(
                (
                    entry
                    for entry in entries
                    if entry.name == 'fallback' and state in (pair.value for pair in entry.values)
                ),
                None,
            )

        return self.wait(said)

    def check_numbers(self):
        """Everything published so far is made of numbers."""
        count = sum(one.name in TARGETS for told in self.targets.messages for one in told.status)
        for topic in (topics.TRACKS, topics.EXTRAPOLATIONS):
            self.wait(lambda topic=topic: len(self.ears[topic]) >= 0.95 * count)
            for message in self.ears[topic].messages:
                position, turned = message.pose.pose.position, message.pose.pose.orientation
                speed = message.twist.twist.linear
                assert np.isfinite([position.x, position.y, turned.z, turned.w, speed.x]).all()
                assert np.isfinite(message.pose.covariance).all()
                assert np.isfinite(message.twist.covariance).all()
        for message in self.ears[topics.TRACKS_CLOUD].messages:
            rows = np.frombuffer(message.data, convert.TRACK_TYPE)
            assert all(np.isfinite(rows[name]).all() for name in rows.dtype.names)
        for message in self.targets.messages:
            for pair in (pair for entry in message.status for pair in entry.values):
                assert pair.value not in ('nan', 'inf', '-inf'), pair.key
        for message in self.ears[topics.MARKERS].messages:
            points = [
                (p.x, p.y)
                for marker in message.markers
                for p in (*marker.points, marker.pose.position)
            ]
            assert np.isfinite(points).all()

    def end(self):
        self.process.stop()
        assert 'Traceback' not in self.process.said and 'Warning' not in self.process.said


@pytest.fixture
def watch(graph, launch, node_helpers, scans):
    def make(**parameters):
        return Watch(graph, launch, node_helpers, scans, **parameters)

    return make


def states(targets):
    return [values['estimator_state'] for values in targets.values()]


def random_network(network, scale, rng):
    return network._replace(
        **{
            array: scale * rng.normal(size=getattr(network, array).shape)
            for array in ('inner', 'outer', 'bias')
        }
    )


def bad_weights(how):
    """Weights of the right form that say nonsense."""
    good, rng = gwnn.weights(), np.random.default_rng(1)
    if how in ('random', 'huge'):
        scale = {'random': 3.0, 'huge': 1e37}[how]
        return good._replace(
            fusion=random_network(good.fusion, scale, rng),
            spread=random_network(good.spread, scale, rng),
        )
    outputs, by = {'off': (gwnn.AT_ONCE, 3.0), 'wrong way': (gwnn.OF_VELOCITY, 1e3)}[how]
    bias = good.fusion.bias.copy()
    bias[outputs] += by
    return good._replace(fusion=good.fusion._replace(bias=bias))


SLOW = pytest.mark.slow


@pytest.mark.parametrize(
    'how',
    ['random', 'off', pytest.param('huge', marks=SLOW), pytest.param('wrong way', marks=SLOW)],
)
def test_on_bad_weights_the_targets_fall_back_and_on_good_ones_they_return(watch, tmp_path, how):
    file = tmp_path / 'bad.npz'
    gwnn_weights.save(file, bad_weights(how))
    here = watch(estimator='gwnn')
    early = here.play(5)[-1]
    assert set(states(early)) == {'WARMUP'}
    assert {values['rho'] for values in early.values()} == {''}
    warm = here.play(WARM - 5)[-1]
    assert list(warm) == TARGETS and states(warm) == ['GWNN'] * 6
    for values in warm.values():
        assert (values['level'], values['fallback_reason']) == (DiagnosticStatus.OK, '')
        rho = float(values['j']) / float(values['j_fallback'])
        assert float(values['rho']) == pytest.approx(rho, rel=0.02, abs=0.01)

    assert here.set('gwnn_weights', file).successful
    bad = here.play(30)
    assert all(list(targets) == TARGETS for targets in bad)
    assert states(bad[-1]) == ['FALLBACK'] * 6
    for values in bad[-1].values():
        assert (values['message'], values['level']) == ('TRACKING', DiagnosticStatus.WARN)
        assert values['fallback_reason'] in monitor.REASONS[1:]
    entry, values = here.tracking('confirmed in FALLBACK', '6')
    assert entry.level == DiagnosticStatus.WARN
    assert values['fallback reason'] in monitor.REASONS[1:]
    assert f'6 of 6 targets have fallen back: {values["fallback reason"]}' in entry.message
    alarm = here.fallback_alarm('active acknowledged')  # a caution
    assert alarm.level == DiagnosticStatus.WARN
    assert re.fullmatch(r'[2-6] of [2-6] targets have fallen back from their filter', alarm.message)

    assert here.set('gwnn_weights', '').successful
    again = here.play(50)
    assert all(list(targets) == TARGETS for targets in again)
    assert states(again[-1]) == ['GWNN'] * 6
    assert {values['level'] for values in again[-1].values()} == {DiagnosticStatus.OK}
    assert here.tracking('confirmed in GWNN', '6')[1]['fallback reason'] == ''
    here.fallback_alarm('normal')
    here.check_numbers()
    here.end()


def not_numbers(file):
    good = gwnn.weights()
    gwnn_weights.save(
        file,
        good._replace(fusion=good.fusion._replace(bias=np.full_like(good.fusion.bias, np.nan))),
    )


def damaged(file):
    gwnn_weights.save(file, gwnn.weights())
    file.write_bytes(file.read_bytes()[:-3000])


def missing(file):
    pass


UNFIT = [
    (not_numbers, 'fusion_bias holds values that are not finite'),
    (damaged, 'damaged'),
    (missing, 'cannot be read: No such file or directory'),
]


def test_an_unfit_file_is_refused_while_running_and_changes_nothing(watch, tmp_path):
    here = watch(estimator='gwnn')
    before = here.play(WARM)[-1]
    for make, said in UNFIT:
        file = tmp_path / f'{make.__name__}.npz'
        make(file)
        answer = here.set('gwnn_weights', file)
        assert not answer.successful and str(file) in answer.reason and said in answer.reason
        after = here.play(3)
        assert all(list(targets) == list(before) == TARGETS for targets in after)
        assert states(after[-1]) == ['GWNN'] * 6
    assert here.set('range_sigma_m', 'no number').successful is False
    assert here.tracking('confirmed in GWNN', '6')[1][FAILED] == '0'
    # The refused file is not remembered: a later change goes through.
    assert here.set('vessel_class', 'small_craft').successful
    assert list(here.play(3)[-1]) == TARGETS
    here.check_numbers()
    here.end()


@pytest.mark.parametrize('make, said', UNFIT)
def test_an_unfit_file_stops_the_start_in_one_line(launch, tmp_path, make, said):
    file = tmp_path / f'{make.__name__}.npz'
    make(file)
    process = launch(
        'nodes.run tracker', '--ros-args', '-p', 'estimator:=gwnn', '-p', f'gwnn_weights:={file}'
    )
    assert process.ends() == 1
    assert process.said.startswith(f'tracker: GWNN weights {file}') and said in process.said
    assert len(process.said.splitlines()) == 1


def test_no_track_is_lost_by_changing_among_all_estimators(watch):
    here = watch()
    assert list(here.play(WARM)[-1]) == TARGETS
    for name in (*ESTIMATORS, *reversed(ESTIMATORS)):
        assert here.set('estimator', name).successful
        after = here.play(12)
        assert all(list(targets) == TARGETS for targets in after)
        for values in after[-1].values():
            assert (values['message'], values['estimator']) == ('TRACKING', name)
            assert bool(values['estimator_state']) == bool(values['rho']) == (name == 'gwnn')
    assert not any(
        entry.message == 'LOST' for message in here.targets.messages for entry in message.status
    )
    here.check_numbers()
    here.end()
