"""How long AIS takes, of ships and of sentences; and whether broken ones are all counted."""

import time
from typing import Any

import numpy as np
from pyais import encode_dict

from ...ais.join import Seen
from ...ais.reports import positions
from ...ais.sentences import Sentences
from ...arpa.cpa import OwnMotion
from ...arpa.stabilisation import ALL_WELL
from ...evaluation import report
from ...evaluation.report import Figure
from ...geometry import unit_vector
from ...parameters import TrackerParameters
from ...service import Service

SHIPS, TRACKS, SCANS, PERIOD = 1000, 200, 40, 2.5
LINES, A_SECOND, BROKEN = 4000, 200, 10_000
NOW = 1_700_000_000.0


def figures(seed: int) -> list[Figure]:
    """Of the machine it runs on, in time of its processor."""
    rng = np.random.default_rng(seed)
    core = 100.0 * A_SECOND * of_a_sentence(rng)
    return [
        report.at_most(
            f'{SHIPS} ships and {TRACKS} tracks: a scan, median', 1e3 * of_a_scan(rng), 5.0, 'ms'
        ),
        report.at_most(f'{A_SECOND} sentences a second: of a core', core, 3.0, '%'),
        report.at_most(f'of {BROKEN} broken sentences not counted', not_counted(rng), 0),
    ]


def of_a_scan(rng: np.random.Generator) -> float:
    """s of a scan: reports heard, ships moved on, joined, their passing and alarms."""
    place = rng.uniform(-15_000, 15_000, (SHIPS, 2))
    speed, course = rng.uniform(2, 10, SHIPS), rng.uniform(0, 2 * np.pi, SHIPS)
    velocity = speed[:, None] * unit_vector(course)
    service, taken = Service(TrackerParameters()), []
    memory = service.start()
    own = OwnMotion(np.zeros(2), np.array([0.0, 5.0]), 0.0, np.zeros((4, 4)))
    covariance = np.broadcast_to(np.diag([400.0, 400.0, 0.1, 0.1]), (TRACKS, 4, 4))
    yes = np.ones(TRACKS, bool)
    for k in range(SCANS):
        now = PERIOD * (k + 1)
        some = np.arange(SHIPS) if k == 0 else rng.choice(SHIPS, SHIPS // 4, replace=False)
        at_now = place + now * velocity
        nowhere = np.zeros(len(some))
        some_reports = positions(
            1 + some, nowhere + now, nowhere, nowhere, speed[some], course[some]
        )
        seen = Seen(
            1 + np.arange(TRACKS),
            1 + np.arange(TRACKS),
            at_now[:TRACKS] + rng.normal(0, 20, (TRACKS, 2)),
            velocity[:TRACKS] + rng.normal(0, 0.3, (TRACKS, 2)),
            covariance,
            yes,
            yes,
        )
        began = time.process_time()
        memory = service.hear(memory, some_reports, at_now[some])
        memory, _, _ = service.ships(memory, seen, own, np.zeros(2), ALL_WELL, now)
        taken.append(time.process_time() - began)
    return float(np.median(taken[1:]))


def _lines(rng: np.random.Generator, count: int) -> list[str]:
    found: list[str] = []
    for k in range(count):
        fields: dict[str, Any] = {
            'mmsi': 200_000_000 + int(rng.integers(1000)),
            'lat': float(rng.uniform(-80, 80)),
            'lon': float(rng.uniform(-180, 180)),
            'speed': float(rng.uniform(0, 30)),
            'course': float(rng.uniform(0, 359)),
            'second': int(NOW + k / A_SECOND) % 60,
        }
        static: dict[str, Any] = {'shipname': 'SOME SHIP', 'to_bow': 80, 'to_stern': 20}
        made = {'type': 5, **static, **fields} if k % 20 == 0 else {'type': 1, **fields}
        found += encode_dict(made, talker_id='AI', sentence_type='VDM', seq_id=k % 10)
    return found


def of_a_sentence(rng: np.random.Generator) -> float:
    """s from a line to its report, names among them."""
    lines, sentences = _lines(rng, LINES), Sentences()
    began = time.process_time()
    for k, line in enumerate(lines):
        sentences.take(line, NOW + k / A_SECOND)
        if k % 50 == 0:
            sentences.reports()
    return (time.process_time() - began) / len(lines)


def not_counted(rng: np.random.Generator) -> int:
    """Of broken sentences those that came to no outcome."""
    lines, sentences = _lines(rng, 200), Sentences()
    for k in range(BROKEN):
        line = bytearray(lines[int(rng.integers(len(lines)))].encode())
        for _ in range(int(rng.integers(1, 4))):
            line[int(rng.integers(len(line)))] = int(rng.integers(256))
        del line[int(rng.integers(len(line))) : int(rng.integers(len(line)))]
        sentences.take(bytes(line), NOW + 0.01 * k)
    return BROKEN - sentences.lines
