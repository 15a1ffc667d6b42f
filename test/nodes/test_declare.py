import dataclasses

import pytest

pytest.importorskip('rclpy')
import rclpy
import yaml  # comes with rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_dict_from_yaml_file

from marine_tracker.nodes.declare import declare, follow
from marine_tracker.parameters import NODES, TrackerParameters


@pytest.fixture
def start(domain):
    """start(yaml text or None, -p assignments) -> node that has not declared anything yet."""
    context, nodes = rclpy.context.Context(), []
    rclpy.init(context=context)

    def make(*arguments):
        nodes.append(
            Node(
                'tracker',
                context=context,
                cli_args=['--ros-args', *arguments] if arguments else None,
            )
        )
        return nodes[-1]

    yield make
    for node in nodes:
        node.destroy_node()
    context.try_shutdown()


def given(text):
    return ('-p', text)


def test_defaults_are_those_of_the_dataclass(start):
    assert declare(start(), TrackerParameters) == (TrackerParameters(),)


def test_a_parameter_file_is_read(start, tmp_path):
    file = tmp_path / 'own.yaml'
    file.write_text('/**:\n  ros__parameters:\n    range_sigma_m: 40.0\n    confirm_hits: 3\n')
    (parameters,) = declare(start('--params-file', str(file)), TrackerParameters)
    assert parameters == TrackerParameters(range_sigma_m=40.0, confirm_hits=3)


@pytest.mark.parametrize('node, kinds', NODES.items())
def test_the_shipped_parameter_file_is_the_defaults(start, node, kinds):
    from marine_tracker import config

    path = config.path(f'{node}.yaml')
    assert declare(start('--params-file', str(path)), *kinds) == tuple(kind() for kind in kinds)


@pytest.mark.parametrize(
    'text, said',
    [
        ('estimatr:=imm', 'unknown parameter estimatr; did you mean estimator?'),
        ('nested.thing:=1', 'unknown parameter nested.thing'),
        (
            'range_sigma_m:=15',
            r'range_sigma_m is 15, an integer; it must be a double \(write 15.0\)',
        ),
        ('confirm_hits:=4.0', 'confirm_hits is 4.0, a double; it must be an integer'),
        ('confirm_hits:=true', 'confirm_hits is True, a bool; it must be an integer'),
        ('estimator:=1', 'estimator is 1, an integer; it must be a string'),
        ('max_plots:=[1, 2]', r'max_plots is .*a list; it must be an integer'),
        ('confirm_hits:=[]', 'confirm_hits has no value'),
        ('range_sigma_m:=0.0', 'range_sigma_m is 0 m; it must be between 0.1 and 1000'),
        ('range_sigma_m:=.nan', 'range_sigma_m is nan; it must be finite'),
        ('range_sigma_m:=.inf', 'range_sigma_m is inf; it must be finite'),
        ('confirm_hits:=21', 'confirm_hits is 21; it must be between 2 and 20'),
        ('estimator:=kalmann', "estimator is 'kalmann'; it must be one of"),
        ('confirm_hits:=20', 'confirm_hits is 20; it must not exceed confirm_scans'),
    ],
)
def test_a_wrong_parameter_stops_the_start_and_is_named(start, text, said):
    with pytest.raises(ValueError, match=said):
        declare(start(*given(text)), TrackerParameters)


def test_parameters_of_rclpy_itself_are_not_unknown(start):
    node = start('-p', 'use_sim_time:=true', '-p', 'qos_overrides./tracks.publisher.depth:=5')
    assert declare(node, TrackerParameters) == (TrackerParameters(),)
    assert node.get_parameter('use_sim_time').value is True


def test_descriptors_tell_text_unit_and_limits(start):
    node = start()
    declare(node, TrackerParameters)
    sigma = node.describe_parameter('range_sigma_m')
    assert sigma.description == 'Standard deviation of a measured range. [m]'
    assert (sigma.floating_point_range[0].from_value, sigma.floating_point_range[0].to_value) == (
        0.1,
        1000.0,
    )
    assert not sigma.read_only
    assert node.describe_parameter('scan_period_s').read_only
    assert node.describe_parameter('confirm_hits').integer_range[0].to_value == 20
    assert 'imm' in node.describe_parameter('estimator').additional_constraints


def test_a_live_change_is_applied_after_it_was_accepted(start):
    node, applied = start(), []
    declare(node, TrackerParameters)
    follow(node, (TrackerParameters,), lambda made: made, applied.append)
    results = node.set_parameters([Parameter('estimator', value='cs_kalman')])
    assert results[0].successful
    assert applied == [TrackerParameters(estimator='cs_kalman')]


@pytest.mark.parametrize(
    'name, value, said',
    [
        ('range_sigma_m', -1.0, 'range'),
        ('estimator', 'kalmann', 'one of'),
        ('confirm_hits', 20, 'must not exceed'),
        ('scan_period_s', 3.0, 'read-only'),
        ('range_sigma_m', float('nan'), ''),
        ('range_sigma_m', 5, 'type'),
    ],
)
def test_a_live_change_that_is_wrong_is_refused_and_nothing_is_applied(start, name, value, said):
    node, applied = start(), []
    declare(node, TrackerParameters)
    follow(node, (TrackerParameters,), lambda made: made, applied.append)
    result = node.set_parameters([Parameter(name, value=value)])[0]
    assert not result.successful and said in result.reason
    assert applied == []
    assert node.get_parameter(name).value == getattr(TrackerParameters(), name)


def test_several_changes_at_once_are_judged_together(start):
    node, applied = start(), []
    declare(node, TrackerParameters)
    follow(node, (TrackerParameters,), lambda made: made, applied.append)
    result = node.set_parameters_atomically(
        [Parameter('confirm_hits', value=15), Parameter('confirm_scans', value=16)]
    )
    assert result.successful
    assert applied == [TrackerParameters(confirm_hits=15, confirm_scans=16)]


def test_a_change_another_callback_refuses_is_not_applied(start):
    from rcl_interfaces.msg import SetParametersResult

    node, applied = start(), []
    declare(node, TrackerParameters)
    follow(node, (TrackerParameters,), lambda made: made, applied.append)
    node.add_on_set_parameters_callback(
        lambda _: SetParametersResult(successful=False, reason='not now')
    )
    assert not node.set_parameters([Parameter('estimator', value='cs_kalman')])[0].successful
    assert applied == []


def test_use_sim_time_may_change_and_is_none_of_ours(start):
    node, applied = start(), []
    declare(node, TrackerParameters)
    follow(node, (TrackerParameters,), lambda made: made, applied.append)
    assert node.set_parameters([Parameter('use_sim_time', value=True)])[0].successful
    assert applied == []


@pytest.mark.parametrize('node, kinds', NODES.items())
def test_a_dump_of_the_nodes_own_parameters_is_loaded(start, tmp_path, node, kinds):
    """In the form in which `ros2 param dump` writes them and `ros2 param load` sets them."""
    here = start()
    values = declare(here, *kinds)
    follow(here, kinds, lambda *made: made, lambda made: None)
    names = [field.name for kind in kinds for field in dataclasses.fields(kind)]
    dump = {'/tracker': {'ros__parameters': {n: here.get_parameter(n).value for n in names}}}
    file = tmp_path / 'dump.yaml'
    file.write_text(yaml.dump(dump, default_flow_style=False))
    assert declare(start('--params-file', str(file)), *kinds) == values
    loaded = parameter_dict_from_yaml_file(str(file))
    assert set(loaded) == set(names)
    for message in loaded.values():
        (answer,) = here.set_parameters([Parameter.from_parameter_msg(message)])
        fixed = here.describe_parameter(message.name).read_only
        assert answer.successful or fixed, answer.reason


@pytest.mark.parametrize(
    'text, name, expected',
    [
        ('extent:=off', 'extent', 'none'),
        ('extent:=none', 'extent', 'none'),
        ('vectors:=true', 'vectors', 'absolute'),
        ('vectors:="true"', 'vectors', 'absolute'),
    ],
)
def test_words_of_earlier_versions_are_read_at_the_start(start, text, name, expected):
    here = start(*given(text))
    declare(here, *NODES['tracker'])
    assert here.get_parameter(name).value == expected
