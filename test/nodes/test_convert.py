import array

import numpy as np
import pytest

pytest.importorskip('rclpy')
from nav_msgs.msg import Odometry
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import PointCloud2, PointField

from marine_tracker.geometry import own_ship_at
from marine_tracker.nodes import convert
from marine_tracker.nodes.readable_plots import plots_to_readable
from marine_tracker.recording.message_faults import ConversionError
from marine_tracker.types import OwnShip, PolarPlots, Scan

SECOND = 1_000_000_000


def scan(count=40, seed=1):
    rng = np.random.default_rng(seed)
    time = np.sort(rng.uniform(0, 2.7, count)) + 100.0
    plots = PolarPlots(
        time,
        rng.uniform(100, 20e3, count),
        rng.uniform(0, 2 * np.pi, count),
        rng.uniform(5, 30, count),
    )
    own_ship = OwnShip(
        np.array([100.0, 102.7]),
        np.array([[3e3, -1e3], [3e3, -979.0]]),
        np.array([[0.0, 7.8], [0.0, 7.8]]),
    )
    return Scan(100.0, 102.7, plots, own_ship)


def over_the_wire(message):
    return deserialize_message(serialize_message(message), type(message))


def cloud(names=convert.PLOT_FIELDS, kind='<f4', count=3, gap=0):
    """A cloud whose field `name` holds 1, 2, 3 times its place in PLOT_FIELDS."""
    rows = np.zeros(
        count,
        {
            'names': list(names),
            'formats': [kind] * len(names),
            'offsets': [gap + k * (np.dtype(kind).itemsize + gap) for k in range(len(names))],
            'itemsize': len(names) * (np.dtype(kind).itemsize + gap) + gap,
        },
    )
    for name in names:
        place = convert.PLOT_FIELDS.index(name) if name in convert.PLOT_FIELDS else 99
        rows[name] = place * np.arange(1, count + 1)
    datatype = {'f4': PointField.FLOAT32, 'f8': PointField.FLOAT64}[kind[1:]]
    fields = [
        PointField(name=name, offset=rows.dtype.fields[name][1], datatype=datatype, count=1)
        for name in names
    ]
    return PointCloud2(
        height=1,
        width=count,
        fields=fields,
        is_bigendian=kind[0] == '>',
        point_step=rows.dtype.itemsize,
        row_step=rows.nbytes,
        data=array.array('B', rows.tobytes()),
    )


def test_a_scan_goes_out_and_comes_back():
    sent = scan()
    message = over_the_wire(convert.plots_to_cloud(sent, 1_700_000_000 * SECOND + 5))
    got = convert.cloud_to_plots(message)
    assert [field.name for field in message.fields] == list(convert.PLOT_FIELDS)
    assert convert.nanoseconds(message.header.stamp) == 1_700_000_000 * SECOND + 5
    assert message.header.frame_id == 'map'
    assert got.time == pytest.approx(sent.plots.time - sent.start, abs=1e-6)
    assert got.range == pytest.approx(sent.plots.range, rel=1e-7)
    assert got.bearing == pytest.approx(sent.plots.bearing, abs=1e-6)
    assert got.amplitude == pytest.approx(sent.plots.amplitude, rel=1e-6)


def with_doppler(count=40):
    sent = scan(count)
    speed = np.random.default_rng(2).uniform(-20, 20, count)
    return sent._replace(plots=sent.plots._replace(radial_speed=speed))


def test_radial_speeds_go_out_and_come_back_where_the_radar_tells_them():
    sent = with_doppler()
    sent.plots.radial_speed[3] = np.nan
    message = over_the_wire(convert.plots_to_cloud(sent, 0))
    assert message.fields[-1].name == 'radial_speed'
    got = convert.cloud_to_plots(message)
    np.testing.assert_allclose(got.radial_speed, sent.plots.radial_speed, rtol=1e-6)
    assert got.amplitude == pytest.approx(sent.plots.amplitude, rel=1e-6)


def test_gaps_go_with_the_plots_and_are_none():
    gaps = np.array([[0.75, 1.5], [6.0, 0.5]])
    sent = scan(3)._replace(unswept=gaps)
    message = over_the_wire(convert.plots_to_cloud(sent, 0))
    assert message.width == 5
    np.testing.assert_allclose(convert.cloud_to_plots(message).range, sent.plots.range, rtol=1e-6)
    assert convert.cloud_to_gaps(message) == pytest.approx(gaps)
    assert convert.cloud_to_gaps(over_the_wire(convert.plots_to_cloud(scan(3), 0))) is None


def test_a_radial_speed_that_is_no_float_is_refused():
    message = convert.plots_to_cloud(with_doppler(), 0)
    message.fields[-1].datatype = PointField.INT32
    with pytest.raises(convert.ConversionError, match='radial_speed has datatype'):
        convert.cloud_to_plots(message)


def test_radial_speeds_can_be_read():
    sent = with_doppler()
    channels = {c.name: c.values for c in plots_to_readable(sent, 0).channels}
    assert channels['radial_speed_mps'] == pytest.approx(sent.plots.radial_speed, abs=1 / 32)
    channels = {c.name for c in plots_to_readable(scan(), 0).channels}
    assert 'radial_speed_mps' not in channels


def test_x_and_y_are_east_and_north_in_the_map_frame():
    sent = scan(1)
    message = convert.plots_to_cloud(sent, 0)
    x, y = np.frombuffer(message.data, '<f4')[:2]
    own, _ = own_ship_at(sent.own_ship, sent.plots.time[0])
    bearing, distance = sent.plots.bearing[0], sent.plots.range[0]
    assert x == pytest.approx(own[0] + distance * np.sin(bearing), abs=0.01)
    assert y == pytest.approx(own[1] + distance * np.cos(bearing), abs=0.01)


def test_an_empty_scan_goes_out_and_comes_back():
    message = over_the_wire(convert.plots_to_cloud(scan(0), 7))
    assert message.width == 0
    assert all(len(column) == 0 for column in convert.cloud_to_plots(message)[:4])


@pytest.mark.parametrize(
    'names',
    [
        convert.PLOT_FIELDS,
        convert.NEEDED,
        tuple(reversed(convert.PLOT_FIELDS)),
        ('doppler', *convert.NEEDED, 'quality'),
    ],
)
@pytest.mark.parametrize('kind', ['<f4', '<f8', '>f4', '>f8'])
@pytest.mark.parametrize('gap', [0, 3])
def test_any_layout_that_has_what_is_needed_is_read(names, kind, gap):
    got = convert.cloud_to_plots(over_the_wire(cloud(names, kind, gap=gap)))
    assert got.range.tolist() == [3.0, 6.0, 9.0]
    assert got.bearing.tolist() == [4.0, 8.0, 12.0]
    assert got.amplitude.tolist() == [5.0, 10.0, 15.0]
    assert got.time.tolist() == [6.0, 12.0, 18.0]
    assert all(column.dtype == np.float64 for column in got[:4])
    assert got.radial_speed is None


def test_an_organised_cloud_with_padded_rows_is_read():
    message = cloud(count=4)
    raw = np.frombuffer(message.data, np.uint8).reshape(2, -1)
    padded = np.concatenate([raw, np.full((2, 5), 255, np.uint8)], 1)
    message.height, message.width, message.row_step = 2, 2, padded.shape[1]
    message.data = array.array('B', padded.tobytes())
    assert convert.cloud_to_plots(message).range.tolist() == [3.0, 6.0, 9.0, 12.0]


def without(name):
    return cloud(tuple(field for field in convert.PLOT_FIELDS if field != name))


def changed(**fields):
    message = cloud()
    for name, value in fields.items():
        setattr(message, name, value)
    return message


def with_field(**values):
    message = cloud()
    for name, value in values.items():
        setattr(message.fields[3], name, value)
    return message


@pytest.mark.parametrize(
    'message, reason',
    [
        (without('range'), convert.MISSING_FIELD),
        (without('bearing'), convert.MISSING_FIELD),
        (without('amplitude'), convert.MISSING_FIELD),
        (without('time_offset'), convert.MISSING_FIELD),
        (changed(fields=[]), convert.MISSING_FIELD),
        (with_field(datatype=PointField.INT32), convert.MISTYPED_FIELD),
        (with_field(datatype=0), convert.MISTYPED_FIELD),
        (with_field(datatype=200), convert.MISTYPED_FIELD),
        (with_field(count=2), convert.MISTYPED_FIELD),
        (with_field(name='bearing'), convert.BAD_LAYOUT),
        (with_field(offset=26), convert.BAD_LAYOUT),
        (with_field(offset=2**32 - 1), convert.BAD_LAYOUT),
        (changed(point_step=0), convert.BAD_LAYOUT),
        (changed(point_step=20), convert.BAD_LAYOUT),
        (changed(row_step=0), convert.BAD_LAYOUT),
        (changed(row_step=83), convert.BAD_LAYOUT),
        (changed(row_step=85), convert.TRUNCATED),
        (changed(width=2**32 - 1), convert.BAD_LAYOUT),
        (changed(height=2**32 - 1), convert.TRUNCATED),
        (changed(width=0), convert.BAD_LAYOUT),
        (changed(data=array.array('B', bytes(83))), convert.TRUNCATED),
        (changed(data=array.array('B')), convert.TRUNCATED),
        (changed(data=array.array('B', bytes(85))), convert.BAD_LAYOUT),
    ],
)
def test_a_broken_cloud_is_refused_by_name(message, reason):
    with pytest.raises(convert.ConversionError) as error:
        convert.cloud_to_plots(message)
    assert error.value.reason == reason


def test_random_clouds_are_read_or_refused_and_nothing_else():
    rng = np.random.default_rng(5)
    outcomes = set()
    for _ in range(2000):
        message = cloud(kind=rng.choice(['<f4', '>f8']), count=int(rng.integers(0, 4)))
        message.data = array.array('B', rng.bytes(len(message.data)))
        for _ in range(rng.integers(0, 3)):
            name = rng.choice(['height', 'width', 'point_step', 'row_step', 'data', 'field'])
            if name == 'data':
                message.data = array.array('B', rng.bytes(int(rng.integers(0, 200))))
            elif name == 'field':
                field = message.fields[int(rng.integers(0, 7))]
                field.datatype, field.offset = int(rng.integers(0, 12)), int(rng.integers(0, 60))
            else:
                setattr(message, name, int(rng.choice([0, 1, 2, 28, 84, 2**31, 2**32 - 1])))
        try:
            got = convert.cloud_to_plots(message)
            outcomes.add('read')
            assert len(got.range) == message.width * message.height
        except convert.ConversionError as error:
            outcomes.add(error.reason)
    assert outcomes == {'read', *convert.CLOUD_REASONS} - {convert.MISSING_FIELD}


def test_the_readable_plots_print_short_numbers():
    sent = scan()
    message = over_the_wire(plots_to_readable(sent, SECOND))
    columns = {channel.name: np.array(channel.values) for channel in message.channels}
    assert list(columns) == ['range_m', 'bearing_deg', 'amplitude_db', 'time_offset_s']
    assert columns['range_m'] == pytest.approx(sent.plots.range, abs=0.25)
    assert columns['bearing_deg'] == pytest.approx(np.degrees(sent.plots.bearing), abs=0.0625)
    assert columns['time_offset_s'] == pytest.approx(sent.plots.time - 100.0, abs=0.0625)
    assert all(len(repr(value)) <= 9 for values in columns.values() for value in values.tolist())
    assert len(message.points) == 40


@pytest.mark.parametrize('velocity', [(0.0, 0.0), (0.0, 8.0), (-6.0, -2.5), (3.0, 0.0)])
def test_own_ship_goes_out_and_comes_back(velocity):
    message = over_the_wire(convert.own_ship_to_odometry(5 * SECOND, [7.0, -9.0], velocity))
    assert (message.header.frame_id, message.child_frame_id) == ('map', 'base_link')
    position, got = convert.odometry_to_own_ship(message)
    assert position.tolist() == [7.0, -9.0]
    assert got == pytest.approx(velocity, abs=1e-12)


def test_a_heading_that_is_not_the_course_turns_the_twist():
    message = Odometry()
    message.pose.pose.orientation.z = message.pose.pose.orientation.w = np.sqrt(0.5).item()
    message.twist.twist.linear.x, message.twist.twist.linear.y = 8.0, 1.0  # heading north, set W
    assert convert.odometry_to_own_ship(message)[1] == pytest.approx([-1.0, 8.0])


@pytest.mark.parametrize('orientation', [(0.0, 0.0), (float('nan'), 1.0)])
def test_an_orientation_that_is_none_gives_no_velocity(orientation):
    message = Odometry()
    message.pose.pose.orientation.z, message.pose.pose.orientation.w = orientation
    message.twist.twist.linear.x = 5.0
    assert np.isnan(convert.odometry_to_own_ship(message)[1]).all()


def test_odometry_carries_the_estimate_and_its_covariance():
    rng = np.random.default_rng(2)
    root = rng.normal(size=(3, 4, 4))
    covariance = root @ root.transpose(0, 2, 1)
    position, velocity = rng.normal(size=(3, 2)) * 1e3, rng.normal(size=(3, 2)) * 10
    pool = convert.OdometryPool()
    pool.fill(np.zeros(3, int), ['x'] * 3, position * 0 + 1, velocity * 0 + 1, covariance * 9)
    messages = [
        over_the_wire(message)
        for message in pool.fill(
            np.array([1, 2, 3]) * SECOND + 5,
            ['track_01', 'track_02', 'track_03'],
            position,
            velocity,
            covariance,
        )
    ]
    for k, message in enumerate(messages):
        assert convert.nanoseconds(message.header.stamp) == (k + 1) * SECOND + 5
        pose, twist = message.pose, message.twist
        q = pose.pose.orientation
        yaw = 2 * np.arctan2(q.z, q.w)
        assert [pose.pose.position.x, pose.pose.position.y] == position[k].tolist()
        assert twist.twist.linear.x == pytest.approx(np.hypot(*velocity[k]))
        assert np.cos(yaw) * twist.twist.linear.x == pytest.approx(velocity[k, 0])
        assert np.sin(yaw) * twist.twist.linear.x == pytest.approx(velocity[k, 1])
        assert pose.covariance.reshape(6, 6)[:2, :2] == pytest.approx(covariance[k, :2, :2])
        # Turned back into the ground's frame the twist's covariance is the velocity's.
        turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
        back = turn @ twist.covariance.reshape(6, 6)[:2, :2] @ turn.T
        assert back == pytest.approx(covariance[k, 2:, 2:])


def test_the_course_of_a_target_at_rest_is_as_uncertain_as_can_be():
    message = convert.OdometryPool().fill(
        np.array([0]), ['track_01'], np.zeros((1, 2)), np.zeros((1, 2)), np.eye(4)[None]
    )[0]
    assert message.pose.covariance[35] == pytest.approx(np.pi**2 / 3)


def test_a_heading_goes_out_and_comes_back_also_at_rest():
    for velocity in ((0.0, 0.0), (1.5, -2.0)):
        message = over_the_wire(convert.own_ship_to_odometry(SECOND, [3.0, 4.0], velocity, 3.5))
        assert convert.heading_of_odometry(message) == pytest.approx(3.5)
        assert convert.odometry_to_own_ship(message)[1] == pytest.approx(velocity)


def test_who_lies_still_and_has_no_compass_tells_no_heading():
    message = over_the_wire(convert.own_ship_to_odometry(SECOND, [3.0, 4.0], (0.1, 0.0)))
    assert np.isnan(convert.heading_of_odometry(message))
    assert convert.odometry_to_own_ship(message)[1] == pytest.approx([0.1, 0.0])


def test_an_orientation_left_as_it_was_made_tells_no_heading_beside_a_known_position():
    message = Odometry()
    message.pose.pose.orientation.w = 1.0
    assert convert.heading_of_odometry(message) == pytest.approx(np.pi / 2)
    assert np.isnan(convert.heading_of_odometry(message, doubtful=True))
    message.pose.covariance[0] = message.pose.covariance[7] = 4.0
    assert np.isnan(convert.heading_of_odometry(message))
    message.pose.covariance[35] = 0.01
    assert convert.heading_of_odometry(message) == pytest.approx(np.pi / 2)


def test_a_twist_whose_frame_is_the_grounds_is_not_turned():
    message = Odometry(child_frame_id='map')
    message.header.frame_id = '/map'
    message.pose.pose.orientation.z = message.pose.pose.orientation.w = np.sqrt(0.5).item()
    message.twist.twist.linear.x, message.twist.twist.linear.y = 2.0, 7.0
    assert convert.odometry_to_own_ship(message)[1].tolist() == [2.0, 7.0]


@pytest.mark.parametrize('nanosec', [1_000_000_000, 2_147_483_648, 4_294_967_295])
def test_a_stamp_with_too_many_nanoseconds_is_refused(nanosec):
    stamp = convert.time_message(7 * SECOND)
    stamp.nanosec = nanosec
    with pytest.raises(ConversionError, match=f'nanosec is {nanosec}'):
        convert.nanoseconds(stamp)
