import numpy as np
import pytest

from marine_tracker.extent import clustering
from marine_tracker.extent.clustering import Gates, cluster, in_gates
from marine_tracker.geometry import to_range_bearing, wrap_angle
from marine_tracker.types import Plots

DEPTH, BEAM = 10.0, np.radians(0.75)
NO_GATES = Gates(np.zeros(0), np.zeros((0, 2)), np.zeros((0, 2)), np.zeros((0, 2, 2)))


def plots(position, time=0.0):
    position = np.asarray(position, float)
    count = len(position)
    range_, bearing = to_range_bearing(position)
    return Plots(
        np.full(count, time),
        range_,
        bearing,
        np.arange(count) % 30.0,
        np.zeros((count, 2)),
        position,
        np.tile(np.eye(2), (count, 1, 1)),
    )


def line(start, end, count):
    return np.linspace(start, end, count)


def gate(middle, half_length, half_beam, velocity=(0.0, 0.0), time=0.0):
    """Of hulls that lie north-south, one row for each middle."""
    middle = np.reshape(np.asarray(middle, float), (-1, 2))
    area = np.tile(np.diag([float(half_beam) ** 2, half_length**2]), (len(middle), 1, 1))
    return Gates(np.full(len(middle), time), middle, np.tile(velocity, (len(middle), 1)), area)


def sets(labels):
    return {frozenset(np.flatnonzero(labels == label).tolist()) for label in np.unique(labels)}


@pytest.mark.parametrize('seed', range(3))
def test_clusters_are_the_connected_components_of_cells_that_touch(seed):
    """Against a walk from cell to cell; at 1 and 4 km, where beams are narrow and wide."""
    rng = np.random.default_rng(seed)
    bearing = rng.uniform(-0.3, 0.3, 300)
    distance = rng.choice([1000.0, 4000.0], 300) + rng.uniform(0, 400, 300)
    cells = plots(distance[:, None] * np.stack([np.sin(bearing), np.cos(bearing)], -1))
    touch = np.zeros((300, 300), bool)
    for i in range(300):
        for j in range(300):
            near = np.hypot(*(cells.position[i] - cells.position[j])) <= 40
            touch[i, j] = near or (
                abs(distance[i] - distance[j]) <= 1.5 * DEPTH
                and abs(wrap_angle(bearing[i] - bearing[j])) <= 1.5 * BEAM
            )
    expected, left = set(), set(range(300))
    while left:
        part, edge = set(), {left.pop()}
        while edge:
            part |= edge
            edge = set(np.flatnonzero(touch[list(edge)].any(0)).tolist()) - part
        left -= part
        expected.add(frozenset(part))
    found, _ = cluster(cells, DEPTH, BEAM, in_gates(cells, NO_GATES))
    assert 10 < len(expected) < 200
    assert sets(found.of_cell) == expected
    assert found.cells.sum() == 300 and not found.crowded.any() and (found.gate == -1).all()


def test_cluster_tells_centroid_scatter_size_and_strongest_cell():
    rng = np.random.default_rng(4)
    position = np.array([900.0, 900.0]) + rng.uniform(-20, 20, (25, 2))
    cells = plots(position)
    found, _ = cluster(cells, DEPTH, BEAM, in_gates(cells, NO_GATES))
    assert found.cells == [25] and found.amplitude == [24.0]
    assert found.position[0] == pytest.approx(position.mean(0))
    assert found.scatter[0] == pytest.approx(25 * np.cov(position.T, bias=True))
    along = np.linalg.eigh(np.cov(position.T))[1][:, -1]
    assert found.size[0] == pytest.approx(np.ptp(position @ along))
    assert np.linalg.eigvalsh(found.noise[0]) == pytest.approx(
        [(0.4 * BEAM * np.hypot(*position.mean(0))) ** 2, (0.55 * DEPTH) ** 2][::-1], rel=1e-2
    )


def test_cells_of_one_gate_are_one_cluster_though_they_do_not_touch():
    cells = plots(
        np.concatenate([line([1000, 1000], [1000, 1050], 6), line([1000, 1110], [1000, 1160], 6)])
    )
    alone, _ = cluster(cells, DEPTH, BEAM, in_gates(cells, NO_GATES))
    assert len(alone.cells) == 2
    held, _ = cluster(cells, DEPTH, BEAM, in_gates(cells, gate([1000, 1080], 110, 30)))
    assert held.cells.tolist() == [12] and held.gate.tolist() == [0] and not held.crowded.any()


def test_ships_side_by_side_stay_two_and_are_crowded():
    cells = plots(
        np.concatenate([line([1000, 1000], [1000, 1150], 12), line([1030, 1000], [1030, 1150], 12)])
    )
    found, _ = cluster(
        cells, DEPTH, BEAM, in_gates(cells, gate([[1000, 1075], [1030, 1075]], 110, 20))
    )
    assert found.cells.tolist() == [12, 12] and sorted(found.gate) == [0, 1]
    assert found.crowded.all()


def test_what_sticks_out_of_a_gate_belongs_to_it_but_a_coast_does_not():
    ship = line([1000, 1000], [1000, 1150], 12)
    for far, cells_of_ship in ((1250, 18), (1800, 12)):
        cells = plots(np.concatenate([ship, line([1000, 1160], [1000, far], (far - 1160) // 15)]))
        found, _ = cluster(cells, DEPTH, BEAM, in_gates(cells, gate([1000, 1075], 80, 20)))
        own = found.gate == 0
        assert found.cells[own].tolist() == [cells_of_ship]
        assert found.crowded[own][0] == (far == 1800)


def test_land_is_never_drawn_into_a_hull():
    cells = plots(
        np.concatenate([line([1000, 1000], [1000, 1150], 12), line([1030, 1000], [1060, 1100], 8)])
    )
    place = in_gates(cells, gate([1000, 1075], 85, 10))
    found, _ = cluster(cells, DEPTH, BEAM, place._replace(land=np.arange(20) >= 12))
    assert found.cells[found.gate == 0].tolist() == [12]
    assert found.land.tolist() == (found.gate == -1).tolist()


def test_a_ship_over_north_is_one_cluster():
    cells = plots(line([-80, 1500], [80, 1500], 12))
    assert cells.bearing.max() > 6 and cells.bearing.min() < 0.1
    assert cluster(cells, DEPTH, BEAM, in_gates(cells, NO_GATES))[0].cells.tolist() == [12]


def test_gates_move_with_their_targets():
    cells = plots([[1000.0, 1100.0]], time=10.0)
    at = in_gates(cells, gate([1000, 1000], 30, 30, velocity=(0.0, 10.0)))
    assert at.gate.tolist() == [0] and at.off == pytest.approx([0.0], abs=1e-9)
    assert in_gates(cells, gate([1000, 1000], 30, 30)).gate.tolist() == [-1]


def test_no_cells_no_clusters():
    cells = plots(np.empty((0, 2)))
    assert len(cluster(cells, DEPTH, BEAM, in_gates(cells, gate([0, 0], 9, 9)))[0].cells) == 0


@pytest.mark.parametrize('middle', [(900.0, 300.0), (0.0, 5000.0)])
def test_in_a_crowd_the_clusters_are_those_of_all_pairs(middle, monkeypatch):
    """Three crowds too far apart to touch, one over north; two gates share one of them."""
    rng = np.random.default_rng(6)
    places = np.asarray(middle) + np.concatenate(
        [[shift, 0] + rng.uniform(-30, 30, (150, 2)) for shift in (-500, 0, 500)]
    )
    cells = plots(places)
    place = in_gates(cells, gate([np.add(middle, (-8, 0)), np.add(middle, (8, 0))], 12, 7))
    expected, none = cluster(cells, DEPTH, BEAM, place)
    monkeypatch.setattr(clustering, 'LINKS', 2000)
    found, left_out = cluster(cells, DEPTH, BEAM, place)
    assert none == 0 and left_out > 2000
    assert sets(found.of_cell) == sets(expected.of_cell)
    assert len(expected.cells) >= 4
    np.testing.assert_array_equal(found.crowded, expected.crowded)


def test_cells_at_one_place_are_one_cluster(monkeypatch):
    monkeypatch.setattr(clustering, 'LINKS', 50)
    cells = plots(np.tile([700.0, -900.0], (600, 1)))
    found, left_out = cluster(cells, DEPTH, BEAM, in_gates(cells, NO_GATES))
    assert found.cells.tolist() == [600]
    assert left_out > 300_000  # 2 lists of 179,700 pairs


def test_gates_are_looked_through_in_parts_to_the_same_end(monkeypatch):
    rng = np.random.default_rng(7)
    cells = plots(rng.uniform(500, 900, (90, 2)))
    gates = gate(rng.uniform(500, 900, (12, 2)), 80, 30)
    whole = in_gates(cells, gates)
    monkeypatch.setattr(clustering, 'AT_ONCE', 100)
    for part, all_at_once in zip(in_gates(cells, gates), whole):
        np.testing.assert_array_equal(part, all_at_once)
    assert len(np.unique(whole.gate)) > 5
