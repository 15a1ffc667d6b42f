import array
import time

import numpy as np
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from nav_msgs.msg import Odometry
from rclpy.parameter import Parameter
from sensor_msgs.msg import PointCloud2, PointField
from visualization_msgs.msg import Marker, MarkerArray

from marine_tracker.geometry import KNOT, NAUTICAL_MILE, own_ship_at
from marine_tracker.nodes import convert, topics
from marine_tracker.nodes.tracker_node import MISSED, TrackerNode
from marine_tracker.parameters import TrackerParameters, from_mapping
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking import intake
from marine_tracker.tracking.lifecycle import CONFIRMED, LOST, TENTATIVE
from marine_tracker.tracking.tracker import Tracker
from marine_tracker.types import PolarPlots, Scan

SECOND = 1_000_000_000
EPOCH_NS = 1_700_000_000 * SECOND       # stamps as a real radar has them


@pytest.fixture(scope='module')
def clean():
    """The scenario's first 40 scans and its tracker parameters."""
    chosen = scenario.load('clean')
    scans = [scan for (scan, _), _ in zip(radar.simulate(chosen, 3), range(40))]
    return scans, from_mapping(TrackerParameters, chosen.tracker_parameters())


class Rig:
    """A tracker node, a radar and an own ship to feed it with, and ears for what it says."""

    def __init__(self, graph, node_helpers, clean, quality=None, namespace='', **parameters):
        self.wait, listener = node_helpers
        self.scans, self.parameters = clean
        given = {name: getattr(self.parameters, name)
                 for name in ('range_sigma_m', 'bearing_sigma_deg', 'max_range_m')}
        self.tracker = graph.make(TrackerNode, **{**given, **parameters})
        self.other = graph.bystander()
        self.radar = self.other.create_publisher(
            PointCloud2, topics.PLOTS, quality or topics.reliable(50))
        self.own_ship = self.other.create_publisher(
            Odometry, topics.ODOMETRY, topics.reliable(500))
        self.targets = listener(self.other, DiagnosticArray, topics.TARGETS, topics.latched(50))
        self.wait(lambda: self.radar.get_subscription_count()
                  and self.own_ship.get_subscription_count() and self.targets.connected)
        self.shift_ns = EPOCH_NS

    def listen(self, node_helpers, kind, topic, quality=400):
        ears = node_helpers[1](self.other, kind, topic, quality)
        self.wait(lambda: ears.connected)
        # The publisher has to know us, too: it does not speak to an empty room.
        self.wait(lambda: self.tracker.count_subscribers(topic))
        return ears

    def stamp(self, seconds):
        return self.shift_ns + round(seconds * 1e9)

    def send_own_ship(self, time, position, velocity):
        self.own_ship.publish(convert.own_ship_to_odometry(self.stamp(time), position, velocity))

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

    def estimate_at(self, time):
        """The tracks in the node's memory, at a time of the scenario."""
        return self.tracker._tracker.extrapolate(
            self.tracker._memory.tracks, self.tracker._seconds(self.stamp(time)))

    def names(self):
        return [entry.name for entry in self.targets[-1].status]

    def told(self, reason):
        """How often the tracker has counted this."""
        return (self.tracker.bad_input.counts + self.tracker.bad_own_ship.counts)[reason]


@pytest.fixture
def rig(graph, node_helpers, clean):
    def make(**parameters):
        return Rig(graph, node_helpers, clean, **parameters)
    return make


def test_what_is_published_is_what_the_core_says(rig, node_helpers, clean):
    scans, parameters = clean
    here = rig()
    tracks = here.listen(node_helpers, Odometry, topics.TRACKS)
    ahead = here.listen(node_helpers, Odometry, topics.EXTRAPOLATIONS)
    cloud = here.listen(node_helpers, PointCloud2, topics.TRACKS_CLOUD)
    core = Tracker(here.tracker._tracker.parameters)
    memory, expected, further, rows = core.start(), [], [], []
    for scan in scans[:15]:
        memory, report = core.step(memory, scan)
        chosen = np.flatnonzero((report.tracks.number > 0) & (report.tracks.status != LOST))
        chosen = chosen[np.argsort(report.tracks.number[chosen])]
        estimate = core.extrapolate(report.tracks, report.time)
        later = core.extrapolate(report.tracks, report.time + parameters.scan_period_s)
        expected += [(report.tracks.number[k], estimate, k) for k in chosen]
        further += [(report.tracks.number[k], later, k) for k in chosen]
        rows += [(report.tracks.id[k], report.tracks.status[k], estimate, k)
                 for k in range(len(report.tracks.id))]
    here.play(scans[:15])
    here.wait(lambda: len(tracks) >= len(expected) and len(ahead) >= len(expected)
              and len(cloud) >= 15)
    assert len(expected) > 50
    for got, wanted in ((tracks, expected), (ahead, further)):
        assert len(got) == len(wanted)
        for message, (number, estimate, k) in zip(got.messages, wanted):
            assert message.child_frame_id == f'track_{number:02d}'
            assert message.header.frame_id == 'map'
            stamp = convert.nanoseconds(message.header.stamp) - EPOCH_NS
            assert stamp * 1e-9 == pytest.approx(estimate.time[k], abs=1e-5)
            position, velocity = convert.odometry_to_own_ship(message)
            assert position == pytest.approx(estimate.position[k], abs=0.05)
            assert velocity == pytest.approx(estimate.velocity[k], abs=0.01)
            assert message.pose.covariance.reshape(6, 6)[:2, :2] == pytest.approx(
                estimate.covariance[k, :2, :2], rel=1e-3, abs=1e-2)
    got = np.concatenate([np.frombuffer(message.data, convert.TRACK_TYPE)
                          for message in cloud.messages])
    assert got['id'].tolist() == [id_ for id_, *_ in rows]
    assert got['status'].tolist() == [status for _, status, *_ in rows]
    assert {TENTATIVE, CONFIRMED} <= set(got['status'].tolist())
    for row, (_, _, estimate, k) in zip(got, rows):
        assert [row['x'], row['y']] == pytest.approx(estimate.position[k], abs=0.05)
        assert [row['vx'], row['vy']] == pytest.approx(estimate.velocity[k], abs=0.01)
        assert [row['xx'], row['xvx'], row['vyvy']] == pytest.approx(
            estimate.covariance[k][[0, 0, 3], [0, 2, 3]], rel=1e-3, abs=1e-2)


def test_targets_read_like_a_table(rig, clean):
    here = rig()
    here.play(clean[0][:15])
    message = here.targets[-1]
    assert [entry.name for entry in message.status] == [f'TT{n:02d}' for n in range(1, 7)]
    scan = clean[0][14]
    assert convert.nanoseconds(message.header.stamp) == pytest.approx(
        EPOCH_NS + scan.end * 1e9, abs=1e6)
    tracks = here.tracker._memory.tracks
    estimate = here.estimate_at(scan.end)
    own, _ = own_ship_at(scan.own_ship, scan.end)
    for entry in message.status:
        assert (entry.message, entry.level) == ('TRACKING', DiagnosticStatus.OK)
        values = {pair.key: pair.value for pair in entry.values}
        k = int(np.flatnonzero(tracks.number == int(entry.name[2:]))[0])
        offset, velocity = estimate.position[k] - own, estimate.velocity[k]
        assert float(values['range_nm']) == pytest.approx(
            np.hypot(*offset) / NAUTICAL_MILE, abs=0.006)
        assert float(values['bearing_deg']) == pytest.approx(
            np.degrees(np.arctan2(*offset)) % 360, abs=0.06)
        assert float(values['speed_kn']) == pytest.approx(np.hypot(*velocity) / KNOT, abs=0.06)
        assert float(values['course_deg']) == pytest.approx(
            np.degrees(np.arctan2(*velocity)) % 360, abs=0.06)
        assert values['estimator'] == 'imm' and int(values['hits_in_10']) >= 9


def test_a_target_that_vanishes_coasts_and_is_told_lost_once(rig, node_helpers, clean):
    here = rig()
    markers = here.listen(node_helpers, MarkerArray, topics.MARKERS, 50)
    here.play(clean[0][:15])
    labels = {marker.id for marker in markers[-1].markers
              if marker.ns == 'labels' and marker.action == Marker.ADD}
    assert labels == {1, 2, 3, 4, 5, 6}
    empty = PolarPlots(*(np.empty(0) for _ in range(4)))
    here.play([scan._replace(plots=empty) for scan in clean[0][15:]])
    seen = {}
    for message in here.targets.messages:
        for entry in message.status:
            seen.setdefault(entry.name, []).append((entry.message, entry.level))
    for name in ('TT01', 'TT06'):
        words = [word for word, _ in seen[name]]
        assert words.count('LOST') == 1 and words[-1] == 'LOST' and 'COASTING' in words
        assert ('COASTING', DiagnosticStatus.WARN) in seen[name]
        assert seen[name][-1] == ('LOST', DiagnosticStatus.STALE)
    here.wait(lambda: len(markers) >= len(here.targets))
    deleted = [marker.id for message in markers.messages for marker in message.markers
               if marker.action == Marker.DELETE]
    assert sorted(deleted) == [1, 2, 3, 4, 5, 6]
    lists = {marker.ns: len(marker.points) for marker in markers[-1].markers}
    assert lists == {'symbols': 0, 'vectors': 0, 'past_positions': 0, 'ellipses': 0}


def test_markers_show_symbols_vectors_ellipses_and_past_positions(rig, node_helpers, clean):
    here = rig()
    markers = here.listen(node_helpers, MarkerArray, topics.MARKERS, 50)
    here.play(clean[0])
    here.wait(lambda: len(markers) == len(here.targets))
    kinds = {marker.ns: marker for marker in markers[-1].markers if marker.ns != 'labels'}
    assert len(kinds['vectors'].points) == 2 * 6
    assert len(kinds['past_positions'].points) >= 2 * 6
    tracks = here.tracker._memory.tracks
    estimate = here.estimate_at(clean[0][-1].end)
    order = np.argsort(tracks.number)[-6:]
    corners = np.array([(p.x, p.y) for p in kinds['symbols'].points]).reshape(6, -1, 2)
    assert corners.mean(1) == pytest.approx(estimate.position[order], abs=0.1)
    ellipses = np.array([(p.x, p.y) for p in kinds['ellipses'].points]).reshape(6, -1, 2)
    for corner, k in zip(ellipses, order):
        offset = corner - estimate.position[k]
        inverse = np.linalg.inv(estimate.covariance[k, :2, :2])
        assert np.einsum('ci,ij,cj->c', offset, inverse, offset) == pytest.approx(4.0, rel=0.02)


def test_nobody_who_listens_means_no_markers_and_no_odometry(rig, clean, monkeypatch):
    here = rig()
    published = []
    for publisher in (here.tracker._to_markers, here.tracker._to_tracks):
        monkeypatch.setattr(publisher, 'publish', published.append)
    here.play(clean[0][:8])
    assert here.names() and not published


def test_who_comes_late_gets_the_targets_at_once(rig, node_helpers, clean):
    here = rig()
    here.play(clean[0][:10])
    late = node_helpers[1](here.other, DiagnosticArray, topics.TARGETS, topics.latched())
    here.wait(lambda: len(late))
    assert late[0] == here.targets[-1]


def test_a_live_change_keeps_every_track(rig, clean):
    here = rig()
    here.play(clean[0][:12])
    before, ids = here.names(), here.tracker._memory.tracks.id.tolist()
    assert len(before) == 6
    for k, (name, value) in enumerate((
            ('estimator', 'cs_kalman'), ('vessel_class', 'small_craft'), ('estimator', 'imm'),
            ('gate_probability', 0.99), ('confirm_hits', 5), ('max_target_speed_mps', 30.0))):
        assert here.tracker.set_parameters([Parameter(name, value=value)])[0].successful
        assert getattr(here.tracker._tracker.parameters, name) == value
        here.play(clean[0][12 + k:13 + k])
        assert here.names() == before
        assert all(entry.message == 'TRACKING' for entry in here.targets[-1].status)
    assert here.tracker._memory.tracks.id.tolist()[:6] == ids[:6]
    used = {pair.value for pair in here.targets[12].status[0].values if pair.key == 'estimator'}
    assert used == {'cs_kalman'}
    assert not here.tracker.failures.counts


def bad_plots(scan, **columns):
    plots = scan.plots._replace(**{
        name: np.where(np.arange(len(scan.plots.range)) == 0, value, getattr(scan.plots, name))
        for name, value in columns.items()})
    return scan._replace(plots=plots)


@pytest.mark.parametrize('columns, reason', [
    ({'range': np.nan}, intake.NOT_FINITE), ({'range': np.inf}, intake.NOT_FINITE),
    ({'range': -50.0}, intake.BAD_RANGE), ({'bearing': 7.0}, intake.BAD_BEARING),
    ({'bearing': -np.inf}, intake.NOT_FINITE), ({'time': np.nan}, intake.NOT_FINITE)])
@pytest.mark.filterwarnings('ignore:invalid value')
def test_bad_plots_are_counted_and_the_tracks_live_on(rig, clean, columns, reason):
    here = rig()
    here.play(clean[0][:7])
    before = here.names()
    here.play([bad_plots(clean[0][7], **columns), clean[0][8]])
    assert here.told(reason) == 1
    assert len(before) == 6 and here.names() == before
    assert not here.tracker.failures.counts


def test_scans_out_of_time_are_counted_and_the_tracks_live_on(rig, clean):
    scans, here = clean[0], rig()
    here.play(scans[:8])
    before = here.names()
    for wrong, reason in ((0.0, intake.REPEATED), (-30.0, intake.WENT_BACK),
                          (3600.0, intake.JUMPED_AHEAD)):
        scan = scans[7]
        here.radar.publish(convert.plots_to_cloud(scan, here.stamp(scan.start + wrong)))
        here.wait(lambda reason=reason: here.told(reason) == 1)
    here.play(scans[8:10])
    assert len(before) == 6 and here.names() == before
    assert here.tracker._taken == 10


@pytest.mark.parametrize('jump_s', [3600, -3600, -1_600_000_000])
def test_tracks_live_through_a_clock_that_was_set(rig, clean, jump_s):
    scans, here = clean[0], rig()
    here.play(scans[:10])
    before = here.names()
    here.shift_ns += jump_s * SECOND
    for scan in scans[10:12]:
        here.send_own_ship_of([scan])
        here.radar.publish(convert.plots_to_cloud(scan, here.stamp(scan.start)))
    here.play(scans[12:20])
    assert len(before) == 6 and here.names() == before
    assert [entry.message for entry in here.targets[-1].status] == ['TRACKING'] * 6
    assert here.told(intake.REBASED) == 1 and here.tracker._taken == 18
    stamp = convert.nanoseconds(here.targets[-1].header.stamp)
    assert stamp == pytest.approx(here.stamp(scans[19].end), abs=2e6)


def test_missed_revolutions_are_counted(rig, clean):
    here = rig()
    here.play(clean[0][:6])
    here.play(clean[0][8:10])
    assert here.told(MISSED) == 2


def broken_clouds(scan):
    def cloud(**changes):
        message = convert.plots_to_cloud(scan, EPOCH_NS + 10 ** 15)
        for name, value in changes.items():
            setattr(message, name, value)
        return message
    fields = cloud().fields
    mistyped = cloud()
    mistyped.fields[3].datatype = PointField.UINT16
    return [
        (cloud(fields=fields[:4]), convert.MISSING_FIELD),
        (cloud(fields=[]), convert.MISSING_FIELD),
        (mistyped, convert.MISTYPED_FIELD),
        (cloud(data=cloud().data[:-9]), convert.TRUNCATED),
        (cloud(data=array.array('B')), convert.TRUNCATED),
        (cloud(row_step=3), convert.BAD_LAYOUT),
        (cloud(width=2 ** 31), convert.BAD_LAYOUT),
    ]


def test_broken_clouds_are_counted_and_the_tracks_live_on(rig, clean):
    here = rig()
    here.play(clean[0][:8])
    before = here.names()
    for message, reason in broken_clouds(clean[0][8]):
        told = here.told(reason)
        here.radar.publish(message)
        here.wait(lambda reason=reason, told=told: here.told(reason) == told + 1)
    here.play(clean[0][8:10])
    assert len(before) == 6 and here.names() == before
    assert not here.tracker.failures.counts


def test_random_bytes_do_not_stop_the_node(rig, clean):
    rng = np.random.default_rng(11)
    here = rig()
    here.play(clean[0][:8])
    before = here.names()
    counts = here.tracker.bad_input.counts
    for _ in range(150):
        message = convert.plots_to_cloud(clean[0][8], here.stamp(clean[0][7].start))
        message.data = array.array('B', rng.bytes(
            len(message.data) - int(rng.choice([0, 0, 1, 28]))))
        message.header.stamp.sec = int(rng.integers(-2 ** 31, 2 ** 31))
        message.header.stamp.nanosec = int(rng.integers(0, 2 ** 32))
        seen = counts.total()
        here.radar.publish(message)
        here.wait(lambda seen=seen: counts.total() > seen)
        odometry = convert.own_ship_to_odometry(0, rng.normal(size=2) * 1e300, [0.0, 0.0])
        odometry.header.stamp.sec = message.header.stamp.sec
        odometry.pose.pose.orientation.w = float('nan')
        here.own_ship.publish(odometry)
    here.play(clean[0][8:10])
    assert len(before) == 6 and here.names() == before
    assert not here.tracker.failures.counts


def test_a_hundred_thousand_plots_in_one_message_are_cut_to_the_strongest(rig, clean):
    scan, rng = clean[0][8], np.random.default_rng(4)
    count = 100_000
    here = rig(max_plots=500)
    here.play(clean[0][:8])
    before = here.names()
    flood = PolarPlots(*(np.concatenate([ours, more]) for ours, more in zip(
        scan.plots._replace(amplitude=scan.plots.amplitude + 200), (
            rng.uniform(scan.start, scan.end, count), rng.uniform(50, 14e3, count),
            rng.uniform(0, 2 * np.pi, count), rng.uniform(0, 30, count)))))
    here.play([scan._replace(plots=flood), clean[0][9]])
    assert here.told(intake.TOO_MANY) == count + len(scan.plots.time) - 500
    assert len(before) == 6 and set(before) <= set(here.names())


def test_own_ship_that_was_never_heard_is_at_the_origin_and_that_is_said(
        rig, node_helpers, clean):
    here = rig()
    diagnostics = here.listen(node_helpers, DiagnosticArray, topics.DIAGNOSTICS)
    here.send(clean[0][:8])
    assert len(here.names()) == 6
    said = here.wait(lambda: [
        entry for message in diagnostics.messages for entry in message.status
        if entry.name == 'tracker: own ship' and entry.message == intake.OWN_NEVER_HEARD])
    assert said[0].level == DiagnosticStatus.WARN


def test_own_ship_gone_silent_stands_where_it_was_and_that_is_said(rig, node_helpers, clean):
    here = rig()
    diagnostics = here.listen(node_helpers, DiagnosticArray, topics.DIAGNOSTICS)
    here.play(clean[0][:4])
    here.send(clean[0][4:10])
    here.wait(lambda: any(
        entry.message == intake.OWN_SILENT and entry.level == DiagnosticStatus.WARN
        for message in diagnostics.messages for entry in message.status
        if entry.name == 'tracker: own ship'))
    here.play(clean[0][10:12])
    here.wait(lambda: diagnostics[-1].status[2].level == DiagnosticStatus.OK)


def test_own_ship_that_teleports_is_not_believed(rig, clean):
    scans, here = clean[0], rig()
    here.play(scans[:8])
    before = here.names()
    here.send_own_ship(scans[8].start + 0.5, [300e3, 0.0], [0.0, 0.0])
    here.wait(lambda: here.told(intake.OWN_TELEPORTED) == 1)
    here.send_own_ship(scans[8].start + 0.6, [np.nan, 0.0], [0.0, 0.0])
    here.wait(lambda: here.told(intake.OWN_NOT_FINITE) == 1)
    here.play(scans[8:12])
    assert len(before) == 6 and here.names() == before
    assert [entry.message for entry in here.targets[-1].status] == ['TRACKING'] * 6


def test_diagnostics_come_each_second_with_names_and_hardware_ids(rig, node_helpers, clean):
    here = rig()
    here.shift_ns = time.time_ns()          # else the plots come late, which would be told
    diagnostics = here.listen(node_helpers, DiagnosticArray, topics.DIAGNOSTICS)
    here.wait(lambda: len(diagnostics) >= 1)
    first = {entry.name: entry for entry in diagnostics[0].status}
    assert list(first) == ['tracker: input', 'tracker: tracking', 'tracker: own ship']
    assert first['tracker: input'].level == DiagnosticStatus.WARN
    assert 'no plots yet' in first['tracker: input'].message
    here.play(clean[0][:8])
    here.wait(lambda: diagnostics[-1].status[0].values[0].value == '8')
    entries = {entry.name: entry for entry in diagnostics[-1].status}
    assert all(entry.hardware_id == 'radar' for entry in entries.values())
    assert [entry.level for entry in entries.values()] == [DiagnosticStatus.OK] * 3
    values = {pair.key: pair.value for entry in entries.values() for pair in entry.values}
    assert values['scans taken'] == '8' and values['samples'] == '8'
    assert values['confirmed'] == '6'
    assert float(values['processing_p99_ms']) > 0
    for reason in (*convert.CLOUD_REASONS, *intake.PLOT_REASONS, *intake.SCAN_REASONS,
                   *intake.OWN_REASONS, MISSED):
        assert values[reason] == '0'
    here.radar.publish(convert.plots_to_cloud(clean[0][7], here.stamp(clean[0][7].start)))
    here.wait(lambda: diagnostics[-1].status[0].level == DiagnosticStatus.WARN)
    assert intake.REPEATED in diagnostics[-1].status[0].message


def test_a_radar_that_publishes_best_effort_is_heard(rig, node_helpers, clean, graph):
    here = rig()            # its subscriptions asked for reliable, for everyone was
    driver = here.other.create_publisher(PointCloud2, topics.PLOTS, topics.best_effort())
    here.other.destroy_publisher(here.radar)
    scans = iter(range(10 ** 6))

    def heard():
        k = next(scans)
        driver.publish(convert.plots_to_cloud(
            clean[0][0], here.stamp(clean[0][0].start + 0.02 * k)))
        return here.tracker._taken > 0
    here.wait(heard)


def test_an_exception_in_a_callback_is_counted_not_thrown(rig, clean, monkeypatch):
    here = rig()
    here.play(clean[0][:8])
    before = here.names()

    def fail(*_):
        raise RuntimeError('on purpose')
    with monkeypatch.context() as patch:
        patch.setattr(here.tracker._tracker, 'step', fail)
        here.radar.publish(convert.plots_to_cloud(
            clean[0][8], here.stamp(clean[0][8].start)))
        here.wait(lambda: here.tracker.failures.counts.total() == 1)
    here.play(clean[0][9:11])
    assert len(before) == 6 and here.names() == before


def test_a_recording_whose_plots_share_one_time_has_no_sweep(rig, clean):
    here = rig()
    scans = [Scan(scan.end, scan.end,
                  scan.plots._replace(time=np.full(len(scan.plots.time), scan.end)),
                  scan.own_ship) for scan in clean[0][:10]]
    here.play(scans)
    assert len(here.names()) == 6
    stamps = {convert.nanoseconds(here.targets[-1].header.stamp)}
    assert stamps == {here.stamp(scans[-1].end)}


def test_a_ship_at_anchor_seen_from_a_moving_own_ship_stands_still(rig, node_helpers, clean):
    here = rig()
    here.play(clean[0][:25])
    slowest = min(float(pair.value) for entry in here.targets[-1].status
                  for pair in entry.values if pair.key == 'speed_kn')
    assert slowest < 1.5


def test_use_sim_time_without_a_clock_is_said(graph, node_helpers):
    wait, listener = node_helpers
    node = graph.make(TrackerNode, use_sim_time=True)
    ears = listener(graph.bystander(), DiagnosticArray, topics.DIAGNOSTICS)
    wait(lambda: any('/clock is silent' in entry.message
                     for message in ears.messages for entry in message.status))
    assert not node.failures.counts


