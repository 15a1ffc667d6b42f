import json

import numpy as np
import pytest

from marine_tracker import cli
from marine_tracker.estimators import ESTIMATORS
from marine_tracker.evaluation import benchmark


@pytest.fixture(autouse=True)
def short(monkeypatch):
    """Kept targets and errors are judged here, not times."""
    monkeypatch.setattr(benchmark, 'TURN_CPU', 0.001)


def test_the_same_seed_gives_the_same_traffic():
    one, two, other = (benchmark.traffic(20, 10, 5, seed) for seed in (3, 3, 4))
    np.testing.assert_array_equal(one.position, two.position)
    for a, b in zip(one.scans, two.scans, strict=True):
        np.testing.assert_array_equal(a.plots.range, b.plots.range)
        np.testing.assert_array_equal(a.plots.bearing, b.plots.bearing)
    assert not np.array_equal(one.position, other.position)


def test_the_traffic_is_what_it_says():
    """1,000 targets, 500 false plots, 30 scans: 24 NM, 30 kn, 90 % seen, one time a scan."""
    scene = benchmark.traffic(1000, 500, 30, 1)
    assert scene.position.shape == scene.velocity.shape == (30, 1000, 2)
    np.testing.assert_allclose(
        np.diff(scene.position, axis=0), scene.velocity[:-1] * 60 / 22, atol=1e-6
    )
    assert np.hypot(*scene.velocity[0].T).max() <= 30 * 1852 / 3600
    assert np.hypot(*scene.position[0].T).max() <= 24 * 1852
    turned = np.abs(scene.velocity[-1] - scene.velocity[0]).max(1) > 1e-9
    assert turned.sum() == 100
    counts = np.array([len(scan.plots.range) for scan in scene.scans])
    # 30,000 chances: the share seen is known to 4 sqrt(.9 * .1 / 30,000) = 0.7 %.
    assert abs((counts.mean() - 500) / 1000 - 0.9) < 0.007
    for k, scan in enumerate(scene.scans):
        assert (scan.plots.time == scan.start).all() and scan.start == scan.end
        assert scan.start == pytest.approx(k * 60 / 22)
        assert ((scan.plots.bearing >= 0) & (scan.plots.bearing < 2 * np.pi)).all()


def test_the_plots_lie_where_the_targets_are():
    """No clutter, every plot within 6 deviations of its target."""
    scene = benchmark.traffic(50, 0, 6, 2)
    for scan, truth in zip(scene.scans, scene.position, strict=True):
        place = scan.plots.range[:, None] * np.stack(
            [np.sin(scan.plots.bearing), np.cos(scan.plots.bearing)], -1
        )
        apart = np.hypot(*(place[:, None] - truth).transpose(2, 0, 1)).min(1)
        assert (apart < 6 * np.hypot(20, scan.plots.range * np.radians(0.5))).all()


@pytest.mark.parametrize('estimator', list(ESTIMATORS))
def test_this_tracker_keeps_the_targets(estimator):
    results = benchmark.benchmark(100, 50, [estimator], 4, 5, alone=True)
    assert set(results) == {estimator}
    found = results[estimator]
    assert found.kept >= 0.93
    # The plots' own error over 24 NM, root mean square, is about 275 m an axis pair.
    assert 0 < found.rmse < 300
    assert 0 < found.estimator_s < found.cpu_s


def test_a_tracker_without_tracks_keeps_nothing():
    """The judge's own check: of tracks elsewhere none counts."""
    scene = benchmark.traffic(10, 0, benchmark.WARM_UP + 3, 5)
    far = [np.full((10, 2), 1e6)] * 3
    turns = [benchmark.BenchmarkResult(1.0, 0.5, far)]
    lost = benchmark._result(turns, far, scene)
    assert lost.kept == 0 and np.isnan(lost.rmse)
    none = benchmark._result(turns, [np.zeros((0, 2))] * 3, scene)
    assert none.kept == 0
    right = benchmark._result(turns, list(scene.position[benchmark.WARM_UP :]), scene)
    assert right.kept == 1 and right.rmse == 0


def test_stone_soup_keeps_the_targets_in_the_same_run():
    pytest.importorskip('stonesoup', reason='Stone Soup (extra bench) is not installed')
    results = benchmark.benchmark(20, 20, ['cs_kalman'], 5, 7)
    assert set(results) == {'cs_kalman', benchmark.STONE_SOUP, benchmark.JPDA}
    ours, theirs = results['cs_kalman'], results['Stone Soup']
    assert theirs.kept >= 0.9 and ours.kept >= 0.9
    assert theirs.cpu_s > 5 * ours.cpu_s, 'far from the hundreds of larger scenes, but never near'


def command(capsys, *words):
    assert (
        cli.main(
            [
                'bench',
                '--tracks',
                '15',
                '--clutter',
                '5',
                '--scans',
                '2',
                '--alone',
                '--json',
                '-',
                *words,
            ]
        )
        == 0
    )
    return {figure['name']: figure for figure in json.loads(capsys.readouterr().out)['figures']}


def test_the_command_tells_cost_and_ratio_to_cs_kalman(capsys):
    """The ratio is that of the times told beside it."""
    figures = command(capsys, '--estimator', 'imm')
    for name in ('imm', 'cs_kalman'):
        assert {
            f'{name}: of that, extrapolation and update',
            f'{name}: targets kept',
            f'{name}: position RMSE',
        } <= set(figures)
    ratio = figures['imm: ratio of a scan']
    whole = {name: figures[f'{name}: CPU time of a scan']['value'] for name in ('imm', 'cs_kalman')}
    assert ratio['value'] == pytest.approx(whole['imm'] / whole['cs_kalman'])
    assert ratio['against'] == 'cs_kalman' and ratio['limit'] is None, 'limits are of 1,000 targets'


def test_all_estimators_are_measured_in_one_run(capsys):
    figures = command(capsys, '--estimator', 'all')
    for name in ESTIMATORS:
        assert f'{name}: CPU time of a scan' in figures
    assert 'cs_kalman: ratio of a scan' not in figures


@pytest.mark.parametrize('wrong', [('--tracks', '0'), ('--clutter', '-1'), ('--scans', '0')])
def test_a_wrong_size_is_refused_by_name(wrong, capsys):
    assert cli.main(['bench', *wrong]) != 0
    assert wrong[0] in capsys.readouterr().err
