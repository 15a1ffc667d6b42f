"""Local positions against geodesics of pyproj, and against plain vectors in space."""

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from pyproj import Geod

from marine_tracker.geodesy import LocalFrame, wrap_longitude

EARTH = Geod(ellps='WGS84')
FAR = 50 * 1852.0
LATITUDES = st.floats(-85, 85)
LONGITUDES = st.floats(-180, 180) | st.floats(179, 180) | st.floats(-180, -179)
BEARINGS = st.floats(0, 360)
DISTANCES = st.floats(0, FAR)


@given(LATITUDES, LONGITUDES, BEARINGS, DISTANCES)
@example(0.0, 180.0, 90.0, FAR)
@example(85.0, -180.0, 270.0, FAR)
@example(-85.0, 179.9, 45.0, FAR)
def test_places_lie_where_geodesics_from_the_origin_lead(latitude, longitude, bearing, distance):
    frame = LocalFrame(latitude, longitude)
    there_lon, there_lat, _ = EARTH.fwd(longitude, latitude, bearing, distance)
    expected = distance * np.array([np.sin(np.radians(bearing)), np.cos(np.radians(bearing))])
    assert frame.to_local(there_lat, there_lon) == pytest.approx(expected, abs=0.01)
    lat, lon = frame.to_geodetic(expected)
    assert -180 <= lon < 180
    assert EARTH.inv(lon, lat, there_lon, there_lat)[2] < 0.01


def in_space(latitude, longitude):
    """[3] m from the centre of the Earth, of a place on the ellipsoid, in radians."""
    a, f = 6378137.0, 1 / 298.257223563
    n = a / np.sqrt(1 - f * (2 - f) * np.sin(latitude) ** 2)
    return n * np.array(
        [
            np.cos(latitude) * np.cos(longitude),
            np.cos(latitude) * np.sin(longitude),
            (1 - f) ** 2 * np.sin(latitude),
        ]
    )


@given(LATITUDES, LONGITUDES, BEARINGS, DISTANCES)
def test_local_positions_agree_with_vectors_in_space(latitude, longitude, bearing, distance):
    """Without any library: the chord, bent to an arc, in the direction that the origin sees.

    Within 0.1 m at 50 NM: the arc is 0.8 m longer than its chord, and the Earth's radius is known
    to 1 % wherever it may be.
    """
    place = distance * np.array([np.sin(np.radians(bearing)), np.cos(np.radians(bearing))])
    there = LocalFrame(latitude, longitude).to_geodetic(place)
    phi, lam = np.radians([latitude, longitude])
    chord = in_space(*np.radians(there)) - in_space(phi, lam)
    east = np.array([-np.sin(lam), np.cos(lam), 0])
    north = np.array([-np.sin(phi) * np.cos(lam), -np.sin(phi) * np.sin(lam), np.cos(phi)])
    level = np.array([chord @ east, chord @ north])
    arc = 2 * 6371e3 * np.arcsin(np.linalg.norm(chord) / (2 * 6371e3))
    if distance > 0.1:
        level *= arc / np.hypot(*level)
    assert level == pytest.approx(place, abs=0.1)


@pytest.mark.parametrize('latitude', [-85.0, -47.3, 0.0, 21.0, 54.0, 85.0])
def test_the_plane_hardly_stretches_near_own_ship(latitude):
    """Two ships 12 NM apart, both 20 NM from the origin, on the date line: within 1 m."""
    frame = LocalFrame(latitude, 179.99)
    for angle in np.radians(np.arange(0, 360, 30)):
        one = 20 * 1852 * np.array([np.sin(angle), np.cos(angle)])
        other = one + 12 * 1852 * np.array([np.cos(angle), -np.sin(angle)])
        (lat, other_lat), (lon, other_lon) = frame.to_geodetic([one, other])
        apart = EARTH.inv(lon, lat, other_lon, other_lat)[2]
        assert apart == pytest.approx(12 * 1852, abs=1.0)


@pytest.mark.parametrize(('latitude', 'lean_deg'), [(0, 0), (54, 0.503), (-54, -0.503), (80, 2.06)])
def test_far_east_of_the_origin_true_north_leans_towards_it(latitude, lean_deg):
    frame, out = LocalFrame(latitude, 10.0), np.array([22 * 1852.0, 0.0])
    lat, lon = frame.to_geodetic(out)
    north_lon, north_lat, _ = EARTH.fwd(lon, lat, 0.0, 1000.0)
    east, north = frame.to_local(north_lat, north_lon) - out
    assert np.degrees(np.arctan2(-east, north)) == pytest.approx(lean_deg, abs=0.01)


def test_arrays_of_places_keep_their_leading_axes():
    frame = LocalFrame(63.44, -179.9)
    position = np.random.default_rng(3).uniform(-50_000, 50_000, (4, 5, 2))
    latitude, longitude = frame.to_geodetic(position)
    assert latitude.shape == longitude.shape == (4, 5)
    assert (longitude > 179).any() and (longitude < -179).any()
    assert frame.to_local(latitude, longitude) == pytest.approx(position, abs=1e-6)
    assert frame.to_geodetic(np.zeros((0, 2)))[0].shape == (0,)
    assert frame.to_local(np.zeros((3, 0)), np.zeros((3, 0))).shape == (3, 0, 2)
    assert frame.to_geodetic(position[1, 2])[0] == latitude[1, 2]


def test_many_origins_are_a_frame_each():
    latitude, longitude = np.array([10.0, -60.0]), np.array([-179.99, 5.0])
    offset = LocalFrame(latitude, longitude).to_local(latitude + 0.01, [179.99, 5.0])
    for k in range(2):
        bearing, _, distance = EARTH.inv(
            longitude[k], latitude[k], [179.99, 5.0][k], latitude[k] + 0.01
        )
        expected = distance * np.sin(np.radians(bearing)), distance * np.cos(np.radians(bearing))
        assert offset[k] == pytest.approx(expected, abs=1e-6)


def test_positions_off_the_earth_have_no_place():
    latitude, longitude = LocalFrame(54, 10).to_geodetic(
        [[np.nan, 0.0], [np.inf, 0.0], [3e7, 0.0], [1e300, 0.0], [1000.0, 0.0]]
    )
    assert np.isfinite(latitude).tolist() == np.isfinite(longitude).tolist() == [False] * 4 + [True]


@pytest.mark.parametrize(
    ('latitude', 'longitude', 'said'),
    [
        (90.001, 0.0, 'latitude is 90.001 deg; it must be between -90 and 90'),
        (np.nan, 0.0, 'latitude is nan deg'),
        (0.0, 190.5, r'longitude is 190.5 deg; it must be between -180 and 180 \(west is negative'),
        ([5.0, 6.0], [7.0, -180.0001], 'longitude is -180.0001 deg'),
    ],
)
def test_what_is_no_place_on_earth_is_refused(latitude, longitude, said):
    with pytest.raises(ValueError, match=said):
        LocalFrame(latitude, longitude)
    with pytest.raises(ValueError, match=said):
        LocalFrame(0.0, 0.0).to_local(latitude, longitude)


@given(st.floats(-1000, 1000) | st.sampled_from([-180.0, 180.0, 540.0, -1e-17]))
@example(float(np.nextafter(-180, -181)))
@example(float(np.nextafter(180, 0)))
def test_a_wrapped_longitude_is_the_same_one_within_half_a_turn(longitude):
    wrapped = float(wrap_longitude(longitude))
    assert -180 <= wrapped < 180
    assert np.cos(np.radians(wrapped - longitude)) == pytest.approx(1.0, abs=1e-12)
    assert float(wrap_longitude(np.array([longitude]))[0]) == wrapped


def test_the_tracker_does_not_load_pyproj():
    done = subprocess.run(
        [
            sys.executable,
            '-c',
            'import sys; from marine_tracker import cli, geodesy\n'
            'from marine_tracker.tracking import tracker\n'
            'from marine_tracker.simulation import scenario\n'
            'scenario.load("clean")\n'
            'assert "pyproj" not in sys.modules',
        ],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
