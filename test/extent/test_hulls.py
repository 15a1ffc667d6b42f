"""Rows of targets: started, handed over to an outline and back, frozen, held."""

import numpy as np
import pytest

from marine_tracker.extent import hulls
from marine_tracker.extent.clustering import Clusters
from marine_tracker.extent.hulls import BY_GAUSSIAN_PROCESS, BY_RANDOM_MATRIX
from marine_tracker.extent.lit_edge import Edge
from marine_tracker.types import Extrapolation

PERIOD, SPEED = 60 / 22, 6.0
LENGTH, BEAM, SIGMA = 200.0, 32.0, 3.0
OWN = np.array([2000.0, 0.0])  # to the east: her starboard side is lit


class Sea:
    """Ships that go due north side by side, 500 m apart; points of their starboard sides."""

    def __init__(self, ships=1, seed=1, outlines=True):
        self.rng, self.ids, self.k = np.random.default_rng(seed), np.arange(ships) + 5, 0
        self.known = hulls.begin(outlines)

    @property
    def middle(self):
        return np.column_stack(
            [-500.0 * (self.ids - 5), np.full(len(self.ids), SPEED * PERIOD * self.k)]
        )

    def step(self, count=20, crowded=False, seen=True, turned=0.0, sigma=SIGMA):
        """One scan: `count` points a ship, of hulls `turned` rad off their course."""
        ships = len(self.ids)
        place = np.column_stack(
            [
                np.full(ships * count, BEAM / 2),
                self.rng.uniform(-LENGTH / 2, LENGTH / 2, ships * count),
            ]
        )
        sin, cos = np.sin(turned), np.cos(turned)
        place = place @ np.array([[cos, -sin], [sin, cos]])
        of = np.repeat(np.arange(ships), count)
        cells = self.middle[of] + place + sigma * self.rng.standard_normal(place.shape)
        centroid = cells.reshape(ships, count, 2).mean(1)
        off = cells.reshape(ships, count, 2) - centroid[:, None]
        noise = np.tile(SIGMA**2 * np.eye(2), (ships, 1, 1))
        nothing, mask = np.zeros(ships), np.full(ships, crowded)
        clusters = Clusters(
            nothing,
            centroid,
            off.swapaxes(1, 2) @ off,
            np.full(ships, count),
            noise,
            nothing,
            nothing,
            np.full(ships, -1),
            mask,
            mask & False,
            of,
        )
        tracked = Extrapolation(
            np.full(ships, PERIOD * self.k),
            centroid,
            np.tile([0.0, SPEED], (ships, 1)),
            np.tile(np.diag([25.0, 25, 1, 1]), (ships, 1, 1)),
        )
        taken = np.arange(ships) if seen else np.full(ships, -1)
        self.known = hulls.step(
            self.known,
            self.ids,
            tracked.time,
            tracked,
            clusters,
            taken,
            Edge(of, cells, noise),
            OWN,
        )
        self.k += 1
        return self.known


def test_an_outline_takes_over_after_ten_clusters_and_finds_the_centre():
    sea = Sea(ships=12)
    methods = [sea.step().method.copy() for _ in range(30)]
    assert (np.array(methods[:9]) == BY_RANDOM_MATRIX).all()
    assert (np.array(methods[12:]) == BY_GAUSSIAN_PROCESS).all()
    middle = sea.middle - [0, SPEED * PERIOD]
    plain, outlined = (
        np.hypot(*(mean[:, :2] - middle).T).mean()
        for mean in (sea.known.matrix.mean, sea.known.outline.mean)
    )
    assert plain > 12 and outlined < 0.5 * plain


@pytest.mark.parametrize(
    'change',
    [
        {'count': 8},  # too few cells
        {'sigma': 3.0, 'crowded': True},
    ],
)  # another hull touches
def test_no_outline_without_cells_of_her_own(change):
    sea = Sea()
    for _ in range(20):
        known = sea.step(**change)
    assert known.method == [BY_RANDOM_MATRIX]


def test_no_outline_where_none_was_asked_for():
    sea = Sea(outlines=False)
    for _ in range(15):
        known = sea.step()
    assert known.outline is None and known.method == [BY_RANDOM_MATRIX]


@pytest.mark.parametrize('change', [{'turned': np.radians(25)}, {'sigma': 25.0}])
def test_outline_that_is_contradicted_is_given_up(change):
    """A hull that lies across her course, or cells that are nowhere near it."""
    sea = Sea()
    for _ in range(16):
        known = sea.step()
    assert known.method == [BY_GAUSSIAN_PROCESS]
    fell = False
    for _ in range(25):
        fell |= bool(sea.step(**change).method == [BY_RANDOM_MATRIX])
    assert fell


def test_empty_scan_holds_and_a_crowded_one_freezes():
    sea = Sea()
    for _ in range(16):
        before = sea.step()
    for change in ({'seen': False}, {'crowded': True}):
        after = sea.step(**change)
        assert np.array_equal(after.matrix.extent, before.matrix.extent)
        assert np.array_equal(after.outline.mean[:, 6:], before.outline.mean[:, 6:])
        assert after.scans == before.scans
    # It went on with her meanwhile.
    assert np.hypot(*(after.outline.mean[0, :2] - sea.middle[0] + [0, SPEED * PERIOD])) < 15


def test_rows_follow_the_tracks_ids():
    sea = Sea(ships=3)
    for _ in range(4):
        sea.step()
    x = sea.known.matrix.mean[:, 0]
    sea.ids = np.array([7, 5])  # 6 is lost, the others come in another order
    known = sea.step()
    assert known.id.tolist() == [7, 5]
    assert known.matrix.mean[:, 0] == pytest.approx(x[[2, 0]], abs=5)
    sea.ids = np.array([7, 5, 9])
    known = sea.step()
    assert known.id.tolist() == [7, 5, 9] and known.scans.tolist() == [6, 6, 1]


def test_track_without_a_cluster_starts_with_no_idea_of_size():
    sea = Sea()
    known = sea.step(seen=False)
    assert known.scans == [0] and np.isfinite(known.matrix.extent).all()
    for _ in range(8):
        known = sea.step()
    found = hulls.shapes(known, np.tile(SIGMA**2 * np.eye(2), (1, 1, 1)), sea.middle)
    assert found.extended == [True] and found.length[0] == pytest.approx(LENGTH, rel=0.15)


def test_heading_comes_from_the_course_under_way_and_from_the_axis_at_rest():
    sea = Sea()
    for _ in range(9):
        known = sea.step()
    noise = np.tile(SIGMA**2 * np.eye(2), (1, 1, 1))
    certain = known.matrix.covariance * np.diag([1, 1, 0.1, 0.1]) * np.diag([1, 1, 0.1, 0.1])[None]
    known = known._replace(matrix=known.matrix._replace(covariance=certain))
    under_way = hulls.shapes(known, noise, sea.middle)
    assert hulls.SOURCES[under_way.source[0]] == 'course'
    at_rest = known._replace(
        matrix=known.matrix._replace(mean=known.matrix.mean * [1, 1, 0.01, 0.01])
    )
    found = hulls.shapes(at_rest, noise, sea.middle)
    assert hulls.SOURCES[found.source[0]] == 'axis'
    for shapes in (under_way, found):
        off = (np.degrees(shapes.heading[0]) + 180) % 360 - 180
        assert abs(off) < 5


def test_length_is_that_of_cells_spread_over_the_hull_and_its_fringe():
    """A rod whose cells lie evenly over L + 2 F, as a radar shows them: L comes out."""
    noise = np.diag([1.0, 100.0])[None]
    fringe = 1.1 * 10.0
    variance = (LENGTH + 2 * fringe) ** 2 / 12
    sea = Sea()
    matrix = sea.step().matrix
    extent = 4 * (np.diag([30.0, variance])[None] - noise * [[1, 0], [0, 1]])
    found = hulls.size(matrix._replace(extent=np.abs(extent)), noise)
    exact = np.sqrt(12 * (variance - 100) + 4 * fringe**2) - 2 * fringe
    assert found.length[0] == pytest.approx(exact) == pytest.approx(LENGTH, abs=2)
