"""The wavelet network against its definition, differences and its own training."""

import numpy as np
import pytest

from marine_tracker.networks import wavelet_network as net
from marine_tracker.networks import wavelets
from marine_tracker.training import adam

LAYOUT = net.Layout(levels=2, translations=5, q=1.2, outputs=3)
INPUTS = 4


def made(layout):
    rng = np.random.default_rng(3)
    network = net.start(layout, rng.normal(size=INPUTS), rng.uniform(0.5, 2, INPUTS), rng, float)
    return network._replace(bias=rng.normal(size=layout.outputs))


@pytest.fixture
def network():
    return made(LAYOUT)


@pytest.fixture(params=[net.WAVELET, net.TANH])
def either(request):
    """A network of wavelets, and one of as many plain units."""
    return made(LAYOUT._replace(units=request.param))


@pytest.fixture
def inputs():
    return np.random.default_rng(4).normal(0, 2, (7, INPUTS))


def test_the_number_of_hidden_units_follows_from_levels_translations_and_outputs(network):
    assert net.group_size(LAYOUT) == 5 * (2 + 2)
    assert network.inner.shape == (INPUTS + 1, 60)
    assert network.outer.shape == (3, 20)
    # The paper's own: four outputs, M = 1 and 2.
    for levels, hidden in ((1, 60), (2, 80)):
        assert 4 * net.group_size(net.Layout(levels, 5, 1.0, 4)) == hidden


def test_hidden_units_are_the_scaling_functions_and_wavelets_of_the_paper():
    layout = LAYOUT._replace(outputs=1)
    t = np.linspace(-30, 30, 401)
    value, _ = net.hidden(net.units(layout), np.repeat(t[:, None], 20, 1))
    shifts = np.arange(5) - 2.0
    expected = [(2, k, wavelets.scaling) for k in shifts]
    expected += [(m, k, wavelets.wavelet) for m in range(3) for k in shifts]
    for unit, (m, k, shape) in enumerate(expected):
        np.testing.assert_allclose(
            value[:, unit], 2 ** (-m / 2) * shape(t / 2**m - k, 1.2), atol=1e-14
        )


def test_plain_units_are_the_sigmoid_of_the_input_layer(inputs):
    plain = made(LAYOUT._replace(units=net.TANH))
    assert plain.inner.shape == (INPUTS + 1, 60) and plain.outer.shape == (3, 20)
    net_input = net.squash(plain, inputs) @ plain.inner
    value = wavelets.sigmoid(net_input, 1.2).reshape(-1, 3, 20)
    expected = (value * plain.outer).sum(2) + plain.bias
    np.testing.assert_allclose(net.forward(plain, inputs), expected, rtol=1e-12)


def test_units_of_no_known_kind_are_refused():
    with pytest.raises(ValueError, match="are 'relu'; they must be 'wavelet' or 'tanh'"):
        net.units(LAYOUT._replace(units='relu'))


def test_outputs_see_their_own_units_only(either, inputs):
    """Local connection: changing one group's weights moves one output."""
    before = net.forward(either, inputs)
    inner, outer = either.inner.copy(), either.outer.copy()
    inner[:, 20:40] += 0.3
    outer[1] += 0.2
    after = net.forward(either._replace(inner=inner, outer=outer), inputs)
    np.testing.assert_array_equal(after[:, [0, 2]], before[:, [0, 2]])
    assert (after[:, 1] != before[:, 1]).all()


def test_output_is_that_of_the_definition_written_out(network, inputs):
    layer = np.tanh((inputs - network.centre) / network.scale / 2)
    net_input = np.column_stack([layer, np.ones(len(inputs))]) @ network.inner
    value, _ = net.hidden(net.units(LAYOUT), net_input)
    expected = (value.reshape(-1, 3, 20) * network.outer).sum(2) + network.bias
    np.testing.assert_allclose(net.forward(network, inputs), expected, rtol=1e-12)


def test_many_rows_give_what_each_gives_alone(either):
    inputs = np.random.default_rng(5).normal(0, 2, (3 * net.BLOCK + 5, INPUTS))
    together = net.forward(either, inputs)
    alone = np.concatenate([net.forward(either, row[None]) for row in inputs[::40]])
    np.testing.assert_allclose(together[::40], alone, rtol=1e-10, atol=1e-12)


def test_jacobian_is_that_of_differences(either, inputs):
    found = net.jacobian(either, inputs)
    step = 1e-6
    for i in range(INPUTS):
        push = np.zeros(INPUTS)
        push[i] = step
        slope = (net.forward(either, inputs + push) - net.forward(either, inputs - push)) / (
            2 * step
        )
        np.testing.assert_allclose(found[:, :, i], slope, rtol=1e-6, atol=1e-8)


@pytest.mark.parametrize('part', ['inner', 'outer', 'bias'])
def test_gradients_are_those_of_differences(either, inputs, part):
    target = np.random.default_rng(6).normal(size=(len(inputs), LAYOUT.outputs))

    def loss(one):
        return 0.5 * np.square(net.forward(one, inputs) - target).sum()

    form = net.units(either.layout)
    layer = net.squash(either, inputs)
    value, tanh = net.hidden(form, layer @ either.inner)
    gradients = dict(
        zip(
            ('inner', 'outer', 'bias'),
            net.backward(either, form, layer, value, tanh, net.forward(either, inputs) - target),
        )
    )
    weights = getattr(either, part)
    rng = np.random.default_rng(7)
    for _ in range(20):
        at = tuple(rng.integers(0, size) for size in weights.shape)
        push = np.zeros_like(weights)
        push[at] = 1e-6
        slope = (
            loss(either._replace(**{part: weights + push}))
            - loss(either._replace(**{part: weights - push}))
        ) / 2e-6
        assert gradients[part][at] == pytest.approx(slope, rel=1e-5, abs=1e-7)


def test_wild_inputs_stay_finite(network):
    inputs = np.array([[1e300, -1e300, 0.0, 1e9]])
    assert np.isfinite(net.forward(network, inputs)).all()


def test_adam_trains_it_to_a_function_of_two_variables():
    """x y is no sum of functions of x and y; 300 steps take the error to a tenth of its size."""
    rng = np.random.default_rng(8)
    layout = net.Layout(2, 5, 1.2, 1)
    network = net.start(layout, np.zeros(2), np.ones(2), rng, float)
    parameters = [network.inner, network.outer, network.bias]
    form, moments = net.units(layout), adam.start(parameters)
    for step in range(300):
        x = rng.normal(size=(256, 2))
        layer = net.squash(network, x)
        value, tanh = net.hidden(form, layer @ network.inner)
        error = value @ net.connect(network.outer) + network.bias - x[:, :1] * x[:, 1:]
        moments = adam.step(
            parameters,
            net.backward(network, form, layer, value, tanh, error / len(x)),
            moments,
            adam.cosine(step, 300, 0.02, 10),
        )
    x = np.random.default_rng(9).normal(size=(2000, 2))
    error = net.forward(network, x)[:, 0] - x[:, 0] * x[:, 1]
    assert np.square(error).mean() < 0.1


def test_the_rate_rises_then_falls_to_nothing():
    rates = [adam.cosine(step, 1000, 2.0, 100) for step in range(1000)]
    assert rates[0] == pytest.approx(0.02)
    assert np.argmax(rates) in range(90, 100)
    assert rates[-1] < 1e-4
