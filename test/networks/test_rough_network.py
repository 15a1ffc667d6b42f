import numpy as np
import pytest

from marine_tracker.networks import rough_network as net

ROUGH, PLAIN = net.shapes(3, 6, 2), net.shapes(3, 6, 1)


def random_inputs(count, neurons, seed=3):
    values = np.random.default_rng(seed).uniform(-0.1, 1.5, (count, 3, neurons))
    return np.sort(values, -1)


def by_hand(network, inputs):
    """[lower, upper] of the output node for one sample, node by node as the paper writes it."""

    def f(x):
        return 2 / (1 + np.exp(-x)) - 1

    def node(below, to_lower, to_upper, theta):
        """below [(L, U)]; to_lower, to_upper [(from L, from U)]; theta (L, U)."""
        in_upper = sum(wl * low + wu * up for (low, up), (wl, wu) in zip(below, to_upper))
        in_lower = sum(wl * low + wu * up for (low, up), (wl, wu) in zip(below, to_lower))
        a, b = f(in_upper - theta[1]), f(in_lower - theta[0])
        return min(a, b), max(a, b)

    hidden = [
        node(inputs, network.inner[:, :, j, 0], network.inner[:, :, j, 1], network.inner_theta[j])
        for j in range(6)
    ]
    return node(hidden, network.outer[:, :, 0], network.outer[:, :, 1], network.outer_theta)


@pytest.fixture
def rough():
    return net.draw(ROUGH, np.random.default_rng(1), 1.0)


def test_the_rough_network_is_that_of_the_paper_node_by_node(rough):
    inputs = random_inputs(20, 2)
    expected = [by_hand(rough, sample) for sample in inputs]
    np.testing.assert_allclose(net.bounds(rough, inputs), expected, rtol=1e-12)
    np.testing.assert_allclose(net.forward(rough, inputs), np.mean(expected, 1), rtol=1e-12)


def test_the_upper_neuron_is_never_below_the_lower_one(rough):
    lower, upper = net.bounds(rough, random_inputs(1000, 2)).T
    assert (upper >= lower).all() and (upper > lower).any()
    assert (np.abs(upper) < 1).all()


def test_one_neuron_to_a_node_is_the_plain_network():
    plain = net.draw(PLAIN, np.random.default_rng(2), 1.0)
    x = random_inputs(50, 1)
    hidden = np.tanh((x[:, :, 0] @ plain.inner[:, 0, :, 0] - plain.inner_theta[:, 0]) / 2)
    expected = np.tanh((hidden @ plain.outer[:, 0, 0] - plain.outer_theta[0]) / 2)
    np.testing.assert_allclose(net.forward(plain, x), expected, rtol=1e-12)


def test_alike_neurons_and_inputs_make_a_rough_network_a_plain_one():
    plain = net.draw(PLAIN, np.random.default_rng(2), 1.0)
    form = np.eye(2)
    rough = net.Network(
        plain.inner * form[None, :, None],
        np.repeat(plain.inner_theta, 2, 1),
        plain.outer * form,
        np.repeat(plain.outer_theta, 2),
    )
    x = random_inputs(50, 1)
    np.testing.assert_allclose(
        net.forward(rough, np.repeat(x, 2, 2)), net.forward(plain, x), rtol=1e-12
    )


@pytest.mark.parametrize('form', [ROUGH, PLAIN], ids=['rough', 'plain'])
def test_the_gradient_is_that_of_finite_differences(form):
    network = net.draw(form, np.random.default_rng(5), 1.0)
    inputs = random_inputs(30, form[0][1])
    vector, step = net.to_vector(network), 1e-6
    found = net.jacobian(network, inputs)
    assert found.shape == (30, len(vector))
    for i in range(len(vector)):
        moved = step * (np.arange(len(vector)) == i)
        ahead, behind = (
            net.forward(net.from_vector(v, form), inputs) for v in (vector + moved, vector - moved)
        )
        np.testing.assert_allclose(found[:, i], (ahead - behind) / (2 * step), atol=1e-8)


def test_a_vector_holds_the_whole_network(rough):
    for one, other in zip(net.from_vector(net.to_vector(rough), ROUGH), rough, strict=True):
        np.testing.assert_array_equal(one, other)


def test_no_rows_are_no_rows(rough):
    assert net.forward(rough, np.zeros((0, 3, 2))).shape == (0,)
    assert net.jacobian(rough, np.zeros((0, 3, 2))).shape == (0, 110)
