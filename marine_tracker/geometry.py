"""Range and bearing to east and north, and back. All bearing mathematics is here.

Bearings are radians clockwise from true north; vectors are [east, north].
"""

from typing import TypeVar

import numpy as np

from .types import Array, OwnShip, Plots, PolarPlots

NAUTICAL_MILE = 1852.0  # m
KNOT = NAUTICAL_MILE / 3600.0  # m/s
AT_REST = 0.25  # m/s; below this own ship makes no way
Angle = TypeVar('Angle', float, Array)


def wrap_bearing(angle: Angle) -> Angle:
    """The same angle in [0, 2 pi)."""
    wrapped: Angle = np.mod(angle, 2 * np.pi)
    return wrapped * (wrapped < 2 * np.pi)  # -1e-17 % 2 pi rounds up to 2 pi


def wrap_angle(angle: Angle) -> Angle:
    """The same angle in [-pi, pi): for differences of bearings."""
    return wrap_bearing(angle + np.pi) - np.pi


def unit_vector(bearing: float | Array) -> Array:
    """[..., 2] east and north of a unit step along the bearing [...]."""
    unit = np.empty(np.shape(bearing) + (2,))
    np.sin(bearing, out=unit[..., 0])
    np.cos(bearing, out=unit[..., 1])
    return unit


def to_range_bearing(offset: Array) -> tuple[Array, Array]:
    """Range [...] m and bearing [...] rad in [0, 2 pi) of offsets [..., 2] m from the radar."""
    east, north = offset[..., 0], offset[..., 1]
    return np.hypot(east, north), wrap_bearing(np.arctan2(east, north))


def bearing_from_yaw(yaw: Angle) -> Angle:
    """Bearing, rad in [0, 2 pi), of a ROS yaw (counter-clockwise from east), and nan of nan."""
    return wrap_bearing(np.pi / 2 - yaw)


def on_deck(ahead: float, starboard: float, heading: Angle) -> Array:
    """East and north [..., 2] m from one place on own ship to another that lies so many m ahead and
    to starboard of it, or of a velocity likewise; at the headings [...] rad."""
    bow = unit_vector(heading)
    return ahead * bow + starboard * np.stack([bow[..., 1], -bow[..., 0]], -1)


def heading_from(velocity: Array, stated: Array) -> Array:
    """Heading [...] rad: the course of the velocity [..., 2] m/s, or of who makes no way the stated
    one [...], nan for none."""
    course = wrap_bearing(np.arctan2(velocity[..., 0], velocity[..., 1]))
    still = np.hypot(velocity[..., 0], velocity[..., 1]) < AT_REST
    return np.where(still, wrap_bearing(stated), course)


def heading_at(own_ship: OwnShip, time: float | Array) -> Array:
    """Own ship's heading [...] rad at the times [...]; nan where it is not known."""
    if own_ship.heading is None:
        return np.full(np.shape(time), np.nan)
    east, north = (
        np.interp(time, own_ship.time, column) for column in unit_vector(own_ship.heading).T
    )
    return wrap_bearing(np.arctan2(east, north))


def polar_to_position(
    range_: Array, bearing: Array, range_sigma: float | Array, bearing_sigma: float | Array
) -> tuple[Array, Array]:
    """Unbiased position and covariance of polar measurements relative to the radar.

    range_, bearing  [M] m, rad; range_sigma m; bearing_sigma rad (scalars or [M]).
    Returns position [M, 2] m and covariance [M, 2, 2] m^2.

    Bearing noise shortens the mean of r (sin b, cos b) by the factor exp(-sigma_b^2 / 2). Dividing
    by it removes the bias. The covariance is that of the truth given the measurement, including
    second-order terms, which matter at long range (Longbin, Xiaoquan, Yiyu, Kang, Bar-Shalom,
    "Unbiased converted measurements for tracking", IEEE T-AES 34(3), 1998, eq 11).
    """
    shrink = np.exp(-0.5 * bearing_sigma**2)
    unit = unit_vector(bearing)
    position = (range_ / shrink)[..., None] * unit
    # Along and across the line of sight. E[cos^2 db] = (1 + shrink^4) / 2.
    second = 0.5 * (range_**2 + range_sigma**2)
    along = (shrink**-2 - 2) * range_**2 + second * (1 + shrink**4)
    across = second * (1 - shrink**4)
    covariance = (along - across)[..., None, None] * (unit[..., :, None] * unit[..., None, :])
    covariance[..., 0, 0] += across
    covariance[..., 1, 1] += across
    return position, covariance


def own_ship_at(own_ship: OwnShip, time: float | Array) -> tuple[Array, Array]:
    """Own ship's position [..., 2] m and velocity [..., 2] m/s at the times [...].

    Linear between samples. Before the first and after the last one the ship keeps its velocity.
    """
    at = own_ship.time
    if len(at) == 1:
        after = np.asarray(time - at[0])[..., None]
        velocity = own_ship.velocity[0] + 0.0 * after
        return own_ship.position[0] + after * velocity, velocity
    inside = np.clip(time, at[0], at[-1])
    position, velocity = (
        np.stack([np.interp(inside, at, column) for column in columns.T], -1)
        for columns in (own_ship.position, own_ship.velocity)
    )
    return position + np.asarray(time - inside)[..., None] * velocity, velocity


def locate(polar: PolarPlots, own_ship: OwnShip, range_sigma: float, bearing_sigma: float) -> Plots:
    """Places polar plots [M] in the ground-stabilised frame, each by own ship at its own time.

    range_sigma m and bearing_sigma rad are the radar's standard deviations. Plots that have their
    own covariance keep it.
    """
    origin, _ = own_ship_at(own_ship, polar.time)
    offset, covariance = polar_to_position(polar.range, polar.bearing, range_sigma, bearing_sigma)
    if polar.covariance is not None:
        covariance = polar.covariance
    return Plots(
        polar.time,
        polar.range,
        wrap_bearing(polar.bearing),
        polar.amplitude,
        origin,
        origin + offset,
        covariance,
        polar.radial_speed,
    )
