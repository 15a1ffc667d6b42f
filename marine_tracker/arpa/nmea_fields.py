"""Fields and framing of NMEA 0183 sentences.

nan gives an empty field, and so does a value too large for its field: a receiver never gets a wrong
number. pynmea2 frames the sentences. It lacks RSD, which is added here.
"""

import math
from collections.abc import Iterable
from datetime import UTC, datetime, timedelta

import pynmea2

from ..files import shown
from ..geodesy import wrap_longitude

MILES, KNOTS, MINUTES = 999.999, 999.99, 999.9  # largest values that a field takes
ANGLE = 4 * math.pi  # rad; a larger value is not a bearing
EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
END_OF_TIME = 253_402_300_799.0  # s: the year 9999 ends


class RSD(pynmea2.TalkerSentence):  # type: ignore[misc]
    """Radar system data, which pynmea2 lacks. Importing this module registers it."""

    fields = tuple(
        (name.replace('_', ' '), name)
        for name in (
            'origin_1_range',
            'origin_1_bearing',
            'vrm_1',
            'ebl_1',
            'origin_2_range',
            'origin_2_bearing',
            'vrm_2',
            'ebl_2',
            'cursor_range',
            'cursor_bearing',
            'range_scale',
            'range_units',
            'rotation',
        )
    )


def sentence(talker: str, kind: str, fields: Iterable[str]) -> str:
    """One sentence with `$` and checksum, without CR LF.

    talker and kind as in RA, TTM. ValueError if a name is not such a code.
    """
    if not (len(talker) == 2 and talker.isascii() and talker.isalnum() and talker.isupper()):
        raise ValueError(
            f'talker is {shown(talker)}; it must be two capital letters or digits, as RA'
        )
    known = pynmea2.TalkerSentence.sentence_types
    if kind not in known:
        raise ValueError(f'sentence {shown(kind)} is not known')
    found: str = known[kind](talker, kind, list(fields)).render()
    return found


def figure(value: float, high: float, decimals: int, low: float = 0.0) -> str:
    """The value, rounded; empty if it is outside the limits or nan."""
    return f'{round(value, decimals) + 0.0:.{decimals}f}' if low <= value <= high else ''


def degrees(angle: float) -> str:
    """000.0 to 359.9 from an angle in rad; empty for nan and above two full turns."""
    return f'{round(math.degrees(angle), 1) % 360:05.1f}' if abs(angle) <= ANGLE else ''


def position(latitude: float, longitude: float) -> tuple[str, str, str, str]:
    """Degrees as ddmm.mmmm, N or S, dddmm.mmmm, E or W; four empty fields if out of range."""
    if not (abs(latitude) <= 90 and abs(longitude) <= 360):
        return '', '', '', ''
    longitude = wrap_longitude(longitude)
    parts = []
    for angle, width, signs in ((latitude, 2, 'NS'), (longitude, 3, 'EW')):
        whole, minutes = divmod(round(abs(angle) * 600_000), 600_000)  # of 1/10000 minute
        parts += [
            f'{whole:0{width}d}{minutes // 10000:02d}.{minutes % 10000:04d}',
            signs[angle < 0],
        ]
    return parts[0], parts[1], parts[2], parts[3]


def hours(time: float) -> str:
    """hhmmss.ss of the time, s of UTC since 1970; empty if out of range."""
    return moment(time, '%H%M%S.%f')[:9]


def moment(time: float, form: str) -> str:
    """The time, rounded to 1/100 s, as strftime has it; empty before 1970 and after 9999."""
    if not 0 <= time < END_OF_TIME:
        return ''
    return (EPOCH + timedelta(milliseconds=10 * round(time * 100))).strftime(form)
