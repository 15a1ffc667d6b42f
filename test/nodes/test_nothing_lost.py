"""With 200 targets nothing is lost by listeners of the usual depth, and sentences are exact."""

import subprocess
import sys
import time

import numpy as np
import pytest

pytest.importorskip('rclpy')
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import String

from marine_tracker.arpa import nmea, view
from marine_tracker.arpa.nmea_targets import nothing_told, word
from marine_tracker.arpa.targets import MANUAL, label
from marine_tracker.nodes import convert, topics
from marine_tracker.nodes.nmea_output_node import NmeaOutputNode
from marine_tracker.nodes.tracker_node import TrackerNode
from marine_tracker.tracking.lifecycle import LOST, TENTATIVE
from marine_tracker.types import OwnShip, PolarPlots, Scan

SHIPS, PERIOD, DEPTH = 200, 2.5, 10
EPOCH_NS = 1_700_000_000 * 1_000_000_000


READER = """
import rclpy, signal, sys
from nav_msgs.msg import Odometry
count = 0
def hear(message):
    global count
    count += 1
def end(*_):
    print(count, flush=True)
    sys.exit()
rclpy.init(signal_handler_options=rclpy.signals.SignalHandlerOptions.NO)
signal.signal(signal.SIGTERM, end)
node = rclpy.create_node('reader')
node.create_subscription(Odometry, 'tracks', hear, 10)
while True:
    rclpy.spin_once(node, timeout_sec=0.1)
"""


def crowd(scans, seed=11):
    """Own ship and 200 ships about her, far enough from each other, each with one plot a scan."""
    rng = np.random.default_rng(seed)
    lanes = np.stack(np.meshgrid(np.arange(20), np.arange(10)), -1).reshape(-1, 2)
    start = (lanes - (9.6, 4.7)) * 1310.0 + rng.uniform(-90, 90, (SHIPS, 2))
    velocity = rng.uniform(-3.1, 3.1, (SHIPS, 2))
    own_velocity = np.array([1.7, 4.3])
    for k in range(scans):
        begin = PERIOD * k
        own = OwnShip(
            np.array([begin, begin + PERIOD]),
            np.stack([begin * own_velocity, (begin + PERIOD) * own_velocity]),
            np.stack([own_velocity, own_velocity]),
        )
        place = start + velocity * (begin + 0.5 * PERIOD) - own_velocity * (begin + 0.5 * PERIOD)
        bearing = np.arctan2(*place.T) % (2 * np.pi)
        at = begin + PERIOD * bearing / (2 * np.pi)
        place = start + velocity * at[:, None] - own_velocity * at[:, None]
        plots = PolarPlots(
            at,
            np.hypot(*place.T) + rng.normal(0, 12.0, SHIPS),
            (np.arctan2(*place.T) + rng.normal(0, 0.003, SHIPS)) % (2 * np.pi),
            np.full(SHIPS, 21.0),
        )
        yield Scan(begin, begin + PERIOD, plots, own)


def expected_ttm(output, estimator, told, seconds):
    """What nmea_output has to say of a scan, from the arrays."""
    seen = view.view(output.picture, output.report, estimator)
    status = np.where(
        seen.status == TENTATIVE, nmea.ACQUIRING, np.where(seen.status == LOST, 'L', 'T')
    )
    still = seen.approach.speed == 0
    targets = nmea.as_acquired(
        nmea.Targets(
            np.where(seen.number > 0, seen.number, -seen.id),
            status,
            np.where(seen.acquired == MANUAL, 'M', 'A'),
            np.array(label(seen.id, seen.number)),
            seen.approach.range,
            seen.approach.bearing,
            seen.approach.speed,
            np.where(still, np.nan, seen.approach.course),
            seen.approach.cpa,
            seen.approach.tcpa,
        )
    )
    told, now = word(told, targets, 999)
    return told, nmea.ttm(now.targets, seconds, 'RA')


@pytest.mark.parametrize(
    ('scans', 'pause'),
    [
        pytest.param(12, 0.1, id='short'),
        pytest.param(
            120, PERIOD, id='five minutes', marks=[pytest.mark.slow, pytest.mark.timeout(900)]
        ),
    ],
)
def test_two_hundred_targets_at_the_usual_depth(graph, node_helpers, scans, pause):
    """Who listens to `tracks` is a program of its own, as people have it."""
    wait, listener = node_helpers
    given = {'range_sigma_m': 15.0, 'max_range_m': 44000.0, 'max_targets': 400}
    tracker = graph.make(TrackerNode, tracks_paced=True, **given)
    output = graph.make(NmeaOutputNode, udp='', sentences='TTM', target_numbers=999)
    other = graph.bystander()
    reader = subprocess.Popen([sys.executable, '-c', READER], stdout=subprocess.PIPE, text=True)
    clouds = listener(other, PointCloud2, topics.TRACKS_CLOUD, DEPTH)
    numbers = listener(other, PointCloud2, topics.TARGETS_CLOUD, DEPTH)
    sentences = listener(other, String, topics.NMEA, topics.reliable(400))
    radar = other.create_publisher(PointCloud2, topics.PLOTS, topics.reliable(50))
    own_ship = other.create_publisher(Odometry, topics.ODOMETRY, topics.reliable(50))
    wait(lambda: radar.get_subscription_count() and own_ship.get_subscription_count())
    wait(lambda: all(one.connected for one in (clouds, numbers, sentences)))
    wait(lambda: output.count_publishers(topics.TARGETS_CLOUD))
    for topic in (topics.TRACKS, topics.TRACKS_CLOUD, topics.TARGETS_CLOUD):
        wait(lambda topic=topic: tracker.count_subscribers(topic))

    outputs = []
    step = tracker._operator.step

    def kept(*arguments):
        done, output = step(*arguments)
        outputs.append(output)
        return done, output

    tracker._operator.step = kept
    for k, scan in enumerate(crowd(scans)):
        began = time.monotonic()
        own, stamp = scan.own_ship, EPOCH_NS + round(scan.end * 1e9)
        own_ship.publish(convert.own_ship_to_odometry(stamp, own.position[-1], own.velocity[-1]))
        wait(lambda k=k: tracker._samples == k + 1)
        radar.publish(convert.plots_to_cloud(scan, EPOCH_NS + round(scan.start * 1e9)))
        wait(lambda k=k: len(clouds) == len(numbers) == k + 1)
        wait(lambda k=k: output._last_ns == convert.nanoseconds(numbers[k].header.stamp))
        wait(lambda: len(sentences) == output._count['sentences'])
        while time.monotonic() - began < pause:
            time.sleep(0.01)
    told, expected = nothing_told(), []
    shown, estimator = 0, tracker._operator.service.tracker.estimator
    for k, one in enumerate(outputs):
        stamp = convert.nanoseconds(numbers[k].header.stamp)
        told, lines = expected_ttm(one, estimator, told, stamp * 1e-9)
        expected += lines
        live = (one.report.tracks.number > 0) & (one.report.tracks.status != LOST)
        shown += np.count_nonzero(live)
        assert clouds[k].width == len(one.report.tracks.id)
    assert np.count_nonzero(outputs[-1].report.tracks.number > 0) == SHIPS
    wait(lambda: len(sentences) >= len(expected))
    assert [one.data for one in sentences.messages] == expected
    time.sleep(PERIOD)
    reader.terminate()
    heard = int(reader.communicate(timeout=30)[0])
    print(
        f'{len(clouds)} and {len(numbers)} clouds of {scans}; tracks: {heard} of {shown} messages'
    )
    assert heard <= shown
    if pause == PERIOD:  # faster than the antenna they cannot be spread
        # All on a machine that is not busy; a program that has to wait for 50 ms loses some.
        assert heard > 0.95 * shown


def test_paced_tracks_are_spread_over_the_revolution_and_none_is_left(graph, node_helpers):
    from marine_tracker.nodes.base_node import RunnableNode
    from marine_tracker.nodes.paced import Paced
    from marine_tracker.types import Extrapolation

    wait, _ = node_helpers
    node = graph.make(lambda **arguments: RunnableNode('pacing', **arguments))
    came = []

    class Publisher:
        @staticmethod
        def publish(message):
            came.append((time.monotonic(), message.child_frame_id))

    paced = Paced(node, Publisher)

    def scan(count, period):
        estimate = Extrapolation(
            np.zeros(count), np.ones((count, 2)), np.ones((count, 2)), np.ones((count, 4, 4))
        )
        frames = [f'track_{n:02d}' for n in range(count)]
        paced.publish(lambda time: np.zeros(len(time), np.int64), frames, estimate, period)

    scan(37, 1.5)
    wait(lambda: len(came) == 37)
    assert came[-1][0] - came[0][0] > 0.5 * 1.5
    scan(50, 60.0)
    wait(lambda: len(came) > 38)
    scan(3, 0.1)  # the next scan is there: those that wait go at once
    wait(lambda: len(came) == 37 + 50 + 3)
    assert [name for _, name in came[37:]] == [f'track_{n:02d}' for n in (*range(50), *range(3))]
