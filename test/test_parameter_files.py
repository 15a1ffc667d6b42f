from pathlib import Path

import pytest

from marine_tracker import parameter_files, yaml_file
from marine_tracker.parameters import NODES, from_mappings

CHECKOUT = Path(__file__).resolve().parents[1]


@pytest.mark.parametrize('name', parameter_files.files())
def test_the_shipped_file_is_what_the_dataclasses_say(name):
    assert (CHECKOUT / name).read_text() == parameter_files.files()[name], (
        f'run {parameter_files.COMMAND}'
    )


@pytest.mark.parametrize('node', NODES)
def test_the_yaml_of_a_node_reads_back_as_its_defaults(node):
    values = yaml_file.parse(parameter_files.node_yaml(node), 'it')['/**']['ros__parameters']
    assert from_mappings(NODES[node], values) == tuple(kind() for kind in NODES[node])


def test_every_parameter_stands_in_the_document_with_its_limits():
    text = parameter_files.document()
    assert '| `range_sigma_m` | `15.0` | m | 0.1 to 1000 | live |' in text
    assert 'one of ship, small_craft' in text


@pytest.mark.parametrize('value', ['', 'yes', '1.5', '~', 'a: b', '/tmp/x', 'imm', 2.0, 7, True])
def test_yaml_values_keep_their_type(value):
    written = parameter_files.yaml_value(value)
    read = yaml_file.parse(f'key: {written}', 'it')['key']
    assert read == value and type(read) is type(value)
