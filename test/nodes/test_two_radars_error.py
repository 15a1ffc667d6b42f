"""Two radars against one, measured on what tracker processes publish over DDS. Slow: 12 runs."""

import json
from typing import NamedTuple

import numpy as np
import pytest

pytest.importorskip('rclpy')
from nav_msgs.msg import Odometry
from scipy.stats import ttest_1samp
from sensor_msgs.msg import PointCloud2

from marine_tracker.evaluation.gospa import assign
from marine_tracker.lab.two_radars.two_radars import EVERY, SEEN_BY_BOTH, SETTLED, SILENT, WITHIN
from marine_tracker.nodes import convert, topics
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking.lifecycle import LOST
from marine_tracker.tracking.radars import TOPIC, fused, merged

RUNS, SEED = 12, 20
START = 1000  # s, stamp of the scene's begin
X, S = scenario.load('two_radars_x'), scenario.load('two_radars_s')
RADARS = {'radar_x': X, 'radar_s': S, 'radar_s_fails': S}
HEARS = {'x': ['radar_x'], 's': ['radar_s'], 'both': ['radar_x', 'radar_s_fails']}
DUE = np.arange(SETTLED, X.duration, EVERY)


class Course(NamedTuple):
    """error [T, ships] m and number [T, ships] of each ship's track; nan where it has none."""

    error: np.ndarray
    number: np.ndarray


class Sea:
    """Two radars on the air, one of them also as a radar that fails, and a tracker for each way."""

    def __init__(self, graph, launch, node_helpers, folder):
        self.wait, listener = node_helpers
        self.launch, self.node = launch, graph.bystander()
        self.plots = {
            name: self.node.create_publisher(PointCloud2, f'/{name}/{TOPIC}', topics.reliable(50))
            for name in RADARS
        }
        self.own = self.node.create_publisher(Odometry, f'/{topics.ODOMETRY}', topics.reliable(500))
        self.clouds = {
            way: listener(self.node, PointCloud2, f'/{way}/{topics.TRACKS_CLOUD}') for way in HEARS
        }
        self.files = {way: folder / f'{way}.yaml' for way in HEARS}
        for way, names in HEARS.items():
            given = fused(
                [RADARS[name].tracker_parameters() for name in names],
                [f'/{name}' for name in names],
            )
            self.files[way].write_text(
                json.dumps({'/**': {'ros__parameters': {**given, 'estimator': 'imm'}}})
            )

    def run(self, seed) -> dict[str, Course]:
        """One scene with noise of its own, as fast as the trackers take it."""
        of_x, of_s = (
            [scan for scan, _ in radar.simulate(one, part)]
            for one, part in zip(
                (X, S), np.random.SeedSequence(seed).generate_state(2).tolist(), strict=True
            )
        )
        trackers = [
            self.launch(
                'nodes.run tracker',
                '--ros-args',
                '--params-file',
                str(self.files[way]),
                '-r',
                f'__ns:=/{way}',
                '-r',
                f'{topics.ODOMETRY}:=/{topics.ODOMETRY}',
            )
            for way in HEARS
        ]
        self.all_hear(1)
        ends = {way: [] for way in HEARS}
        told = -np.inf
        for scan in merged(of_x, of_s):
            for time, position, velocity in zip(*scan.own_ship):
                if time > told:
                    self.own.publish(convert.own_ship_to_odometry(stamp(time), position, velocity))
                    told = time
            names = (
                ['radar_x']
                if scan.radar == 0
                else ['radar_s']
                if (SILENT[0] < scan.end < SILENT[1])
                else ['radar_s', 'radar_s_fails']
            )
            for name in names:
                self.plots[name].publish(convert.plots_to_cloud(scan, stamp(scan.start)))
            for way, hears in HEARS.items():
                if set(hears) & set(names):
                    ends[way].append(scan.end)
            self.wait(lambda: all(len(self.clouds[way]) == len(ends[way]) for way in HEARS))
        found = {way: follow(ends[way], self.clouds[way].messages) for way in HEARS}
        for tracker in trackers:
            tracker.stop()
        self.all_hear(0)
        for ears in self.clouds.values():
            ears.messages.clear()
        return found

    def all_hear(self, each):
        """Wait until every tracker is connected with all, or none is."""
        self.wait(
            lambda: (
                self.own.get_subscription_count() == each * len(HEARS)
                and all(
                    publisher.get_subscription_count()
                    == each * sum(name in names for names in HEARS.values())
                    for name, publisher in self.plots.items()
                )
                and all(ears.connected == bool(each) for ears in self.clouds.values())
            )
        )


def stamp(seconds):
    return round((START + seconds) * 1e9)


def follow(ends, clouds) -> Course:
    """The tracks of the last cloud before each moment, at the moment, against the ships.

    ends  s, of the scan that led to each cloud
    """
    ships = len(X.truth_at(0.0).target)
    course = Course(*np.full((2, len(DUE), ships), np.nan))
    for error, number, due in zip(*course, DUE.tolist(), strict=True):
        cloud = clouds[np.searchsorted(ends, due, 'right') - 1]
        rows = np.frombuffer(cloud.data, convert.TRACK_TYPE)
        rows = rows[(rows['number'] > 0) & (rows['status'] != LOST)]
        ahead = due + START - convert.nanoseconds(cloud.header.stamp) * 1e-9 - rows['time_offset']
        place = np.stack([rows['x'] + ahead * rows['vx'], rows['y'] + ahead * rows['vy']], -1)
        apart = np.linalg.norm(X.truth_at(due).position[:, None] - place, axis=-1)
        ship, track = assign(apart, WITHIN)
        error[ship], number[ship] = apart[ship, track], rows['number'][track]
    return course


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_both_with_one_failing_are_better_than_either_and_lose_no_track(
    graph, launch, node_helpers, tmp_path
):
    """Of 12 runs: the mean ratio's 95 % interval by Student's t, of its logarithm.

    S is silent from the turn of three ships on, for five minutes. All seven ships are followed at
    every moment; a track's number may change where that of the X band radar alone would.
    """
    sea = Sea(graph, launch, node_helpers, tmp_path)
    runs = [sea.run([SEED, run]) for run in range(RUNS)]
    rms = {
        way: np.sqrt([np.nanmean(run[way].error[:, :SEEN_BY_BOTH] ** 2) for run in runs])
        for way in HEARS
    }
    print({way: f'{np.sqrt((each**2).mean()):.2f} m' for way, each in rms.items()})
    for alone in ('x', 's'):
        log = np.log(rms['both'] / rms[alone])
        low, high = np.exp(ttest_1samp(log, 0.0).confidence_interval())
        print(f'both over {alone}: {np.exp(log.mean()):.3f} [{low:.3f}, {high:.3f}]')
        assert high < 1
    number = {way: np.array([run[way].number for run in runs]) for way in ('x', 'both')}
    changes = {way: int((each[:, 1:] != each[:, :-1]).sum()) for way, each in number.items()}
    print(f'{np.isnan(number["both"]).sum()} times without a track, changes of number {changes}')
    assert not np.isnan(number['both']).any()
    assert changes['both'] <= changes['x']  # in sharp turns, of which X alone misses more
