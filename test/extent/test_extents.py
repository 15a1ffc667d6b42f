"""Whole scans through tracker and extents, on simulated hulls and land."""

from itertools import islice

import numpy as np
import pytest

from marine_tracker.extent.clustering import Gates
from marine_tracker.extent.extents import one_a_ship
from marine_tracker.extent.hulls import BY_GAUSSIAN_PROCESS, BY_RANDOM_MATRIX
from marine_tracker.lab.hulls import at_sea
from marine_tracker.lab.hulls.at_sea import FINE, Case
from marine_tracker.parameters import TrackerParameters
from marine_tracker.service import Service
from marine_tracker.simulation import radar, scenario
from marine_tracker.tracking.lifecycle import CONFIRMED, LOST
from marine_tracker.tracking.tracker import Tracker
from marine_tracker.types import PolarPlots


class Run:
    """A tracker with extents, fed scan by scan."""

    def __init__(self, parameters, extent):
        self.parameters = TrackerParameters(**parameters | {'extent': extent})
        self.service = Service(self.parameters)
        self.memory = self.service.start()

    def step(self, scan):
        self.memory, (self.plain, self.report, self.estimate, self.shapes) = self.service.track(
            self.memory, scan
        )
        return self.report

    def become(self, extent):
        old = self.service
        self.service = Service(TrackerParameters(**{**vars(self.parameters), 'extent': extent}))
        self.memory = self.service.adopt(self.memory, old)


@pytest.fixture(scope='module')
def one_ship():
    """200 m by 32 m, abeam at 1 km: the first 40 scans and what the tracker is told."""
    loaded = at_sea.scene(Case(200, 1000.0, 90.0, FINE))
    return loaded, list(radar.simulate(loaded, 11))[:40]


def test_extent_off_passes_plots_untouched(one_ship):
    loaded, scans = one_ship
    plain, off = (
        Tracker(TrackerParameters(**loaded.tracker_parameters())),
        Run(loaded.tracker_parameters(), 'none'),
    )
    memory = plain.start()
    for scan, _ in scans[:8]:
        memory, report = plain.step(memory, scan)
        assert np.array_equal(off.step(scan).tracks.id, report.tracks.id)
        assert off.plain is scan and off.shapes is None


@pytest.mark.parametrize('extent, length, centre', [('random_matrix', 20, 20), ('gp', 20, 8)])
def test_ship_is_one_track_with_her_length_heading_and_centre(one_ship, extent, length, centre):
    loaded, scans = one_ship
    run = Run(loaded.tracker_parameters(), extent)
    for scan, _ in scans:
        report = run.step(scan)
    truth = scans[-1][1]
    assert report.tracks.id.tolist() == [1] and len(run.plain.plots.time) == 1
    shapes = run.shapes
    assert shapes.extended.all() and shapes.length[0] == pytest.approx(200, abs=length)
    assert shapes.beam[0] > 25
    assert np.degrees(shapes.heading[0]) == pytest.approx(135, abs=4)
    assert shapes.method[0] == (BY_GAUSSIAN_PROCESS if extent == 'gp' else BY_RANDOM_MATRIX)
    there = truth.position[0] + (report.time[0] - truth.time[0]) * truth.velocity[0]
    at = run.estimate.position[0]
    assert np.hypot(*(at - there)) < centre
    # The outline is drawn about the track: its corners' middle is the ship's, too.
    corners = at + shapes.outline[0]
    assert np.hypot(*(0.5 * (corners.max(0) + corners.min(0)) - there)) < centre


def test_size_and_track_live_through_an_empty_scan(one_ship):
    loaded, scans = one_ship
    run = Run(loaded.tracker_parameters(), 'gp')
    for scan, _ in scans[:20]:
        run.step(scan)
    before = run.shapes.length
    none = np.zeros(0)
    run.step(scans[20][0]._replace(plots=PolarPlots(none, none, none, none)))
    assert run.shapes.length == pytest.approx(before, rel=0.02)
    for scan, _ in scans[21:24]:
        assert run.step(scan).tracks.id.tolist() == [1]


def test_extents_can_be_switched_while_tracks_live(one_ship):
    loaded, scans = one_ship
    run = Run(loaded.tracker_parameters(), 'random_matrix')
    for k, (scan, _) in enumerate(scans[:24]):
        if k in (8, 12, 16):
            run.become({8: 'gp', 12: 'none', 16: 'random_matrix'}[k])
        run.step(scan)
        assert (run.shapes is None) == (12 <= k < 16)
    assert 1 in run.report.tracks.id.tolist()
    assert run.shapes.length[run.report.tracks.id == 1] > 100


def test_extents_can_be_switched_on_in_an_empty_scan(one_ship):
    loaded, scans = one_ship
    run = Run(loaded.tracker_parameters(), 'none')
    for scan, _ in scans[:6]:
        run.step(scan)
    run.become('gp')
    none = np.zeros(0)
    run.step(scans[6][0]._replace(plots=PolarPlots(none, none, none, none)))
    assert len(run.report.tracks.id) > 2  # on parts of her
    for scan, _ in scans[7:]:
        run.step(scan)
    assert len(run.report.tracks.id) <= 2
    assert run.shapes.length.max() == pytest.approx(200, abs=30)


def test_cluster_plot_tells_a_covariance_that_its_error_bears_out(one_ship):
    """Squared distance of plot and truth: two degrees of freedom, so 2 on average; the lit side
    draws all plots the same way, so less than 3 is asked of the mean."""
    loaded, scans = one_ship
    run = Run(loaded.tracker_parameters(), 'random_matrix')
    nis = []
    for scan, truth in scans:
        run.step(scan)
        plots = run.plain.plots
        unit = np.stack([np.sin(plots.bearing), np.cos(plots.bearing)], -1)
        off = plots.range[:, None] * unit - truth.position[0]
        nis.append(off[0] @ np.linalg.solve(plots.covariance[0], off[0]))
    assert np.mean(nis[5:]) < 3


def test_a_coast_gives_hardly_any_track_and_no_ship_is_lost_by_it():
    loaded = scenario.load('coast')
    runs = [Run(loaded.tracker_parameters(), extent) for extent in ('none', 'random_matrix')]
    confirmed = [set(), set()]
    scans = list(islice(radar.simulate(loaded, 5), 25))
    for scan, _ in scans:
        for run, found in zip(runs, confirmed):
            report = run.step(scan)
            found.update(report.tracks.id[report.tracks.status == CONFIRMED].tolist())
    assert len(confirmed[0]) > 200 and len(confirmed[1]) <= 0.1 * len(confirmed[0])
    assert run.memory.extents.shores > 5
    truth, alive = scans[-1][1], report.tracks.status != LOST
    at = run.estimate.position[alive]
    for position, length in zip(truth.position, loaded.fleet.length):
        assert np.hypot(*(at - position).T).min() < 40 + 0.1 * length


def test_parts_of_a_hull_become_one_unless_both_are_known_for_long():
    area = np.tile(np.diag([400.0, 2500.0]), (3, 1, 1))
    gates = Gates(
        np.zeros(3),
        np.array([[0.0, 0], [0, 80], [300, 0]]),
        np.array([[0.0, 6], [0.3, 6], [0, 6]]),
        area,
    )
    certain = np.tile(0.1 * np.eye(2), (3, 1, 1))
    merged, kept = one_a_ship(gates, certain, np.array([False, True, True]))
    assert kept.tolist() == [0, 2]
    for point in ([0, 125], [0, -45]):
        offset = point - merged.middle[0]
        assert offset @ np.linalg.solve(merged.area[0], offset) < 1
    _, kept = one_a_ship(gates, certain, np.zeros(3, bool))
    assert kept.tolist() == [0, 1, 2]
    apart = gates._replace(velocity=np.array([[0.0, 6], [0, -6], [0, 6]]))
    assert one_a_ship(apart, certain, np.ones(3, bool))[1].tolist() == [0, 1, 2]
