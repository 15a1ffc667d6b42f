import time
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip('rclpy')
from builtin_interfaces.msg import Duration
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Image, PointCloud2, PointField

from marine_tracker.nodes import convert, spokes, topics
from marine_tracker.nodes.faults import ConversionError
from marine_tracker.nodes.plot_extractor_node import PlotExtractorNode
from marine_tracker.nodes.recording_player_node import RecordingPlayerNode
from marine_tracker.recording import spokes_file
from marine_tracker.types import OwnShip, Sweep

SHIPS = ((1500.0, 40.0, 32.0), (3300.0, 200.0, 30.0))


def a_sweep(count=12, samples=40, dtype=np.uint8):
    random = np.random.default_rng(1)
    return Sweep(
        5.0 + np.arange(count) * 0.002,
        np.arange(count) * 0.01,
        np.where(np.arange(count) % 3, 1.25, np.nan),
        np.full(count, 2000.0),
        random.integers(0, np.iinfo(dtype).max, (count, samples), dtype, endpoint=True),
    )


@pytest.mark.parametrize('dtype', [np.uint8, np.uint16])
def test_spokes_go_there_and_back(dtype):
    one = a_sweep(dtype=dtype)
    message = spokes.sweep_to_cloud(one, 5.0, 7_000_000_000)
    assert message.width == 12 and message.header.stamp.sec == 7
    assert {field.name: field.count for field in message.fields}['strength'] == 40
    back = spokes.cloud_to_sweep(message, 5.0)
    for got, expected in zip(back, one):
        assert got == pytest.approx(expected, rel=1e-6, nan_ok=True)
    assert back.strength.dtype == dtype


def test_a_message_without_spokes_is_a_sweep_without_spokes():
    assert spokes.cloud_to_sweep(PointCloud2(), 0.0).strength.shape == (0, 0)


@pytest.mark.parametrize(
    ('change', 'words'),
    [
        (lambda m: m.fields.pop(), 'strength'),
        (lambda m: setattr(m.fields[-1], 'datatype', PointField.FLOAT32), 'UINT8 or UINT16'),
        (lambda m: setattr(m.fields[-1], 'count', 60), 'strength ends at byte'),
        (lambda m: setattr(m.fields[-1], 'count', 10**9), 'at most 16384'),
        (lambda m: setattr(m, 'row_step', 5), 'row_step'),
        (lambda m: m.data.pop(), 'bytes of'),
    ],
)
def test_a_message_with_a_wrong_layout_is_refused(change, words):
    message = spokes.sweep_to_cloud(a_sweep(), 5.0, 0)
    change(message)
    with pytest.raises(ConversionError, match=words):
        spokes.cloud_to_sweep(message, 5.0)


def sector(**changes):
    """As marine_sensor_msgs/RadarSector has it."""
    values = {
        'angle_start': -0.3,
        'angle_increment': -0.01,
        'time_increment': Duration(sec=0, nanosec=2_000_000),
        'scan_time': Duration(sec=2, nanosec=500_000_000),
        'range_min': 0.0,
        'range_max': 1500.0,
        'intensities': [SimpleNamespace(echoes=[0.0, 3.0, 15.0, float(k)]) for k in range(4)],
    }
    return SimpleNamespace(**{**values, **changes})


def test_a_radar_sector_turns_clockwise_with_a_negative_increment():
    one = spokes.sector_to_sweep(sector(), 9.0)
    assert one.angle == pytest.approx([0.3, 0.31, 0.32, 0.33])
    assert one.time == pytest.approx([9.0, 9.002, 9.004, 9.006])
    assert one.range == pytest.approx([1500.0] * 4) and np.isnan(one.heading).all()
    assert one.strength[2].tolist() == [0, 51, 255, 34]


def test_a_radar_sector_that_begins_farther_out_keeps_its_ranges():
    one = spokes.sector_to_sweep(sector(range_min=500.0), 0.0)
    assert one.strength.shape == (4, 6) and not one.strength[:, :2].any()
    assert one.strength[0, 4] == 255  # 1,250 m, as before


@pytest.mark.parametrize(
    'changes',
    [
        {'intensities': [SimpleNamespace(echoes=[1.0]), SimpleNamespace(echoes=[1.0, 2.0])]},
        {'range_max': 0.0},
        {'range_min': float('nan')},
        {'intensities': [SimpleNamespace(echoes=[float('inf')])]},
        {'range_min': 1499.9},
    ],
)
def test_a_wrong_radar_sector_is_refused(changes):
    with pytest.raises(ConversionError):
        spokes.sector_to_sweep(sector(**changes), 0.0)


@pytest.fixture(scope='module')
def recorded(tmp_path_factory, pictures):
    """Three revolutions with two ships; own ship heads 1.1 rad."""
    picture = pictures.turned(pictures.make(SHIPS, period=1.2), 3, 1.2)
    count, samples = picture.strength.shape
    one = Sweep(
        picture.time,
        np.mod(picture.bearing - 1.1, 2 * np.pi),
        np.full(count, 1.1),
        picture.range_step * samples,
        picture.strength,
    )
    path = tmp_path_factory.mktemp('video') / 'two_ships.npz'
    own = OwnShip(np.array([0.0, 9.0]), np.zeros((2, 2)), np.zeros((2, 2)), np.array([1.1, 1.1]))
    spokes_file.write(path, [one], own)
    return str(path)


def test_a_recording_of_spokes_becomes_plots_over_dds(graph, node_helpers, recorded):
    """Bearings are true: the heading comes with the spokes."""
    wait, listener = node_helpers
    node = graph.bystander()
    plots = listener(node, PointCloud2, topics.PLOTS, topics.reliable(50))
    images = listener(node, Image, topics.IMAGE, topics.reliable(5))
    told = listener(node, DiagnosticArray, topics.DIAGNOSTICS, topics.reliable(50))
    graph.make(PlotExtractorNode, beam_width_deg=2.4, pulse_length_m=30.0)
    graph.make(RecordingPlayerNode, folder=recorded, rate=1.0)
    wait(lambda: len(plots) >= 2)
    found = convert.cloud_to_plots(plots.messages[1])
    order = np.argsort(found.range)
    assert found.range[order] == pytest.approx([1500.0, 3300.0], abs=10)
    assert np.degrees(found.bearing[order]) == pytest.approx([40.0, 200.0], abs=0.5)
    assert found.covariance is not None and (found.covariance[:, [0, 1], [0, 1]] > 0).all()
    wait(lambda: len(images))
    image = images.messages[-1]
    shown = np.frombuffer(image.data, np.uint8).reshape(image.height, image.width)
    assert image.encoding == 'mono8' and shown.shape == (1024, 1024)
    metres = 400 * 12.0 / 512
    for range_, bearing, _ in SHIPS:
        column = 511.5 + range_ * np.sin(np.radians(bearing)) / metres
        row = 511.5 - range_ * np.cos(np.radians(bearing)) / metres
        around = shown[round(row) - 3 : round(row) + 4, round(column) - 3 : round(column) + 4]
        assert around.max() > shown.mean() + 60

    def told_well():
        for message in told.messages:
            for status in message.status:
                values = {value.key: value.value for value in status.values}
                if status.name == 'plot_extractor: video' and values.get('scans', '0') != '0':
                    return values
        return None

    values = wait(told_well)
    assert values['spokes'] == values['spokes usable']


def test_radar_sectors_become_plots_over_dds(graph, node_helpers, pictures):
    """Two revolutions in sectors of 90 spokes, counter-clockwise angles; own ship heads 0.4 rad."""
    msg = pytest.importorskip('marine_sensor_msgs.msg', reason='not installed')
    wait, listener = node_helpers
    node = graph.bystander()
    plots = listener(node, PointCloud2, topics.PLOTS, topics.reliable(50))
    extractor = graph.make(PlotExtractorNode, beam_width_deg=2.4, pulse_length_m=30.0)
    sectors = node.create_publisher(msg.RadarSector, topics.SECTOR, topics.reliable(100))
    own = node.create_publisher(Odometry, topics.ODOMETRY, topics.reliable(50))
    wait(lambda: sectors.get_subscription_count() and own.get_subscription_count())
    wait(lambda: plots.connected)
    epoch, heading, size = 1_700_000_000_000_000_000, 0.4, 90
    for second in range(-1, 7):
        stamp = epoch + second * 1_000_000_000
        own.publish(convert.own_ship_to_odometry(stamp, (0.0, 0.0), (0.0, 0.0), heading))
    wait(lambda: len(extractor._own) == 8)
    whole = pictures.turned(pictures.make(SHIPS), 2)
    step = whole.bearing[1]
    for k in range(0, len(whole.time), size):
        rows = whole.strength[k : k + size].astype(float)
        sectors.publish(
            msg.RadarSector(
                header=convert.header(epoch + round(whole.time[k] * 1e9), 'base_link'),
                angle_start=float(heading - whole.bearing[k]),
                angle_increment=float(-step),
                time_increment=Duration(nanosec=round(1e9 * whole.time[1])),
                range_max=4800.0,
                intensities=[msg.RadarEcho(echoes=row.tolist()) for row in rows],
            )
        )
        wait(lambda k=k: extractor._spokes == min(k + size, len(whole.time)))
    wait(lambda: len(plots))
    found = convert.cloud_to_plots(plots.messages[0])
    order = np.argsort(found.range)
    assert found.range[order] == pytest.approx([1500.0, 3300.0], abs=10)
    assert np.degrees(found.bearing[order]) == pytest.approx([40.0, 200.0], abs=0.5)


def test_spokes_of_which_none_is_usable_are_an_error(graph, node_helpers):
    wait, listener = node_helpers
    node = graph.bystander()
    told = listener(node, DiagnosticArray, topics.DIAGNOSTICS, topics.reliable(50))
    graph.make(PlotExtractorNode)
    publisher = node.create_publisher(
        PointCloud2, topics.SPOKES, topics.best_effort(topics.SPOKES_DEPTH)
    )
    wait(publisher.get_subscription_count)

    def an_error():
        one = a_sweep()._replace(range=np.zeros(12))
        publisher.publish(spokes.sweep_to_cloud(one, 5.0, time.time_ns()))
        time.sleep(0.05)
        return [
            status
            for message in told.messages
            for status in message.status
            if 'none is usable' in status.message and 'wrong range' in status.message
        ]

    assert wait(an_error)[0].level == b'\x02'


def test_explain_tells_what_the_video_holds(graph, node_helpers, recorded):
    """The extractor answers beside the tracker, and both come as one."""
    from marine_tracker.nodes.base_node import RunnableNode
    from marine_tracker.nodes.explanations import Asker
    from marine_tracker.nodes.tracker_node import TrackerNode

    wait, listener = node_helpers
    node = graph.bystander()
    plots = listener(node, PointCloud2, topics.PLOTS, topics.reliable(50))
    graph.make(TrackerNode)
    extractor = graph.make(PlotExtractorNode, beam_width_deg=2.4, pulse_length_m=30.0)
    asker = Asker(graph.add(RunnableNode('asker', context=graph.context)))
    player = graph.make(RecordingPlayerNode, folder=recorded, rate=1.0)
    wait(lambda: len(plots) >= 2 and player.done)
    del extractor
    answers = []
    east = 1500.0 * np.sin(np.radians(40.0)), 1500.0 * np.cos(np.radians(40.0))

    def both():
        asker.ask(*map(float, east), answers.append)
        time.sleep(0.3)
        return [text for text in answers if 'video: the strongest sample' in text]

    assert 'a plot comes from there' in wait(both)[0]
