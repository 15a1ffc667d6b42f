"""How the wavelet network is trained, and that training can be stopped and repeated."""

import numpy as np
import pytest

from marine_tracker.estimators.gwnn import bank, gwnn, inputs, monitor
from marine_tracker.gaussian import linear_modes
from marine_tracker.networks import wavelet_network as net
from marine_tracker.training import (
    gwnn_checkpoint,
    gwnn_samples,
    gwnn_spread,
    gwnn_training,
    track_trials,
    training_tracks,
)
from marine_tracker.training import gwnn_fusion as fusion
from marine_tracker.types import take

KINDS = len(training_tracks.WATERS['ship'].names)


@pytest.fixture(scope='module')
def samples():
    return gwnn_samples.make(bank.BANKS['ship'], training_tracks.WATERS['ship'], 900, 0)


def test_fusing_is_what_the_estimator_does(samples):
    """The training's formula on [n, 13, 4] and the estimator's on [4, 13, n]."""
    batch = take(samples, slice(0, 200))
    output = np.random.default_rng(7).normal(size=(200, gwnn.OUTPUTS))
    log_weight = np.full((13, 200), gwnn.OTHERS)
    log_weight[:4] = batch.base.T
    at = gwnn.Look(batch.apart.transpose(2, 1, 0), log_weight, batch.scans)
    found, _ = fusion.fuse(output.astype(np.float32), batch)
    np.testing.assert_allclose(found, gwnn.fuse(output, at).T, atol=1e-4)


def test_gradients_of_fusing_are_those_of_differences(samples):
    batch = take(samples, slice(0, 5))
    batch = batch._replace(apart=batch.apart.astype(float))
    output = np.random.default_rng(8).normal(size=(5, gwnn.OUTPUTS))
    pull = np.random.default_rng(9).normal(size=(5, 4))
    out, weight = fusion.fuse(output, batch)
    back = fusion.fuse_backward(pull, out, weight, batch)
    for i in range(gwnn.OUTPUTS):
        push = np.zeros_like(output)
        push[:, i] = 1e-2
        slope = (
            (fusion.fuse(output + push, batch)[0] - fusion.fuse(output - push, batch)[0]) * pull
        ).sum(1) / 2e-2
        np.testing.assert_allclose(back[:, i], slope, rtol=0.02, atol=0.01)


def test_the_variances_of_the_training_are_those_that_the_estimator_states():
    rng = np.random.default_rng(12)
    waters = training_tracks.WATERS['ship']
    found = training_tracks.draw(waters, np.arange(44) % KINDS, 30, rng)
    on = track_trials.trial(found.ships, found.radar, rng)
    period, ship = float(found.radar.period[0]), bank.BANKS['ship']
    network = gwnn.gwnn(gwnn.weights(), training_tracks.SPEED, period)
    state = track_trials.run(network, on, False).state
    rows = np.flatnonzero(state.monitor.status == monitor.GWNN)
    state = take(state, rows)
    time, frame = state.bank.time + 0.8 * inputs.SCAN, state.memory.frame
    at = gwnn.look(state.bank, frame, bank.look(ship, state.bank, time - state.bank.time), time)
    _, base = linear_modes.unpack(bank.base(ship, state.bank, time).T)
    variance, _ = gwnn_spread.variances(
        state.output[:, gwnn.OUTPUTS :],
        at.scans[:, None],
        np.log(inputs.variances(frame, base)).T,
        gwnn.correct(state, at).T,
    )
    stated = inputs.variances(frame, network.extrapolate(state, time).covariance)
    assert len(rows) > 20
    np.testing.assert_allclose(variance.T, stated, rtol=1e-6)


def test_stopped_and_gone_on_it_ends_where_it_would_have(samples, tmp_path):
    def trained(stops):
        training = fusion.begin(samples, KINDS, 3)
        for until in stops:
            training = fusion.train(training, samples, 3, 60, until)
            gwnn_checkpoint.save(tmp_path / 'part', {'seed': 3}, training)
            training = gwnn_checkpoint.resume(tmp_path / 'part', {'seed': 3}, fusion.LAYOUT)
        return training.network

    for one, other in zip(trained([60])[:5], trained([20, 45, 60])[:5]):
        np.testing.assert_array_equal(one, other)


def test_checkpoints_of_other_trainings_and_damaged_ones_are_refused(samples, tmp_path):
    file = tmp_path / 'w.npz.part'
    gwnn_checkpoint.save(file, {'seed': 3}, fusion.begin(samples, KINDS, 3))
    with pytest.raises(ValueError, match=r'another training \(.*seed 3, not 4.*remove it'):
        gwnn_training.run(gwnn_training.plan('ship', 4, chunks=1, steps=10), file)
    file.write_bytes(file.read_bytes()[:3000])
    with pytest.raises(ValueError, match='damaged'):
        gwnn_training.run(gwnn_training.plan('ship', 4, chunks=1, steps=10), file)


def test_some_hundred_steps_already_gain(samples):
    """On the samples it sees, the network's emphasised cells fall below the base's error."""
    training = fusion.train(fusion.begin(samples, KINDS, 5), samples, 5, 400, 400)
    known = training.against[:, 0, 0] > 1e-3
    ratio = np.sqrt(training.size / training.against[..., 0])[known]
    assert ratio.mean() < 0.99


def test_the_worst_cells_gain_weight():
    size, against = np.ones((4, 2)), np.ones((4, 2))
    size[2] = 2.0
    against[3] = 0.0
    emphasis = fusion.emphasize(np.zeros((4, 2)), size, np.stack([against, 2 * against], 2))
    assert (emphasis[2] > emphasis[0]).all() and (emphasis[3] == 0).all()


def test_without_legs_no_weight_is_left_for_them(samples):
    network = fusion.begin(samples, KINDS, 6, legs=False).network
    batch = take(samples, slice(0, 300))
    _, weight = fusion.fuse(net.forward(network, batch.seen), batch)
    assert weight[:, bank.LEG_EXPERTS].max() < 1e-12


@pytest.mark.slow
def test_without_legs_a_network_neither_hears_nor_chooses_them(samples, tmp_path):
    plan = gwnn_training.plan('ship', 6, chunks=1, steps=30, legs=False)
    fusion_, spread, manifest = gwnn_training.run(plan, tmp_path / 'w.npz.part')
    batch = take(samples, slice(0, 300))
    seen = batch.seen.copy()
    seen[:, inputs.OF_LEGS] = 7.0
    for network in (fusion_, spread):
        np.testing.assert_array_equal(net.forward(network, seen), net.forward(network, batch.seen))
    _, weight = fusion.fuse(net.forward(fusion_, batch.seen), batch)
    assert weight[:, bank.LEG_EXPERTS].max() < 1e-12 and manifest['legs'] is False


def test_a_kind_left_out_is_not_there_and_unknown_ones_are_told():
    waters = training_tracks.WATERS['ship']
    for name in ('sharp', 'moored'):
        assert set(waters.names) - set(waters.without(name).names) == {name}
    with pytest.raises(ValueError, match="kind of motion 'canoe'; it must be one of steady, mix"):
        waters.without('canoe')
