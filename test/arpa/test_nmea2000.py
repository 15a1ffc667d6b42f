"""Targets as PGN 128520, taken apart by hand and by the decoder of the package nmea2000."""

import math
import struct

import numpy as np
import pytest

pytest.importorskip('nmea2000')
from nmea2000.decoder import NMEA2000Decoder

from marine_tracker.arpa import nmea
from marine_tracker.arpa.nmea2000 import encoder

TIME = 1_700_050_321.75  # 12:12:01.75 of its day


def targets():
    """One that is tracked, one that is being acquired with nothing known, one that is lost."""
    unknown = math.nan
    rows = [
        (14, nmea.TRACKING, nmea.MANUAL, 'TT14', 8311.26, 5.1731, 9.34, 2.7182, 412.5, -73.25),
        (98, nmea.ACQUIRING, nmea.AUTOMATIC, 'Q98', 2750.0, 0.3, *[unknown] * 4),
        (305, nmea.LOST, nmea.AUTOMATIC, 'TT305', 15.0, 3.0, 0.0, unknown, 0.0, 0.0),
    ]
    return nmea.Targets(*(np.array(column) for column in zip(*rows)))


def payload(lines):
    """The data of the message whose frames these lines are: fast packets, put together."""
    frames = [bytes.fromhex(line.split('R', 1)[1].split(None, 1)[1]) for line in lines]
    assert [frame[0] & 0x1F for frame in frames] == list(range(len(frames)))
    assert len({frame[0] >> 5 for frame in frames}) == 1
    data = frames[0][2:] + b''.join(frame[1:] for frame in frames[1:])
    return data[: frames[0][1]]


def messages(lines):
    """The lines of each message."""
    first = [k for k, line in enumerate(lines) if int(line.split()[3], 16) & 0x1F == 0]
    return [lines[a:b] for a, b in zip(first, [*first[1:], len(lines)])]


def test_each_bit_of_a_target_is_where_the_message_has_it():
    tracked, acquired, lost = map(payload, messages(encoder()(targets(), TIME, 305)))
    _, number, states, bearing, distance, course, speed, cpa, tcpa, utc = struct.unpack(
        '<BHBHIHHiiI', tracked[:26]
    )
    assert number == 14 and (bearing, course) == (51731, 27182)
    assert (distance, speed, cpa, tcpa) == (831126, 934, 41250, -73250)
    assert utc == round((12 * 3600 + 12 * 60 + 1.75) * 1e4)
    assert (states & 3, states >> 2 & 1, states >> 3 & 1, states >> 4 & 3) == (2, 0, 0, 0)
    assert tracked[26:-1] == b'\x06\x01TT14' and tracked[-1] & 3 == 0
    none = struct.unpack('<HHii', acquired[10:22])
    assert none == (0xFFFF, 0xFFFF, 0x7FFFFFFF, 0x7FFFFFFF)
    assert acquired[3] & 3 == 1 and lost[3] & 3 == 3 and acquired[3] >> 3 & 1 == 1
    assert lost[-1] & 3 == 1  # the reference


def test_the_decoder_of_others_reads_what_was_sent():
    decoder, heard = NMEA2000Decoder(), []
    lines = encoder()(targets(), TIME, 0)
    for line in lines:
        message = decoder.decode(line)
        if message is not None:
            heard.append({field.id: field.value for field in message.fields})
    assert [one['targetId'] for one in heard] == [14, 98, 305]
    assert [one['trackStatus'] for one in heard] == ['Tracking', 'Acquiring', 'Lost']
    assert heard[0]['bearing'] == pytest.approx(5.1731) and heard[0]['name'] == 'TT14'
    assert heard[1]['cpa'] is None and heard[1]['speed'] is None and heard[1]['course'] is None
    assert lines[0].startswith('12:12:01.750 R 09F608')


def test_messages_in_a_row_have_sequences_of_their_own():
    encode, first = encoder(), []
    for _ in range(3):
        first += [int(m[0].split()[3], 16) >> 5 for m in messages(encode(targets(), TIME, 0))]
    assert len(set(first[:8])) == 8  # fast packets count to 7, so that none is joined to another
