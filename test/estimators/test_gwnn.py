"""The wavelet network over its bank of filters: what it gains, and when it is left out."""

import json

import numpy as np
import pytest

from marine_tracker.estimators import cs_kalman, imm
from marine_tracker.estimators.gwnn import bank, bank_settings, gwnn, inputs, monitor
from marine_tracker.gaussian import leg_hypotheses, linear_modes
from marine_tracker.geometry import polar_to_position, to_range_bearing
from marine_tracker.networks import gwnn_weights
from marine_tracker.parameters import VESSEL_CLASSES
from marine_tracker.training import ship_tracks, track_trials, training_tracks
from marine_tracker.types import Plots, append, put, take

PERIOD = 60 / 22
SPEED = 25.0
SHIP = bank.BANKS['ship']
SHARE = 40  # tracks of a short trial
SLOW = pytest.mark.slow  # a like test stays with the fast ones


@pytest.fixture(scope='module')
def weights():
    return gwnn.weights()


def radar(count, **other):
    every = np.ones(count)
    values = {
        'range_sigma': 25.0,
        'bearing_sigma': np.radians(0.4),
        'detection': 1.0,
        'outliers': 0.0,
        'truly': 1.0,
        'period': PERIOD,
        **other,
    }
    return ship_tracks.RunRadar(**{name: value * every for name, value in values.items()})


def make_trial(kind, seed=5, count=SHARE, scans=60, **other):
    rng = np.random.default_rng(seed)
    ships = ship_tracks.sail(
        [kind] * count, np.exp(rng.uniform(8, 9, count)), np.full((count, scans), PERIOD), rng
    )
    return track_trials.trial(ships, radar(count, **other), rng)


def silent(weights):
    """A network whose outputs are all zero."""

    def hush(network):
        return network._replace(outer=0 * network.outer, bias=0 * network.bias)

    return weights._replace(fusion=hush(weights.fusion), spread=hush(weights.spread))


def off_by(weights, sigma):
    """A network whose positions are off along the line of sight."""
    bias = weights.fusion.bias.copy()
    bias[gwnn.AT_ONCE] += [sigma, 0.0]
    return weights._replace(fusion=weights.fusion._replace(bias=bias))


def drive(estimator, on, state=None, scans=None):
    """The state after the trial's scans (from the first plot where there is no state)."""
    every = np.arange(len(on.seen))
    for k in scans or range(on.seen.shape[1]):
        state = (
            estimator.init(on.plots[k])
            if state is None
            else estimator.update(state, on.plots[k], every)
        )
    return state


class TestBank:
    def test_its_imms_and_cs_are_the_products_own(self):
        """The same plots through the estimators by themselves: the same expectations."""
        on = make_trial('sharp')
        state = bank.begin(SHIP, on.plots[0], SPEED)
        alone = {
            'base': imm.imm(bank_settings.TUNED_ON_ALL, SPEED),
            12: imm.imm(bank_settings.TUNED_FOR_MANOEUVRE, SPEED),
            bank.CS: cs_kalman.cs_kalman(SHIP.settings.manoeuvre, SPEED),
        }
        states = {key: one.init(on.plots[0]) for key, one in alone.items()}
        for plots in on.plots[1:]:
            state = bank.correct(SHIP, state, bank.expect(SHIP, state, plots), plots)
            states = {key: alone[key].update(states[key], plots, np.arange(SHARE)) for key in alone}
        time = on.plots[-1].time + PERIOD
        ahead = bank.look(SHIP, state, np.array([PERIOD]))
        for key, one in alone.items():
            expected = one.extrapolate(states[key], time)
            mean = ahead.mean if key == 'base' else ahead.experts[:, key]
            np.testing.assert_allclose(mean[:2].T, expected.position, atol=1e-6)
            np.testing.assert_allclose(mean[2:].T, expected.velocity, atol=1e-7)
        columns = bank.base(SHIP, state, time)
        mean, covariance = linear_modes.unpack(columns.T)
        expected = alone['base'].extrapolate(states['base'], time)
        np.testing.assert_allclose(covariance, expected.covariance, rtol=1e-6, atol=1e-6)

    def test_its_legs_are_those_of_the_arpa(self):
        """The same hypotheses about the same plots; the expert is the mean of the likely ones."""
        on = make_trial('sharp')
        state = drive_bank(on)
        first = on.plots[0]
        alone = leg_hypotheses.begin(first.position, first.covariance, first.time, SPEED / 2)
        for before, plots in zip(on.plots, on.plots[1:]):
            alone, shown = leg_hypotheses.update(
                alone,
                plots.time,
                plots.time - before.time,
                plots.position,
                plots.covariance,
                None,
                bank.CERTAINTY,
                SHIP.settings.habits,
            )
        np.testing.assert_allclose(state.legs.weight, alone.weight, rtol=1e-9, atol=1e-12)
        ahead = bank.look(SHIP, state, np.array([PERIOD])).experts[:, bank.LEG_EXPERTS]
        np.testing.assert_allclose(
            ahead[:2, 0].T, shown[:, :2] + PERIOD * shown[:, 2:4], rtol=0, atol=1e-6
        )

    def test_on_a_straight_course_the_leg_is_the_straight_line_fit(self):
        """The leg that began first, 60 plots later: the line of least squares, weighted."""
        on = make_trial('steady', count=10)
        state = drive_bank(on)
        ahead = bank.look(SHIP, state, np.zeros(1)).experts[:2, bank.LEG_EXPERTS.start + 2].T
        for i in range(10):
            rows, seen = [], []
            for plots in on.plots:
                root = np.linalg.cholesky(np.linalg.inv(plots.covariance[i])).T
                step = plots.time[i] - state.time[i]
                rows.append(root @ np.kron([1.0, step], np.eye(2)))
                seen.append(root @ plots.position[i])
            line = np.linalg.lstsq(np.concatenate(rows), np.concatenate(seen), rcond=None)[0]
            assert (
                np.hypot(*(ahead[i] - line[:2])) < 1.0
            )  # m, of plots that scatter by 25 m or more

    def test_left_and_right_turns_are_told_apart(self):
        """A ship that turns to starboard lies to the right of what left turns expect."""
        angle = np.radians(2.5) * PERIOD * np.arange(30)
        radius = 200.0
        path = np.stack([6000 + radius * (1 - np.cos(angle)), radius * np.sin(angle)], 1)
        state = None
        for k, position in enumerate(path):
            plots = plots_of(position[None], k * PERIOD)
            state = (
                bank.begin(SHIP, plots, SPEED)
                if state is None
                else bank.correct(SHIP, state, bank.expect(SHIP, state, plots), plots)
            )
        ahead = bank.look(SHIP, state, np.array([PERIOD]))
        right, left = (ahead.experts[:2, j, 0] for j in bank.TURNS[1])
        heading = ahead.mean[2:, 0]
        assert np.cross(np.append(heading, 0), np.append(right - left, 0))[2] < 0
        assert ahead.weight[bank.RICH][3::2].sum() > 3 * ahead.weight[bank.RICH][4::2].sum()


def drive_bank(on):
    state = bank.begin(SHIP, on.plots[0], SPEED)
    for plots in on.plots[1:]:
        state = bank.correct(SHIP, state, bank.expect(SHIP, state, plots), plots)
    return state


def plots_of(position, time):
    distance, bearing = to_range_bearing(position)
    where, covariance = polar_to_position(distance, bearing, 25.0, np.radians(0.4))
    count = len(position)
    return Plots(
        np.full(count, float(time)),
        distance,
        bearing,
        np.zeros(count),
        np.zeros((count, 2)),
        where,
        covariance,
    )


class TestInputs:
    def test_there_is_one_for_every_kind(self):
        on = make_trial('mix', scans=12)
        state = drive(gwnn.gwnn(silent(gwnn.weights()), SPEED, PERIOD), on)
        seen = inputs.inputs(SHIP, state.bank, state.memory, PERIOD)
        assert seen.shape == (SHARE, inputs.COUNT) and np.isfinite(seen).all()
        assert inputs.COUNT == 132

    def test_sigma_check_reads_the_true_deviation_of_the_plots(self):
        """True deviation over the stated one, within a sixth on the mean of 40 tracks."""
        for truly in (0.5, 1.0, 2.0):
            on = make_trial('steady', scans=90, truly=truly)
            state = drive(gwnn.gwnn(silent(gwnn.weights()), SPEED, PERIOD), on)
            assert state.memory.detail.mean() == pytest.approx(truly, rel=0.17)

    def test_a_vague_plot_does_not_blow_up_the_units(self):
        on = make_trial('steady')
        state = drive(gwnn.gwnn(gwnn.weights(), SPEED, PERIOD), on)
        plots = on.plots[-1]
        vague = plots._replace(time=plots.time + PERIOD, covariance=1e8 * plots.covariance)
        after = gwnn.gwnn(gwnn.weights(), SPEED, PERIOD).update(state, vague, np.arange(SHARE))
        assert (after.memory.frame[:, 2:] <= 1.5 * state.memory.frame[:, 2:] + 1e-9).all()


class TestFusion:
    def test_a_silent_network_is_roughly_the_imm(self, weights):
        on = make_trial('mix', count=100)
        own = track_trials.run(
            gwnn.gwnn(silent(weights), SPEED, PERIOD, trust=monitor.Trust(np.inf, np.inf)),
            on,
            False,
        )
        base = track_trials.run(imm.imm(bank_settings.TUNED_ON_ALL, SPEED), on, True)
        assert track_trials.rms(own.position, on.counts) == pytest.approx(
            track_trials.rms(base.position, on.counts), rel=0.05
        )

    @pytest.mark.parametrize(
        ('vessel_class', 'modes'),
        [('ship', bank_settings.TUNED_ON_ALL), ('small_craft', imm.PRESETS['small_craft'])],
    )
    def test_warming_up_a_track_is_the_imm(self, vessel_class, modes):
        on = make_trial('mix', scans=monitor.WARM - 1)
        network = gwnn.gwnn(
            gwnn.weights('', vessel_class), SPEED, PERIOD, vessel_class=vessel_class
        )
        base = imm.imm(modes, SPEED)
        ours, theirs = drive(network, on), drive(base, on)
        assert (gwnn.account(ours).state == monitor.WARMUP).all()
        time = on.plots[-1].time + 2.0
        for one, other in zip(network.extrapolate(ours, time), base.extrapolate(theirs, time)):
            np.testing.assert_allclose(one, other, rtol=1e-6, atol=1e-6)

    @pytest.mark.parametrize(
        ('kind', 'limit'),
        [
            ('steady', 0.97),
            pytest.param('weave', 0.96, marks=SLOW),
            pytest.param('sharp', 1.0, marks=SLOW),
            ('agile', 0.95),
        ],
    )
    def test_it_beats_the_imm_tuned_on_its_own_training_tracks(self, weights, kind, limit):
        """120 tracks: the interval's upper end must stay below the limit."""
        on = make_trial(kind, seed=77, count=120, scans=90)
        own = track_trials.run(gwnn.gwnn(weights, SPEED, PERIOD), on, False)
        base = track_trials.run(imm.imm(bank_settings.TUNED_ON_ALL, SPEED), on, True)
        found = track_trials.ratio(own.position, base.position, on.counts, np.random.default_rng(0))
        assert found.high < limit

    @pytest.mark.parametrize(
        'kind',
        ['steady', 'rib', *(pytest.param(k, marks=SLOW) for k in ('idle', 'ferry', 'weave'))],
    )
    def test_for_small_craft_it_beats_the_products_imm(self, kind):
        """140 boats and their radars, fair and hard: the interval's upper end."""
        rng = np.random.default_rng(79)
        waters = training_tracks.WATERS['small_craft']
        found = training_tracks.draw(
            waters._replace(kinds={kind: waters.kinds[kind]}), np.zeros(140, int), 80, rng
        )
        on = track_trials.trial(found.ships, found.radar, rng)
        network = gwnn.gwnn(
            gwnn.weights('', 'small_craft'), SPEED, PERIOD, vessel_class='small_craft'
        )
        own = track_trials.run(network, on, False)
        base = track_trials.run(imm.imm(imm.PRESETS['small_craft'], SPEED), on, True)
        for one, other, limit in (
            (own.position, base.position, 1.0),
            (own.velocity, base.velocity, 1.0),
        ):
            assert track_trials.ratio(one, other, on.counts, rng).high < limit

    def test_it_knows_how_far_off_it_is(self, weights):
        """Squared distance of plots from where they are expected, by its own covariance: 2."""
        on = make_trial('mix', seed=78, count=150, scans=80)
        own = track_trials.run(gwnn.gwnn(weights, SPEED, PERIOD), on, False)
        assert 1.6 < own.nis[on.counts & ~on.phase].mean() < 2.4
        assert 1.6 < own.nis[on.counts].mean() < 2.8

    def test_in_sharp_turns_a_gate_by_its_covariance_holds_as_many_plots_as_one_by_the_imms(self):
        """One plot in a thousand is outside in theory; boats that turn hard and often."""
        rng, count = np.random.default_rng(31), 100
        distance, steps = np.exp(rng.uniform(6, 8, count)), np.full((count, 90), 2.0)
        boats = ship_tracks.sail(
            ['sharp'] * count, distance, steps, rng, kinds=ship_tracks.SMALL_CRAFT
        )
        seen = radar(count, range_sigma=6.0, bearing_sigma=np.radians(0.7), period=2.0)
        on = track_trials.trial(boats, seen, rng)
        network = gwnn.gwnn(gwnn.weights('', 'small_craft'), SPEED, 2.0, vessel_class='small_craft')
        own = track_trials.run(network, on, False)
        base = track_trials.run(imm.imm(imm.PRESETS['small_craft'], SPEED), on, True)
        turning = on.counts & on.phase
        outside = [(one.nis[turning] > 13.8).mean() for one in (own, base)]
        assert outside[0] <= outside[1] < 0.02

    def test_it_is_never_surer_of_the_position_than_its_own_imm(self, weights):
        on = make_trial('frequent', seed=6)
        network = gwnn.gwnn(weights, SPEED, PERIOD)
        state = drive(network, on)
        time = state.bank.time + PERIOD
        _, base = linear_modes.unpack(bank.base(SHIP, state.bank, time).T)
        ours = network.extrapolate(state, time).covariance
        assert (gwnn.account(state).state == monitor.GWNN).all()
        own, least = (inputs.variances(state.memory.frame, one)[:2] for one in (ours, base))
        assert (own >= least * (1 - 1e-9)).all() and (own > 1.01 * least).any()
        assert (np.linalg.eigvalsh(ours) > 0).all()

    def test_far_ahead_its_correction_is_carried_on_straight(self, weights):
        on = make_trial('weave')
        network = gwnn.gwnn(weights, SPEED, PERIOD)
        state = drive(network, on)
        base = imm.imm(bank_settings.TUNED_ON_ALL, SPEED)
        now = state.bank.time

        def correction(scans):
            time = now + scans * PERIOD
            mean = bank.base(SHIP, state.bank, time)[:4].T
            ahead = network.extrapolate(state, time)
            return ahead.position - mean[:, :2], ahead.velocity - mean[:, 2:]

        near, velocity = correction(gwnn.FADE)
        far, same = correction(gwnn.FADE + 10)
        np.testing.assert_allclose(same, velocity, atol=1e-9)
        np.testing.assert_allclose(far, near + 10 * PERIOD * velocity, atol=1e-6)
        assert base is not None and np.abs(velocity).max() > 0.01

    def test_the_picture_turned_or_mirrored_gives_the_track_turned_or_mirrored(self, weights):
        """Not for every picture: along and across the line of sight are alike only by training.

        Turned about own ship, though, it is the same picture.
        """
        on = make_trial('sharp')
        network = gwnn.gwnn(weights, SPEED, PERIOD)
        time = on.plots[-1].time + PERIOD
        ahead = network.extrapolate(drive(network, on), time)
        turn = np.array([[0.0, 1.0], [-1.0, 0.0]])  # clockwise by 90 deg
        turned = [
            p._replace(position=p.position @ turn.T, covariance=turn @ p.covariance @ turn.T)
            for p in on.plots
        ]
        found = network.extrapolate(drive(network, on._replace(plots=turned)), time)
        np.testing.assert_allclose(found.position, ahead.position @ turn.T, atol=1e-5)
        np.testing.assert_allclose(found.velocity, ahead.velocity @ turn.T, atol=1e-6)

    def test_a_warm_track_does_not_depend_on_the_others(self, weights):
        on = make_trial('mix')
        network = gwnn.gwnn(weights, SPEED, PERIOD)
        state = drive(network, on)
        few = np.array([7, 3, 21])
        later = on.plots[-1]._replace(time=on.plots[-1].time + PERIOD)
        whole = network.update(state, later, np.arange(SHARE))
        part = network.update(take(state, few), take(later, few), np.arange(3))
        for one, other in zip(
            network.extrapolate(take(whole, few), later.time[few] + 1),
            network.extrapolate(part, later.time[few] + 1),
        ):
            np.testing.assert_allclose(one, other, rtol=1e-5, atol=1e-3)  # float32 inside


class TestMonitor:
    def test_a_break_is_noticed_and_a_sound_network_comes_back(self, weights):
        on = make_trial('mix', scans=120)
        sound = gwnn.gwnn(weights, SPEED, PERIOD)
        broken = gwnn.gwnn(off_by(weights, 3.0), SPEED, PERIOD)
        state = drive(sound, on, scans=range(40))
        assert (state.monitor.status == monitor.GWNN).mean() > 0.9
        state = drive(broken, on, state, range(40, 60))
        account = gwnn.account(state)
        assert (account.state == monitor.FALLBACK).mean() > 0.9
        assert monitor.REASONS[account.reason[account.state == 2][0]].startswith('expectations')
        assert (account.rho[account.state == 2] > 1).mean() > 0.9
        state = drive(sound, on, state, range(60, 120))
        assert (state.monitor.status == monitor.GWNN).mean() > 0.8

    def test_among_agile_boats_a_break_shows_by_the_networks_own_filters(self, weights):
        """There CS-Kalman is off by as much as the broken network. The base IMM is not."""
        on = make_trial('agile', scans=60)
        state = drive(gwnn.gwnn(weights, SPEED, PERIOD), on, scans=range(40))
        assert (state.monitor.status == monitor.GWNN).mean() > 0.9
        fallen, blind = np.zeros((2, SHARE), bool)
        ways = ((fallen, monitor.TRUST), (blind, monitor.TRUST._replace(excess=np.inf)))
        for found, trust in ways:
            broken = gwnn.gwnn(off_by(weights, 3.0), SPEED, PERIOD, trust=trust)
            after = state
            for k in range(40, 50):
                after = drive(broken, on, after, [k])
                found |= after.monitor.status == monitor.FALLBACK
        assert fallen.mean() > 0.85 and blind.mean() < 0.7

    def test_fallen_back_a_track_is_that_of_cs_kalman(self, weights):
        on = make_trial('steady', scans=50)
        network = gwnn.gwnn(off_by(weights, 30.0), SPEED, PERIOD)
        state = drive(network, on)
        alone = cs_kalman.cs_kalman(SHIP.settings.manoeuvre, SPEED)
        theirs = drive(alone, on)
        fallen = np.flatnonzero(
            (state.monitor.status == monitor.FALLBACK) & (state.bank.time == on.plots[-1].time)
        )
        assert len(fallen) > 0.9 * SHARE
        time = on.plots[-1].time + PERIOD
        ours, cs = network.extrapolate(state, time), alone.extrapolate(theirs, time)
        # A plot that the bank refused makes a difference that dies out.
        close = np.abs(ours.position - cs.position)[fallen].max(1) < 1.0
        assert close.mean() > 0.9
        np.testing.assert_allclose(
            ours.covariance[fallen], cs.covariance[fallen], rtol=0.1, atol=1.0
        )

    @pytest.mark.parametrize('value', [np.nan, np.inf])
    def test_weights_that_are_not_numbers_leave_no_trace(self, weights, value):
        on = make_trial('mix')
        bad = weights._replace(
            fusion=weights.fusion._replace(outer=np.full_like(weights.fusion.outer, value))
        )
        network = gwnn.gwnn(bad, SPEED, PERIOD)
        with np.errstate(invalid='ignore'):
            state = drive(network, on)
            ahead = network.extrapolate(state, on.plots[-1].time + PERIOD)
        account = gwnn.account(state)
        assert (account.state == monitor.FALLBACK).all()
        assert {monitor.REASONS[i] for i in account.reason} == {'network output is not a number'}
        for array in ahead:
            assert np.isfinite(array).all()
        assert np.isfinite(state.output).all()
        # And on good weights it returns.
        sound = gwnn.gwnn(weights, SPEED, PERIOD)
        later = make_trial('mix', scans=100)
        state = drive(sound, later, state, range(60, 100))
        assert (state.monitor.status == monitor.GWNN).mean() > 0.8

    def test_missed_plots_are_no_failure(self, weights):
        on = make_trial('steady', scans=60, detection=0.7)
        fallen = []
        track_trials.run(
            gwnn.gwnn(weights, SPEED, PERIOD),
            on,
            False,
            lambda k, state: fallen.append(state.monitor.status == monitor.FALLBACK),
        )
        assert np.mean(fallen) < 0.02

    def test_an_outlier_moves_no_settled_track(self, weights):
        on = make_trial('steady')
        network = gwnn.gwnn(weights, SPEED, PERIOD)
        state, every = drive(network, on), np.arange(SHARE)
        wild = on.plots[-1]._replace(time=on.plots[-1].time + PERIOD)
        wild = wild._replace(position=wild.position + 800.0)
        after = network.update(state, wild, every)
        time = wild.time + PERIOD
        apart = (
            network.extrapolate(after, time).position - network.extrapolate(state, time).position
        )
        assert np.median(np.hypot(*apart.T)) < 20.0
        # Three in a row are a target: then the filters follow.
        for k in (1, 2, 3):
            after = network.update(after, wild._replace(time=wild.time + k * PERIOD), every)
        apart = (
            network.extrapolate(after, time).position - network.extrapolate(state, time).position
        )
        assert np.median(np.hypot(*apart.T)) > 200.0


class TestWeights:
    @pytest.mark.parametrize('vessel_class', VESSEL_CLASSES)
    def test_the_shipped_file_says_how_it_came_about(self, vessel_class):
        manifest = gwnn.weights('', vessel_class).manifest
        assert {'seed', 'tracks', 'steps', 'kinds', 'ratios', 'checksum'} <= set(manifest)
        assert manifest['inputs'] == inputs.COUNT
        assert manifest['vessel_class'] == vessel_class
        beside = gwnn_weights.shipped(vessel_class).with_suffix('.json')
        assert json.loads(beside.read_text()) == manifest

    def test_what_is_saved_is_loaded(self, weights, tmp_path):
        gwnn_weights.save(tmp_path / 'w.npz', weights)
        again = gwnn.weights(str(tmp_path / 'w.npz'))
        for one, other in zip(
            again.fusion[:5] + again.spread[:5], weights.fusion[:5] + weights.spread[:5]
        ):
            np.testing.assert_array_equal(one, other)

    def test_a_missing_file_is_named(self, tmp_path):
        with pytest.raises(ValueError, match=r'none\.npz cannot be read: No such file'):
            gwnn.weights(str(tmp_path / 'none.npz'))

    def test_anything_else_is_refused(self, tmp_path):
        (tmp_path / 'w.npz').write_text('weights')
        with pytest.raises(ValueError, match='no file of `marine_tracker train gwnn`'):
            gwnn.weights(str(tmp_path / 'w.npz'))

    def test_half_a_file_is_refused(self, weights, tmp_path):
        file = tmp_path / 'w.npz'
        gwnn_weights.save(file, weights)
        file.write_bytes(file.read_bytes()[:5000])
        with pytest.raises(ValueError, match='damaged'):
            gwnn.weights(str(file))

    @pytest.mark.parametrize(
        ('change', 'message'),
        [
            ({'fusion_bias': lambda a: a + 1}, 'checksum does not match'),
            ({'fusion_bias': None}, 'right arrays: fusion_bias'),
            ({'manifest': {'format': 99}}, 'format 99'),
            ({'manifest': {'layouts': None}}, 'the layout of fusion is None'),
            ({'manifest': {'layouts': {'fusion': [2, 3]}}}, r'the layout of fusion is \[2, 3\]'),
            ({'manifest': {'layouts': {'fusion': ['x'] * 4}}}, 'the layout of fusion is'),
        ],
    )
    def test_tampering_is_noticed(self, weights, tmp_path, change, message):
        file = tmp_path / 'w.npz'
        gwnn_weights.save(file, weights)
        with np.load(file) as found:
            arrays = dict(found)
        for name, how in change.items():
            if how is None:
                del arrays[name]
            elif name == 'manifest':
                arrays[name] = np.array(json.dumps({**json.loads(str(arrays[name])), **how}))
            else:
                arrays[name] = how(arrays[name])
        np.savez(file, **arrays)
        with pytest.raises(ValueError, match=message):
            gwnn.weights(str(file))

    def test_weights_of_another_network_are_refused(self, weights, tmp_path):
        fusion = weights.fusion
        other = fusion._replace(centre=fusion.centre[:-1])
        gwnn_weights.save(tmp_path / 'w.npz', weights._replace(fusion=other))
        with pytest.raises(ValueError, match=r'another network: fusion_centre has shape \(131,\)'):
            gwnn.weights(str(tmp_path / 'w.npz'))

    def test_weights_of_another_vessel_class_are_refused(self):
        file = gwnn_weights.shipped('ship')
        marks = [bank.BANKS[name].mark for name in VESSEL_CLASSES]
        assert len(set(marks)) == len(marks)
        with pytest.raises(
            ValueError,
            match=(
                f'of vessel class ship .settings {SHIP.mark}., not those of small_craft .settings '
                f'{bank.BANKS["small_craft"].mark}.: train again with --vessel-class small_craft'
            ),
        ):
            gwnn.weights(str(file), 'small_craft')

    def test_weights_trained_over_other_filters_are_refused(self, weights, tmp_path):
        other = weights._replace(manifest={**weights.manifest, 'filters': 'other'})
        gwnn_weights.save(tmp_path / 'w.npz', other)
        with pytest.raises(ValueError, match='settings other'):
            gwnn.weights(str(tmp_path / 'w.npz'))

    def test_weights_that_are_not_numbers_are_refused(self, weights, tmp_path):
        bias = np.full_like(weights.fusion.bias, np.nan)
        gwnn_weights.save(
            tmp_path / 'w.npz', weights._replace(fusion=weights.fusion._replace(bias=bias))
        )
        with pytest.raises(ValueError, match='fusion_bias holds values that are not finite'):
            gwnn.weights(str(tmp_path / 'w.npz'))


def test_states_begin_and_end_at_any_time(weights):
    """Rows of young and old tracks in one state, updated in parts."""
    network = gwnn.gwnn(weights, SPEED, PERIOD)
    on = make_trial('mix', scans=30)
    old = drive(network, on)
    young = network.init(on.plots[-1])
    both = append(old, young)
    rows = np.array([3, SHARE + 3])
    plots = take(on.plots[-1], np.array([3, 3]))
    plots = plots._replace(time=plots.time + PERIOD)
    after = network.update(both, plots, rows)
    assert (
        after.monitor.status[3] == monitor.GWNN
        and after.monitor.status[SHARE + 3] == monitor.WARMUP
    )
    again = put(after, rows, take(both, rows))
    for one, other in zip(flat(again.bank), flat(both.bank)):
        np.testing.assert_array_equal(one, other)


def flat(rows):
    """All arrays of a nested state."""
    for one in rows:
        yield from flat(one) if isinstance(one, tuple) else (one,)


class TestLearning:
    def test_it_takes_some_of_a_lasting_bias_away(self, weights):
        """The network's positions are .6 sigma off: by learning the error falls by 2 % or more."""
        bias = weights.fusion.bias.copy()
        bias[gwnn.AT_ONCE] += [0.6, -0.4]
        biased = weights._replace(fusion=weights.fusion._replace(bias=bias))
        on = make_trial('mix', seed=80, count=60, scans=90)
        plain, learned = (
            track_trials.run(
                gwnn.gwnn(
                    biased, SPEED, PERIOD, trust=monitor.Trust(np.inf, np.inf), learning=learning
                ),
                on,
                False,
            )
            for learning in (False, True)
        )
        found = track_trials.ratio(
            learned.position, plain.position, on.counts, np.random.default_rng(1)
        )
        assert found.high < 0.98

    @pytest.mark.parametrize('kind', ['agile', pytest.param('steady', marks=SLOW)])
    def test_it_spoils_no_more_than_one_part_in_a_hundred(self, weights, kind):
        on = make_trial(kind, seed=81, count=60, scans=90)
        plain, learned = (
            track_trials.run(gwnn.gwnn(weights, SPEED, PERIOD, learning=learning), on, False)
            for learning in (False, True)
        )
        found = track_trials.ratio(
            learned.position, plain.position, on.counts, np.random.default_rng(1)
        )
        assert found.value < 1.01

    def test_its_units_are_those_of_the_network(self, weights):
        """Output weights times units: the position's outputs."""
        on = make_trial('mix', scans=20)
        state = drive(gwnn.gwnn(weights, SPEED, PERIOD, learning=True), on)
        fusion = weights.fusion
        said = np.concatenate([fusion.outer, fusion.bias[:, None]], 1)
        half = state.adapted.units.shape[2] // 2
        for axis in (0, 1):
            for part, output in (
                (slice(0, half), gwnn.AT_ONCE),
                (slice(half, None), gwnn.PER_SCAN),
            ):
                found = state.adapted.units[:, axis, part] @ said[output.start + axis]
                np.testing.assert_allclose(found, state.output[:, output.start + axis], atol=1e-4)
