"""Messages of packages that may not be there: asked for and missing, or made from field lists."""

import importlib.util
import math
import uuid
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip('rclpy')
from nav_msgs.msg import Odometry

from marine_tracker.nodes import convert, messages_of_others
from marine_tracker.nodes.faults import ConversionError
from marine_tracker.nodes.tracker_node import TrackerNode


@pytest.mark.parametrize(
    ('parameter', 'value', 'package'),
    [
        ('radar_tracks', True, 'radar_msgs'),
        ('plots_type', 'RadarScan', 'radar_msgs'),
        ('broadcast_tf', True, 'tf2_ros'),
    ],
)
def test_what_is_asked_for_and_not_installed_stops_the_start_by_name(
    graph, parameter, value, package
):
    if importlib.util.find_spec(package):
        pytest.skip(f'{package} is installed here')
    with pytest.raises(ValueError, match=f'parameter {parameter} asks for {package}'):
        graph.make(TrackerNode, **{parameter: value})


def radar_scan(frame, *returns):
    """As radar_msgs/RadarScan: range, azimuth, amplitude of each return."""
    return SimpleNamespace(
        header=SimpleNamespace(frame_id=frame),
        returns=[
            SimpleNamespace(range=range_, azimuth=azimuth, amplitude=amplitude)
            for range_, azimuth, amplitude in returns
        ],
    )


@pytest.mark.parametrize(
    ('frame', 'bearings', 'azimuth_deg', 'bearing_deg'),
    [
        ('map', 'north', 0.0, 90.0),
        ('map', 'north', 90.0, 0.0),
        ('map', 'north', -135.0, 225.0),
        ('base_link', 'bow', 0.0, 0.0),
        ('base_link', 'bow', 30.0, 330.0),
        ('base_link', 'bow', -120.0, 120.0),
    ],
)
def test_azimuths_go_anticlockwise_from_east_or_from_ahead(
    frame, bearings, azimuth_deg, bearing_deg
):
    plots = messages_of_others.scan_to_plots(
        radar_scan(frame, (4300.0, math.radians(azimuth_deg), 17.0)), bearings
    )
    assert plots.bearing == pytest.approx(math.radians(bearing_deg))
    assert plots.range.tolist() == [4300.0] and plots.amplitude.tolist() == [17.0]
    assert plots.time.tolist() == [0.0]


@pytest.mark.parametrize(('frame', 'bearings'), [('map', 'bow'), ('base_link', 'north')])
def test_a_scan_that_counts_from_elsewhere_is_refused(frame, bearings):
    with pytest.raises(ConversionError, match='a RadarScan in'):
        messages_of_others.scan_to_plots(radar_scan(frame, (1.0, 0.0, 1.0)), bearings)
    assert len(messages_of_others.scan_to_plots(radar_scan('map'), 'north').range) == 0


def test_a_transform_is_the_pose_of_the_odometry():
    own = convert.own_ship_to_odometry(1_234_567_890, (310.0, -42.5), (0.0, 0.0), math.radians(75))
    sent = messages_of_others.transform(own)
    assert (sent.header.frame_id, sent.child_frame_id) == ('map', 'base_link')
    assert sent.header.stamp == own.header.stamp
    place = sent.transform.translation
    assert (place.x, place.y, place.z) == (310.0, -42.5, 0.0)
    yaw = 2 * math.atan2(sent.transform.rotation.z, sent.transform.rotation.w)
    assert yaw == pytest.approx(math.radians(15))
    assert isinstance(own, Odometry)


def test_a_radar_track_has_the_covariance_of_its_own_and_one_uuid_for_life():
    from marine_tracker.service import service_for
    from marine_tracker.simulation import radar, scenario

    chosen = scenario.load('clean')
    service = service_for(chosen.tracker_parameters())
    memory = service.start()
    kinds = (
        lambda header: SimpleNamespace(header=header, tracks=[]),
        lambda classification: SimpleNamespace(
            classification=classification, uuid=SimpleNamespace()
        ),
    )
    seen = []
    for (scan, _), _ in zip(radar.simulate(chosen, 6), range(14)):
        memory, output = service.step(memory, scan)
        seen.append(messages_of_others.radar_tracks(kinds, output, 'radar_1/tracker', 5))
    last = seen[-1].tracks
    tracks, estimate = output.report.tracks, output.estimate
    alive = np.flatnonzero(tracks.number > 0)
    assert len(last) == len(alive) > 4
    for one, row in zip(last, alive):
        assert (one.position.x, one.position.y) == tuple(estimate.position[row])
        assert (one.velocity.x, one.velocity.y) == tuple(estimate.velocity[row])
        xx, xy, xz, yy, yz, zz = one.position_covariance
        assert np.float32(estimate.covariance[row, 0, 1]) == xy and xz == yz == zz == 0
        assert (xx, yy) == tuple(np.float32(estimate.covariance[row, [0, 1], [0, 1]]))
        assert one.velocity_covariance[3] == np.float32(estimate.covariance[row, 3, 3])
    ids = [bytes(one.uuid.uuid) for one in last]
    assert len(set(ids)) == len(ids)
    assert ids[0] in [bytes(one.uuid.uuid) for one in seen[-2].tracks]
    assert uuid.UUID(bytes=ids[0]).version == 5


def test_radar_scans_come_in_and_radar_tracks_go_out_over_dds(graph, node_helpers):
    msg = pytest.importorskip('radar_msgs.msg', reason='radar_msgs is not installed')
    from marine_tracker.nodes import topics
    from marine_tracker.simulation import radar, scenario

    wait, listener = node_helpers
    chosen = scenario.load('clean')
    given = {
        name: float(value)
        for name, value in chosen.tracker_parameters().items()
        if name in ('range_sigma_m', 'bearing_sigma_deg', 'max_range_m')
    }
    tracker = graph.make(TrackerNode, radar_tracks=True, plots_type='RadarScan', **given)
    other = graph.bystander()
    scans = other.create_publisher(msg.RadarScan, topics.PLOTS, topics.reliable(50))
    own_ship = other.create_publisher(Odometry, topics.ODOMETRY, topics.reliable(50))
    tracks = listener(other, msg.RadarTracks, topics.RADAR_TRACKS)
    wait(lambda: scans.get_subscription_count() and own_ship.get_subscription_count())
    wait(lambda: tracks.connected and tracker.count_subscribers(topics.RADAR_TRACKS))
    played = [pair for pair, _ in zip(radar.simulate(chosen, 4), range(12))]
    for k, (scan, _) in enumerate(played):
        stamp = 1_700_000_000_000_000_000 + round(scan.start * 1e9)
        at = scan.own_ship.position[-1], scan.own_ship.velocity[-1]
        own_ship.publish(convert.own_ship_to_odometry(stamp, *at))
        wait(lambda k=k: tracker._samples == k + 1)
        message = msg.RadarScan(header=convert.header(stamp))
        for range_, bearing in zip(scan.plots.range.tolist(), scan.plots.bearing.tolist()):
            message.returns.append(msg.RadarReturn(range=range_, azimuth=math.pi / 2 - bearing))
        scans.publish(message)
        wait(lambda k=k: len(tracks) == k + 1)
    last, truth = tracks[-1], played[-1][1]
    assert last.header.frame_id == 'map' and len(last.tracks) >= 5
    for one in last.tracks:
        away = np.hypot(*(truth.position - (one.position.x, one.position.y)).T).min()
        assert away < 250.0
        assert one.position_covariance[0] > 0 and one.velocity_covariance[3] > 0
