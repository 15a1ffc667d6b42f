"""The experiment `video` in a short form: its figures are there, and those that few runs can tell
are met."""

import numpy as np
import pytest

from marine_tracker.lab.video import false_alarms, points, rival, video, whole
from marine_tracker.simulation import picture


@pytest.mark.parametrize('kind', false_alarms.KINDS)
def test_false_alarms_come_at_the_rate_asked_for(kind):
    """Three revolutions, 1e-3: each octave expects 50 or more, so a factor of 1.6 is five
    deviations."""
    found = video.rates(kind, 1e-3, 3, 11)
    judged = found.ratio[np.isfinite(found.ratio)]
    assert len(judged) >= 6
    assert (judged < 1.6).all() and (judged > 1 / 1.6).all()


def test_detection_lies_near_the_curve_of_cell_averaging():
    share = false_alarms.detected(video.SNR, 1e-4, 6, 3)
    cells = false_alarms.reference_cells()
    assert abs(false_alarms.loss(video.SNR, share, 1e-4, cells)) < 1.5


def test_errors_of_points_are_those_of_the_bound_and_honest():
    errors = points.measure(20.0, 1, 5)
    range_, bearing = points.bound(20.0)
    assert len(errors.nis) == errors.targets > 300
    assert np.sqrt((errors.range**2).mean()) < 1.3 * range_
    assert np.sqrt((errors.bearing**2).mean()) < 1.3 * bearing
    assert errors.nis.mean() / 2 == pytest.approx(1.0, abs=0.2)


def test_the_bound_by_quadrature_has_its_known_ends():
    """Strong: ln z has variance 2 / r. Weak: the information of z - 1."""
    assert points.information(1e-5) == 1.0
    assert points.information(400.0) * 2 * 400.0 == pytest.approx(1.0, rel=0.01)


@pytest.mark.parametrize('apart', video.APART)
def test_pairs_are_resolved_in_half_of_the_scans(apart):
    assert points.resolved(*apart, video.PAIR_DB, 1, 2) >= 0.5


@pytest.mark.slow
def test_a_scene_of_a_minute_is_held_better_than_by_a_threshold_and_blobs():
    ours, theirs = whole.both(1.2, 1)
    assert ours.plots < theirs.plots / 5
    assert ours.false < theirs.false / 5


def test_blobs_lie_where_echoes_are():
    of = picture.form(512, 128, 2560.0, np.radians(3.0), 40.0)
    strength = np.zeros((512, 128), np.uint8)
    strength[100:106, 50:54] = 200
    time = np.linspace(0, 2, 512)
    plots = rival.blobs(strength, time, of.bearing, of.step, 128, 450.0)
    assert plots.range == pytest.approx([52 * 20.0])
    assert plots.bearing == pytest.approx([of.bearing[102:104].mean()])


def test_the_figures_have_names_limits_and_pictures():
    done = []
    result = video.run(1, 1, lambda k, n: done.append((k, n)), minutes=0.0)
    names = [figure.name for figure in result.figures]
    assert len(set(names)) == len(names) and len(names) > 30
    assert [p.name for p in result.pictures][:2] == ['video_false_alarms', 'video_detection']
    assert done
