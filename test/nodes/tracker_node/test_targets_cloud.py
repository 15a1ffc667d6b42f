"""`targets_cloud` holds the numbers of the picture, and can be read back."""

import numpy as np
import pytest

pytest.importorskip('rclpy')
from sensor_msgs.msg import PointCloud2, PointField

from marine_tracker.arpa.alarms import DANGER
from marine_tracker.arpa.alerts import ACTIVE_UNACKNOWLEDGED
from marine_tracker.nodes import convert, targets_cloud, topics
from marine_tracker.service import Service
from marine_tracker.tracking.lifecycle import COASTING, CONFIRMED
from marine_tracker.types import PolarPlots


def test_the_cloud_holds_the_numbers_of_the_picture(rig, clean):
    scans, _ = clean
    here = rig(cpa_limit_nm=3.0, tcpa_limit_min=60.0, extent='random_matrix')
    clouds = here.listen(PointCloud2, topics.TARGETS_CLOUD)
    service = Service(
        here.tracker._operator.service.tracker.parameters,
        here.tracker._operator.service.arpa.parameters,
    )
    memory = service.start()
    seen = dangers = 0
    for k, scan in enumerate(scans[:14]):
        memory, output = service.step(memory, scan)
        here.play([scan])
        here.wait(lambda k=k: len(clouds) > k)
        cloud, picture = clouds[k], here.tracker._operator.picture
        assert cloud.header.frame_id == 'map'
        stamp = convert.nanoseconds(cloud.header.stamp) - here.shift_ns
        assert stamp * 1e-9 == pytest.approx(output.scan.end, abs=1e-5)
        rows = targets_cloud.read(cloud)
        seen += len(rows)
        assert rows['id'].tolist() == picture.targets.id.tolist()
        assert rows['number'].tolist() == picture.targets.number.tolist()
        assert rows['acquired'].tolist() == picture.targets.acquired.tolist()
        assert rows['status'].tolist() == output.report.tracks.status[output.picture.row].tolist()
        state = np.hstack([picture.motion.position, picture.motion.velocity])
        for column, name in enumerate(('x', 'y', 'vx', 'vy')):
            assert rows[name].tolist() == np.float32(state[:, column]).tolist()
            variance = picture.motion.covariance[:, column, column]
            assert rows[name + name].tolist() == np.float32(variance).tolist()
        for name in ('range', 'bearing', 'speed', 'cpa', 'tcpa', 'bow_range', 'bow_time'):
            value, sd = (getattr(picture.approach, name + of) for of in ('', '_sigma'))
            assert np.array_equal(rows[name], value, equal_nan=True)
            assert np.array_equal(rows[name + '_sd'], np.float32(sd), equal_nan=True)
        active = picture.alerts.id[
            (picture.alerts.kind == DANGER) & (picture.alerts.state == ACTIVE_UNACKNOWLEDGED)
        ]
        dangers += len(active)
        unacknowledged = rows['alarm'] == targets_cloud.UNACKNOWLEDGED
        assert set(rows['id'][unacknowledged].tolist()) == set(active.tolist())
        assert np.isfinite(rows['length']).tolist() == (
            output.shapes.extended[output.picture.row].tolist()
        )
    assert seen > 50 and dangers


def test_a_target_without_plots_coasts_in_the_cloud(rig, clean):
    scans, _ = clean
    here = rig()
    clouds = here.listen(PointCloud2, topics.TARGETS_CLOUD)
    here.play(scans[:9])
    nothing = PolarPlots(*(np.zeros(0) for _ in range(4)))
    here.play([scans[9]._replace(plots=nothing)])
    here.wait(lambda: len(clouds) >= 10)
    before, after = (targets_cloud.read(clouds[k]) for k in (8, 9))
    confirmed = before['number'][before['status'] == CONFIRMED]
    assert len(confirmed)
    coasting = after['number'][after['status'] == COASTING]
    assert set(confirmed.tolist()) <= set(coasting.tolist())
    assert np.isnan(after['length']).all()


def test_clouds_of_another_layout_are_read_or_refused_by_name():
    rows = np.zeros(3, targets_cloud.TARGET_TYPE)
    rows['number'], rows['cpa'], rows['alarm'] = [4, 8, 15], [16.5, 23.25, np.nan], [0, 1, 2]
    names = [*reversed(targets_cloud.TARGET_TYPE.names)]
    turned = np.zeros(3, [(name, targets_cloud.TARGET_TYPE[name]) for name in (*names,)])
    for name in names:
        turned[name] = rows[name]
    back = targets_cloud.read(convert.cloud_message(turned, 5))
    assert back.tobytes() == rows.tobytes()

    without = convert.cloud_message(rows, 5)
    without.fields = [field for field in without.fields if field.name != 'tcpa_sd']
    with pytest.raises(convert.ConversionError, match='missing field: tcpa_sd'):
        targets_cloud.read(without)
    mistyped = convert.cloud_message(rows, 5)
    next(f for f in mistyped.fields if f.name == 'vx').datatype = PointField.UINT32
    with pytest.raises(convert.ConversionError, match='vx is u4; it must be one f4'):
        targets_cloud.read(mistyped)
    cut = convert.cloud_message(rows, 5)
    cut.data = cut.data[:-7]
    with pytest.raises(convert.ConversionError, match='truncated'):
        targets_cloud.read(cut)
