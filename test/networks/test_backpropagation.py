import numpy as np
import pytest

from marine_tracker.networks import backpropagation as net
from marine_tracker.types import take

RULE = net.Rule(step=0.1)


@pytest.fixture(params=['bp', 'gwnn'])
def design(request):
    return net.bp(3, 2, 8, 1.2) if request.param == 'bp' else net.gwnn(3, 2, 1, 3, 1.2)


@pytest.fixture
def batch(design):
    """Weights that differ from row to row, inputs and wanted outputs of five networks."""
    rng = np.random.default_rng(4)
    weights = net.draw(design, 5, rng)
    weights = weights._replace(inner=weights.inner * rng.normal(size=(5, 1, 1)))
    return weights, rng.normal(size=(5, 3)), rng.normal(size=(5, 2))


def loss(design, weights, inputs, wanted):
    return 0.5 * np.sum((wanted - net.forward(design, weights, inputs).output) ** 2, 1)


def test_hidden_units_follow_from_levels_translations_and_outputs():
    for levels, hidden in ((1, 60), (2, 80)):
        weights = net.draw(net.gwnn(4, 4, levels, 5, 1.2), 1, np.random.default_rng(1))
        assert weights.inner.shape == (1, hidden, 5)
        assert weights.outer.shape == (1, 4, hidden // 4)


def test_weights_begin_positive_and_scaled(design):
    weights = net.draw(design, 200, np.random.default_rng(1))
    for array, top in ((weights.inner, net.INNER_SCALE), (weights.outer, net.OUTER_SCALE)):
        assert 0 < array.min() < 0.01 * top
        assert 0.99 * top < array.max() <= top


def test_each_output_of_a_wavelet_network_sees_its_own_group_only():
    design = net.gwnn(3, 2, 1, 3, 1.2)
    weights = net.draw(design, 1, np.random.default_rng(1))
    inputs = np.ones((1, 3))
    before = net.forward(design, weights, inputs).output
    weights.inner[:, design.group :] += 1.0
    after = net.forward(design, weights, inputs).output
    assert after[0, 0] == before[0, 0]
    assert abs(after[0, 1] - before[0, 1]) > 1e-3


def test_corrections_go_down_the_gradient(design, batch):
    """Against finite differences of the squared error, every weight."""
    weights, inputs, wanted = batch
    error = wanted - net.forward(design, weights, inputs).output
    changed = net.correct(
        weights, net.forward(design, weights, inputs), error, np.full(5, 0.01), variable=False
    )
    h = 1e-6
    for name in ('inner', 'outer'):
        array = getattr(weights, name)
        found = np.empty_like(array)
        for index in np.ndindex(array.shape[1:]):
            at = (slice(None), *index)
            up, down = array.copy(), array.copy()
            up[at] += h
            down[at] -= h
            found[at] = (
                loss(design, weights._replace(**{name: up}), inputs, wanted)
                - loss(design, weights._replace(**{name: down}), inputs, wanted)
            ) / (2 * h)
        np.testing.assert_allclose(getattr(changed, name) - array, -0.01 * found, atol=1e-9)


def test_the_gradient_by_the_inputs_agrees_with_finite_differences(design, batch):
    weights, inputs, wanted = batch
    error = wanted - net.forward(design, weights, inputs).output
    found, h = np.empty_like(inputs), 1e-6
    for i in range(3):
        off = h * np.eye(3)[i]
        found[:, i] = (
            loss(design, weights, inputs + off, wanted)
            - loss(design, weights, inputs - off, wanted)
        ) / (2 * h)
    np.testing.assert_allclose(
        net.input_gradient(design, weights, inputs, error), -found, atol=1e-8
    )


def test_momentum_is_the_share_of_the_layers_squared_error():
    found = net.momentum(np.array([[3.0, 4.0, 0.0], [0.0, 0.0, 0.0], [5.0, 0.0, 0.0]]))
    np.testing.assert_allclose(found, [[0.36, 0.64, 0.0], [0, 0, 0], [net.MAX_MOMENTUM, 0, 0]])


def test_momentum_carries_the_last_change_on(design, batch):
    weights, inputs, wanted = batch
    passed = net.forward(design, weights, inputs)
    error = wanted - passed.output
    weights = weights._replace(outer_change=np.ones_like(weights.outer))
    with_it = net.correct(weights, passed, error, np.full(5, 0.01))
    without = net.correct(weights, passed, error, np.full(5, 0.01), variable=False)
    np.testing.assert_allclose(
        with_it.outer - without.outer,
        np.broadcast_to(net.momentum(error)[..., None], weights.outer.shape),
        atol=1e-12,
    )
    np.testing.assert_array_equal(with_it.inner, without.inner)


def test_fast_targets_begin_with_small_steps():
    step = net.first_step(RULE, np.array([0.0, 5.0, 12.0, 40.0, 1e9]))
    assert (np.diff(step) <= 0).all() and step[0] < 2 * RULE.step and step[-1] >= 0
    # At v = v2 the second term is a half; the first is nearly 1 there.
    assert step[1] == pytest.approx(0.1 * (0.5 + 1 / (1 + np.exp(-3.5))))
    np.testing.assert_array_equal(net.first_step(RULE._replace(variable=False), step), 0.1)


def test_the_step_grows_while_far_and_falling_and_shrinks_when_rising():
    error, before = np.array([20.0, 5.0, 20.0, 5.0]), np.array([25.0, 6.0, 19.0, 4.0])
    np.testing.assert_allclose(
        net.next_step(RULE, np.ones(4), error, before, 9.26), [1.05, 1.0, 0.7, 0.7]
    )


def test_learning_stops_at_e1_and_leaves_the_row_alone(design, batch):
    weights, inputs, _ = batch
    wanted = net.forward(design, weights, inputs).output + 0.01
    after = net.learn(
        design, weights, inputs, wanted, np.full(5, 8.0), RULE._replace(rounds=5), 60.0, 1.852, 9.26
    )
    for a, b in zip(after, weights):
        np.testing.assert_array_equal(a, b)


def test_learning_brings_the_output_to_the_target(design, batch):
    weights, inputs, wanted = batch
    wanted = 0.3 * wanted
    assert (60 * np.hypot(*(wanted - net.forward(design, weights, inputs).output).T) > 5).all()
    after = net.learn(
        design,
        weights,
        inputs,
        wanted,
        np.full(5, 8.0),
        RULE._replace(rounds=300),
        60.0,
        1.852,
        9.26,
    )
    error = wanted - net.forward(design, after, inputs).output
    assert (60 * np.hypot(*error.T) <= 1.852).all()


def test_networks_do_not_depend_on_each_other(design, batch):
    weights, inputs, wanted = batch
    kept = [array.copy() for array in weights]
    rule = RULE._replace(rounds=7)
    speed, near = np.linspace(2, 20, 5), np.linspace(1, 3, 5)
    together = net.learn(design, weights, inputs, wanted, speed, rule, 60.0, near, 5 * near)
    for row in range(5):
        one = np.array([row])
        alone = net.learn(
            design,
            take(weights, one),
            inputs[one],
            wanted[one],
            speed[one],
            rule,
            60.0,
            near[one],
            5 * near[one],
        )
        for a, b in zip(alone, take(together, one)):
            np.testing.assert_allclose(a, b, rtol=1e-10, atol=1e-12)
    for array, before in zip(weights, kept):
        np.testing.assert_array_equal(array, before)


def test_a_target_that_is_no_number_teaches_nothing(batch, design):
    weights, inputs, wanted = batch
    wanted[2] = np.nan
    after = net.learn(design, weights, inputs, wanted, np.full(5, 8.0), RULE, 60.0, 1.852, 9.26)
    assert np.isfinite(after.inner).all()
    np.testing.assert_array_equal(after.inner[2], weights.inner[2])
    assert (after.inner[3] != weights.inner[3]).any()
