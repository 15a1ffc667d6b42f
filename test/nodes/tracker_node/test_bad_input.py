"""Bad plots and broken messages are counted by their reason, and the tracks live on."""

import array

import numpy as np
import pytest

pytest.importorskip('rclpy')
from sensor_msgs.msg import PointField

from marine_tracker.nodes import convert
from marine_tracker.nodes.radar_input import MISSED, NO_DOPPLER
from marine_tracker.tracking import intake
from marine_tracker.types import PolarPlots, append

EPOCH_NS = 1_700_000_000 * 1_000_000_000


def bad_plots(scan, **columns):
    plots = scan.plots._replace(
        **{
            name: np.where(np.arange(len(scan.plots.range)) == 0, value, getattr(scan.plots, name))
            for name, value in columns.items()
        }
    )
    return scan._replace(plots=plots)


@pytest.mark.parametrize(
    'columns, reason',
    [
        ({'range': np.nan}, intake.NOT_FINITE),
        ({'range': np.inf}, intake.NOT_FINITE),
        ({'range': -50.0}, intake.BAD_RANGE),
        ({'bearing': 7.0}, intake.BAD_BEARING),
        ({'bearing': -np.inf}, intake.NOT_FINITE),
        ({'time': np.nan}, intake.NOT_FINITE),
    ],
)
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
    for wrong, reason in (
        (0.0, intake.REPEATED),
        (-30.0, intake.WENT_BACK),
        (3600.0, intake.JUMPED_AHEAD),
    ):
        scan = scans[7]
        here.radar.publish(convert.plots_to_cloud(scan, here.stamp(scan.start + wrong)))
        here.wait(lambda reason=reason: here.told(reason) == 1)
    here.play(scans[8:10])
    assert len(before) == 6 and here.names() == before
    assert here.tracker.inputs[0].taken == 10


def test_missed_revolutions_are_counted(rig, clean):
    here = rig()
    here.play(clean[0][:6])
    here.play(clean[0][8:10])
    assert here.told(MISSED) == 2


def broken_clouds(scan):
    def cloud(**changes):
        message = convert.plots_to_cloud(scan, EPOCH_NS + 10**15)
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
        (cloud(width=2**31), convert.BAD_LAYOUT),
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
    counts = here.tracker.inputs[0].bad.counts
    for _ in range(150):
        message = convert.plots_to_cloud(clean[0][8], here.stamp(clean[0][7].start))
        message.data = array.array(
            'B', rng.bytes(len(message.data) - int(rng.choice([0, 0, 1, 28])))
        )
        message.header.stamp.sec = int(rng.integers(-(2**31), 2**31))
        message.header.stamp.nanosec = int(rng.integers(0, 2**32))
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
    flood = append(
        scan.plots._replace(amplitude=scan.plots.amplitude + 200),
        PolarPlots(
            rng.uniform(scan.start, scan.end, count),
            rng.uniform(50, 14e3, count),
            rng.uniform(0, 2 * np.pi, count),
            rng.uniform(0, 30, count),
        ),
    )
    here.play([scan._replace(plots=flood), clean[0][9]])
    assert here.told(intake.TOO_MANY) == count + len(scan.plots.time) - 500
    assert len(before) == 6 and set(before) <= set(here.names())


def test_a_crowd_of_plots_costs_no_track_and_is_told(rig, clean):
    """3,000 plots within 120 m, in two scans: 9,000,000 pairs of lone plots."""
    rng, count = np.random.default_rng(5), 3000
    here = rig()
    here.play(clean[0][:8])
    before, crowds = here.names(), []
    for scan in clean[0][8:10]:
        crowd = PolarPlots(
            rng.uniform(scan.start, scan.end, count),
            rng.uniform(11_000, 11_120, count),
            rng.uniform(4.0, 4.01, count),
            rng.uniform(0, 30, count),
        )
        crowds.append(scan._replace(plots=append(scan.plots, crowd)))
    here.play(crowds)
    assert len(before) == 6 and set(before) <= set(here.names())
    status = here.tracker._tracking_status(0.0)
    told = {pair.key: pair.value for pair in status.values}
    assert int(told['pairs left out']) > 5_000_000
    assert 'a crowd of plots' in status.message
    here.play([clean[0][10]])
    assert 'a crowd' not in here.tracker._tracking_status(0.0).message


def test_an_exception_in_a_callback_is_counted_not_thrown(rig, clean, monkeypatch):
    here = rig()
    here.play(clean[0][:8])
    before = here.names()

    def fail(*_):
        raise RuntimeError('on purpose')

    with monkeypatch.context() as patch:
        patch.setattr(here.tracker._operator.service.tracker, 'step', fail)
        here.radar.publish(convert.plots_to_cloud(clean[0][8], here.stamp(clean[0][8].start)))
        here.wait(lambda: here.tracker.failures.counts.total() == 1)
    here.play(clean[0][9:11])
    assert len(before) == 6 and here.names() == before


def with_speeds(scan, first):
    """The scan as a radar with Doppler tells it; the first plot's radial speed is `first`."""
    speed = np.zeros(len(scan.plots.time))
    speed[:1] = first
    return scan._replace(plots=scan.plots._replace(radial_speed=speed))


@pytest.mark.parametrize(
    'speed, reason', [(np.nan, intake.SPEED_NOT_FINITE), (1e6, intake.SPEED_TOO_HIGH)]
)
def test_bad_radial_speeds_are_counted_and_their_plots_kept(rig, clean, speed, reason):
    here = rig()
    here.play(clean[0][:3])
    here.play([with_speeds(clean[0][3], speed)])
    assert here.told(reason) == 1
    assert here.tracker.inputs[0].plots_in_scan == len(clean[0][3].plots.time)
    assert not here.tracker.failures.counts


def test_an_estimator_that_wants_doppler_says_so_where_there_is_none(rig, clean):
    here = rig(estimator='alpha_beta')
    here.play(clean[0][:4])
    assert here.told(NO_DOPPLER) == 4
    here.play([with_speeds(scan, 0.0) for scan in clean[0][4:6]])
    assert here.told(NO_DOPPLER) == 4
    assert not here.tracker.failures.counts
    other = rig(estimator='imm', namespace='other')
    other.play(clean[0][:2])
    assert other.told(NO_DOPPLER) == 0
