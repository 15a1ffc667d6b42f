"""Own ship and the clock: missing, silent, jumping."""

import numpy as np
import pytest

pytest.importorskip('rclpy')
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from marine_tracker.nodes import convert, topics
from marine_tracker.nodes.tracker_node import TrackerNode
from marine_tracker.tracking import intake, own_ship
from marine_tracker.types import Scan

SECOND = 1_000_000_000


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
    assert here.told(intake.REBASED) == 1 and here.tracker.inputs[0].taken == 18
    stamp = convert.nanoseconds(here.targets[-1].header.stamp)
    assert stamp == pytest.approx(here.stamp(scans[19].end), abs=2e6)


def test_own_ship_that_was_never_heard_is_at_the_origin_and_that_is_said(rig, clean):
    here = rig()
    diagnostics = here.listen(DiagnosticArray, topics.DIAGNOSTICS)
    here.send(clean[0][:8])
    assert len(here.names()) == 6
    said = here.wait(
        lambda: [
            entry
            for message in diagnostics.messages
            for entry in message.status
            if entry.name == 'tracker: own ship' and entry.message == own_ship.OWN_NEVER_HEARD
        ]
    )
    assert said[0].level == DiagnosticStatus.WARN


def test_own_ship_gone_silent_stands_where_it_was_and_that_is_said(rig, clean):
    here = rig()
    diagnostics = here.listen(DiagnosticArray, topics.DIAGNOSTICS)
    here.play(clean[0][:4])
    here.send(clean[0][4:10])
    here.wait(
        lambda: any(
            entry.message.startswith(own_ship.OWN_SILENT) and entry.level == DiagnosticStatus.WARN
            for message in diagnostics.messages
            for entry in message.status
            if entry.name == 'tracker: own ship'
        )
    )
    here.play(clean[0][10:12])
    here.wait(lambda: diagnostics[-1].status[2].level == DiagnosticStatus.OK)


def test_own_ship_that_teleports_is_not_believed(rig, clean):
    scans, here = clean[0], rig()
    here.play(scans[:8])
    before = here.names()
    here.send_own_ship(scans[8].start + 0.5, [300e3, 0.0], [0.0, 0.0])
    here.wait(lambda: here.told(own_ship.OWN_TELEPORTED) == 1)
    here.send_own_ship(scans[8].start + 0.6, [np.nan, 0.0], [0.0, 0.0])
    here.wait(lambda: here.told(own_ship.OWN_NOT_FINITE) == 1)
    here.play(scans[8:12])
    assert len(before) == 6 and here.names() == before
    assert [entry.message for entry in here.targets[-1].status] == ['TRACKING'] * 6


def test_a_recording_whose_plots_share_one_time_has_no_sweep(rig, clean):
    here = rig()
    scans = [
        Scan(
            scan.end,
            scan.end,
            scan.plots._replace(time=np.full(len(scan.plots.time), scan.end)),
            scan.own_ship,
        )
        for scan in clean[0][:10]
    ]
    here.play(scans)
    assert len(here.names()) == 6
    stamps = {convert.nanoseconds(here.targets[-1].header.stamp)}
    assert stamps == {here.stamp(scans[-1].end)}


def test_a_ship_at_anchor_seen_from_a_moving_own_ship_stands_still(rig, clean):
    here = rig()
    here.play(clean[0][:25])
    slowest = min(
        float(pair.value)
        for entry in here.targets[-1].status
        for pair in entry.values
        if pair.key == 'speed_kn'
    )
    assert slowest < 1.5


def test_use_sim_time_without_a_clock_is_said(graph, node_helpers):
    wait, listener = node_helpers
    node = graph.make(TrackerNode, use_sim_time=True)
    ears = listener(graph.bystander(), DiagnosticArray, topics.DIAGNOSTICS)
    wait(
        lambda: any(
            '/clock is silent' in entry.message
            for message in ears.messages
            for entry in message.status
        )
    )
    assert not node.failures.counts
