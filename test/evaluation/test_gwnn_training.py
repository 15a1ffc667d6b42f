"""What the wavelet network is trained on, by, and that training can be stopped and repeated."""

import numpy as np
import pytest

from marine_tracker.estimators import gwnn, gwnn_inputs
from marine_tracker.evaluation import gwnn_training, held_out_tracks, ship_tracks, track_trials
from marine_tracker.evaluation.experiments import gwnn_monte_carlo
from marine_tracker.networks import wavelet_network as net
from marine_tracker.types import take

PERIOD = 60 / 22


@pytest.fixture(scope='module')
def samples():
    return gwnn_training.make_samples(900, 0)


class TestTracks:
    @pytest.mark.parametrize('kind', ship_tracks.KINDS)
    def test_each_kind_moves_as_it_says(self, kind):
        count, scans = 200, 120
        ships = ship_tracks.sail([kind] * count, np.full(count, 9000.0),
                                 np.full((count, scans), PERIOD), np.random.default_rng(1))
        about = ship_tracks.KINDS[kind]
        step = np.diff(ships.position, axis=1)
        between = 0.5 * (ships.velocity[:, 1:] + ships.velocity[:, :-1])
        # Velocity is the slope of the position, but for what one scan of a turn bends.
        off = np.hypot(*np.moveaxis(step / PERIOD - between, -1, 0))
        assert np.quantile(off, 0.9) < (2.0 if kind == 'agile' else 0.5)
        acceleration = np.diff(ships.velocity, axis=1) / PERIOD
        size = np.hypot(*np.moveaxis(acceleration, -1, 0))
        assert size.max() < about.lateral + 0.2
        calm = ~ships.manoeuvre[:, 1:] & ~ships.manoeuvre[:, :-1]
        assert size[calm].max(initial=0.0) < 0.07       # slow drift of speed and course at most
        if about.weave:
            assert ships.manoeuvre.all()
        else:
            begun = (ships.manoeuvre[:, 1:] & ~ships.manoeuvre[:, :-1]).sum()
            free = (~ships.manoeuvre).sum()
            assert begun <= about.begin * free * 1.3 + 1e-9
            assert begun >= about.begin * free * 0.7
        if kind == 'steady':
            np.testing.assert_allclose(np.diff(ships.velocity, axis=1), 0.0, atol=1e-9)

    def test_plots_have_the_noise_outliers_and_gaps_asked_for(self):
        count, scans, every = 300, 40, np.ones(300)
        ships = ship_tracks.sail(['steady'] * count, np.full(count, 8000.0),
                                 np.full((count, scans), PERIOD), np.random.default_rng(2))
        radar = ship_tracks.Radar(20 * every, 0.005 * every, 0.8 * every, 0.0 * every, 2 * every,
                                  PERIOD * every)
        plots, seen = ship_tracks.observe(ships, radar, np.random.default_rng(3))
        off = np.stack([p.range for p in plots], 1) - np.hypot(*np.moveaxis(ships.position, -1, 0))
        assert off.std() == pytest.approx(40.0, rel=0.03)          # twice the stated 20 m
        assert seen[:, :2].all()
        assert seen[:, 2:].mean() == pytest.approx(0.8, abs=0.02)
        wild = radar._replace(outliers=0.05 * every)
        plots, _ = ship_tracks.observe(ships, wild, np.random.default_rng(3))
        off = np.stack([p.range for p in plots], 1) - np.hypot(*np.moveaxis(ships.position, -1, 0))
        # A twentieth has 5 more deviations on top: 4 of its own are passed by 44 % of them.
        assert (np.abs(off) > 4 * 40).mean() == pytest.approx(0.05 * 0.433, rel=0.2)

    def test_a_manoeuvre_is_felt_for_some_scans(self):
        manoeuvre = np.zeros((1, 20), bool)
        manoeuvre[0, 3] = True
        assert ship_tracks.phase(manoeuvre)[0].tolist() == [False] * 3 + [True] * 9 + [False] * 8

    def test_ships_under_autopilot_and_the_papers_turn(self):
        steps = np.full((100, 150), PERIOD)
        ships = held_out_tracks.nomoto(steps, np.random.default_rng(4))
        assert 0.1 < ships.manoeuvre.mean() < 0.6
        turn = held_out_tracks.paper_turn(steps, np.random.default_rng(4))
        course = np.unwrap(np.arctan2(turn.velocity[0, :, 0], turn.velocity[0, :, 1]))
        assert np.degrees(course[0]) == pytest.approx(70)
        assert np.degrees(course[-1] - course[0]) == pytest.approx(50, abs=1.0)
        assert np.flatnonzero(turn.manoeuvre[0])[0] == 100
        np.testing.assert_allclose(turn.position[0, 0], 4600 * np.array([0.5, np.sqrt(0.75)]))

    def test_real_ships_and_boats_move_as_recorded(self, recordings):
        steps = np.full((30, 100), PERIOD)
        rng = np.random.default_rng(5)
        ships = held_out_tracks.real_ships(recordings / gwnn_monte_carlo.AIS, steps, rng)
        speed = np.hypot(*np.moveaxis(ships.velocity, -1, 0))
        assert 1 < np.median(speed) < 12
        assert 10 <= ships.manoeuvre[:, 20:].any(1).sum() <= 25
        boats = held_out_tracks.recorded_boats(recordings / gwnn_monte_carlo.BOAT, steps, rng)
        speed = np.hypot(*np.moveaxis(boats.velocity, -1, 0))
        assert 1 < np.median(speed) < 12 and boats.manoeuvre.mean() > 0.5


class TestSamples:
    def test_they_are_sound_and_repeatable(self, samples):
        assert len(samples.cell) > 10000
        for array in samples:
            assert np.isfinite(array).all()
        again = gwnn_training.make_samples(900, 0)
        np.testing.assert_array_equal(again.seen, samples.seen)
        assert gwnn_training.make_samples(900, 1).seen[0, 0] != samples.seen[0, 0]

    def test_every_kind_and_phase_is_there(self, samples):
        count = np.bincount(samples.cell, minlength=gwnn_training.cell_count()).reshape(7, 2, 2, 2)
        names = list(ship_tracks.KINDS)
        for i, kind in enumerate(names):
            assert (count[i, 0].sum() > 0) == (kind != 'weave')
            assert (count[i, 1].sum() > 0) == (kind not in ('steady', 'drift'))

    def test_after_a_plot_the_time_asked_for_is_the_plots(self, samples):
        after = samples.cell // 2 % 2 == 1
        assert (samples.scans[after] == 0).all() and (samples.scans[~after] > 0).all()

    def test_the_base_knows_its_own_error(self, samples):
        """Steady ships, sigma stated rightly: the truth is as far off as the variance tells."""
        chosen = (samples.cell // 8 == 0) & (samples.truly == 1) & (samples.cell % 2 == 0)
        ratio = np.square(samples.truth[chosen]) / np.exp(samples.spread[chosen])
        assert 0.3 < ratio.mean() < 1.5

    def test_each_cell_counts_alike(self, samples):
        weights = gwnn_training.cell_weights(samples)
        size = np.square(samples.truth[:, :2]).sum(1) / samples.truly ** 2
        for cell in np.unique(samples.cell):
            chosen = samples.cell == cell
            total = (weights[chosen, 0] * samples.truly[chosen] ** 2
                     * np.minimum(size[chosen], 40)).mean()
            assert total == pytest.approx(1.0, rel=1e-3)


class TestSymmetries:
    def test_there_are_eight_and_they_are_a_group(self):
        ways = gwnn_training.symmetries()
        marks = {tuple(way.state) + tuple(way.state_sign) for way in ways}
        assert len(marks) == 8
        probe = np.arange(1.0, gwnn_inputs.COUNT + 1)
        images = {tuple(probe[way.inputs] * way.sign) for way in ways}
        assert len(images) == 8
        for one in ways:
            for other in ways:
                twice = (probe[one.inputs] * one.sign)[other.inputs] * other.sign
                assert tuple(twice) in images

    def test_tracks_mirrored_give_the_inputs_mirrored(self):
        """Mirrored at the north axis, what lies across the line of sight changes sign."""
        count, scans, every = 20, 30, np.ones(20)
        rng = np.random.default_rng(6)
        ships = ship_tracks.sail(['sharp'] * count, np.full(count, 5000.0),
                                 np.full((count, scans), PERIOD), rng)
        radar = ship_tracks.Radar(15 * every, 0.006 * every, every, 0 * every, every,
                                  PERIOD * every)
        plots, _ = ship_tracks.observe(ships, radar, rng)
        mirror = np.diag([-1.0, 1.0])

        def seen(plots):
            network = gwnn.gwnn(gwnn.weights(), 25.0, PERIOD)
            state = network.init(plots[0])
            for one in plots[1:]:
                state = network.update(state, one, np.arange(count))
            return gwnn_inputs.inputs(state.bank, state.memory, PERIOD)
        mirrored = [p._replace(position=p.position @ mirror,
                               covariance=mirror @ p.covariance @ mirror) for p in plots]
        way = gwnn_training._symmetry(np.array([1, -1]), False)
        np.testing.assert_allclose(seen(mirrored), seen(plots)[:, way.inputs] * way.sign,
                                   rtol=1e-6, atol=1e-6)


class TestTraining:
    def test_fusing_is_what_the_estimator_does(self, samples):
        """The training's formula on [n, 13, 4] and the estimator's on [4, 13, n]."""
        batch = take(samples, slice(0, 200))
        output = np.random.default_rng(7).normal(size=(200, gwnn.OUTPUTS))
        log_weight = np.full((13, 200), gwnn.OTHERS)
        log_weight[:4] = batch.base.T
        at = gwnn.Look(batch.apart.transpose(2, 1, 0), log_weight, batch.scans)
        found, _ = gwnn_training.fuse(output.astype(np.float32), batch)
        np.testing.assert_allclose(found, gwnn.fuse(output, at).T, atol=1e-4)

    def test_gradients_of_fusing_are_those_of_differences(self, samples):
        batch = take(samples, slice(0, 5))
        batch = batch._replace(apart=batch.apart.astype(float))
        output = np.random.default_rng(8).normal(size=(5, gwnn.OUTPUTS))
        pull = np.random.default_rng(9).normal(size=(5, 4))
        out, weight = gwnn_training.fuse(output, batch)
        back = gwnn_training.fuse_backward(pull, out, weight, batch)
        for i in range(gwnn.OUTPUTS):
            push = np.zeros_like(output)
            push[:, i] = 1e-2
            slope = ((gwnn_training.fuse(output + push, batch)[0]
                      - gwnn_training.fuse(output - push, batch)[0]) * pull).sum(1) / 2e-2
            np.testing.assert_allclose(back[:, i], slope, rtol=0.02, atol=0.01)

    def test_stopped_and_gone_on_it_ends_where_it_would_have(self, samples, tmp_path):
        def trained(stops):
            training = gwnn_training.begin(samples, 3)
            for until in stops:
                training = gwnn_training.train(training, samples, 3, 60, until)
                gwnn_training._save(tmp_path / 'part', {'seed': 3}, training)
                training = gwnn_training._resume(tmp_path / 'part', {'seed': 3})
            return training.network
        for one, other in zip(trained([60])[:5], trained([20, 45, 60])[:5]):
            np.testing.assert_array_equal(one, other)

    def test_checkpoints_of_other_trainings_and_damaged_ones_are_refused(self, samples, tmp_path):
        file = tmp_path / 'w.npz.part'
        gwnn_training._save(file, {'seed': 3}, gwnn_training.begin(samples, 3))
        with pytest.raises(ValueError, match=r"another training, \{'seed': 3\}; remove it"):
            gwnn_training.run(4, 1, 10, file)
        file.write_bytes(file.read_bytes()[:3000])
        with pytest.raises(ValueError, match='damaged'):
            gwnn_training.run(4, 1, 10, file)

    def test_some_hundred_steps_already_gain(self, samples):
        """On the samples it sees, the network's emphasised cells fall below the base's error."""
        training = gwnn_training.train(gwnn_training.begin(samples, 5), samples, 5, 400, 400)
        known = training.against[:, 0] > 1e-3
        ratio = np.sqrt(training.size / training.against)[known]
        assert ratio.mean() < 0.99

    def test_the_worst_cells_gain_weight(self):
        size, against = np.ones((4, 2)), np.ones((4, 2))
        size[2] = 2.0
        against[3] = 0.0
        emphasis = gwnn_training.emphasize(np.zeros((4, 2)), size, against)
        assert (emphasis[2] > emphasis[0]).all() and (emphasis[3] == 0).all()


def test_training_by_command_gives_weights_that_load(tmp_path, command, monkeypatch):
    """Start to end, short: 588 tracks and 30 steps of training."""
    file = tmp_path / 'w.npz'
    done = command('train', 'gwnn', '--seed', 2, '--tracks', 588, '--steps', 30, '--out', file,
                   timeout=110)
    assert done.returncode == 0, done.stderr
    assert 'steady, straight: position ratio' in done.stdout
    weights = gwnn.weights(str(file))
    assert weights.manifest['seed'] == 2 and weights.manifest['tracks'] == 588
    assert not list(tmp_path.glob('*.part*'))
    assert net.group_size(weights.fusion.layout) == 20


def test_wrong_options_are_told(tmp_path, command):
    for options, text in ((('--steps', 0), '--steps is 0'), (('--seed', -1), '--seed is -1'),
                          (('--out', tmp_path / 'no' / 'w.npz'), 'there is no folder'),
                          (('--out', tmp_path / 'w.json'), 'that name is for')):
        done = command('train', 'gwnn', *options)
        assert done.returncode == 2 and text in done.stderr


class TestTrials:
    def test_a_ratio_and_its_interval(self):
        """Two estimators with errors of known size: 0.8, known to 1 / sqrt(4 * 400 * 50)."""
        rng = np.random.default_rng(10)
        one, other = (np.square(rng.normal(0, s, (400, 50, 2))).sum(2) for s in (0.8, 1.0))
        found = track_trials.ratio(one, other, np.ones((400, 50), bool), rng)
        assert found.low < 0.8 < found.high
        assert found.high - found.low < 0.03

    def test_a_cell_has_its_figures(self):
        found = gwnn_monte_carlo.cells('steady', 15, gwnn_monte_carlo.FAIR, 3, None,
                                       gwnn.weights())
        assert [cell.name for cell in found] == ['steady, straight']
        assert found[0].rms['GWNN'] < found[0].rms['CS']
        names = [figure.name for figure in gwnn_monte_carlo._cell_figures(found[0])]
        assert 'steady, straight: velocity ratio' in names

    @pytest.mark.slow
    def test_the_short_experiment_has_every_figure(self):
        figures = gwnn_monte_carlo.run(10, 3)
        names = {figure.name for figure in figures}
        assert 'steady, straight: position ratio' in names
        assert 'position ratio, geometric mean over the cells' in names
        assert 'random weights: position ratio' in names
        assert all(figure.value is None or np.isfinite(figure.value) for figure in figures)
