"""Places on Earth and the local plane, and back. All use of latitude and longitude is here.

Degrees on WGS 84, north and east positive. Longitudes go in as -180 to 180 and come out in
[-180, 180). Those of 180 to 360 are refused, because in AIS reports 181 means "not known".
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .geometry import Angle, to_range_bearing, unit_vector
from .types import Array

FARTHEST = 2.0e7  # m: half way round the Earth, less 4 km


@cache
def _earth() -> Any:
    """WGS 84. pyproj is loaded on first use, because a tracker alone does not need it."""
    from pyproj import Geod

    return Geod(ellps='WGS84')


def wrap_longitude(longitude: Angle) -> Angle:
    """The same longitude [...] in [-180, 180) deg."""
    turned: Angle = longitude % 360.0
    return turned - 360.0 * (turned >= 180.0)


@dataclass(frozen=True)
class LocalFrame:
    """The plane about an origin: east and north in m, azimuthal equidistant on WGS 84.

    latitude, longitude  deg, of the plane's [0, 0]; or many origins [...], a frame each

    A place has the distance and direction from the origin that the geodesic has, the shortest way
    over the Earth. So range and bearing from the origin are true at any distance. A tangent plane
    (east, north, up) would show 50 NM as 3 m too short.

    Between two places that are both far from the origin, the plane is stretched across the line of
    sight by d^2 / (6 R^2): 35 parts in a million at d = 50 NM, with R the Earth's radius.

    y is true north only at the origin and on its meridian. At e m east of it the meridians lean
    towards it by e tan(latitude) / R rad: 0.5 deg at 22 NM and 54 N, 2 deg at 22 NM and 80 N. So a
    bearing that was measured on board (true north there) is right in the frame about own ship, but
    not in a frame about a far origin.

    ValueError if an origin is not a place on Earth.
    """

    latitude: ArrayLike
    longitude: ArrayLike

    def __post_init__(self) -> None:
        _refuse_elsewhere(self.latitude, self.longitude)

    def to_local(self, latitude: ArrayLike, longitude: ArrayLike) -> Array:
        """East and north [..., 2] m of places [...] deg. ValueError if one is not on Earth."""
        _refuse_elsewhere(latitude, longitude)
        bearing_deg, _, distance = _each(
            _earth().inv, self.longitude, self.latitude, longitude, latitude
        )
        return distance[..., None] * unit_vector(np.radians(bearing_deg))

    def to_local_or_nan(self, latitude: Array, longitude: Array) -> Array:
        """As `to_local`, for places [R] that may be nan, and are nan [R, 2] then."""
        found = np.full((len(latitude), 2), np.nan)
        known = np.isfinite(latitude) & np.isfinite(longitude)
        found[known] = self.to_local(latitude[known], longitude[known])
        return found

    def to_geodetic(self, position: ArrayLike) -> tuple[Array, Array]:
        """Latitude [...] and longitude [...] deg of positions [..., 2] m.

        nan for a position that is not finite or more than 20,000 km away.
        """
        distance, bearing = to_range_bearing(np.asarray(position, float))
        distance = np.where(distance <= FARTHEST, distance, np.nan)
        longitude, latitude, _ = _each(
            _earth().fwd, self.longitude, self.latitude, np.degrees(bearing), distance
        )
        return latitude, wrap_longitude(longitude)


def _each(solve: Callable[..., Any], *values: ArrayLike) -> list[Array]:
    """What solve gives for the values, broadcast; numpy's numbers for plain ones."""
    return [
        np.asarray(one)[()]
        for one in solve(*(np.array(value, float) for value in np.broadcast_arrays(*values)))
    ]


def _refuse_elsewhere(latitude: ArrayLike, longitude: ArrayLike) -> None:
    for name, values, most, hint in (
        ('latitude', latitude, 90, 'south'),
        ('longitude', longitude, 180, 'west'),
    ):
        wrong = ~(np.abs(values) <= most)
        if np.any(wrong):
            value = np.asarray(values)[wrong].flat[0]
            raise ValueError(
                f'{name} is {value:.10g} deg; it must be between -{most} and {most} '
                f'({hint} is negative)'
            )
