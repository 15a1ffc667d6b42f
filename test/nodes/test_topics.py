"""Every topic that the nodes publish is told in doc/topics.md, with a message, and recorded."""

import re
from pathlib import Path

import pytest

pytest.importorskip('rclpy')
from marine_tracker.nodes import recorded_topics, topics
from marine_tracker.nodes.ais_input_node import AisInputNode
from marine_tracker.nodes.nmea_output_node import NmeaOutputNode
from marine_tracker.nodes.plot_extractor_node import PlotExtractorNode
from marine_tracker.nodes.ppi_display_node import PpiDisplayNode
from marine_tracker.nodes.radar_simulator_node import RadarSimulatorNode
from marine_tracker.nodes.recorder_node import RecorderNode
from marine_tracker.nodes.tracker_node import TrackerNode
from marine_tracker.parameters import RecorderParameters

PAGE = (Path(__file__).resolve().parents[2] / 'doc' / 'topics.md').read_text()
SCENE = """
duration_s: 60
origin: {lat_deg: 43.2, lon_deg: 5.1}
own_ship: {course_deg: 15, speed_kn: 9}
ais: {send: {share: 1.0}}
targets:
- {name: pilot, start: {range_nm: 2, bearing_deg: 80}, course_deg: 300, speed_kn: 17}
"""
OF_RCLPY = {'rosout', 'parameter_events'}


def nodes(tmp_path):
    """Each node with parameters under which it publishes all that it can."""
    scene, video = tmp_path / 'scene.yaml', tmp_path / 'video.yaml'
    scene.write_text(SCENE)
    video.write_text(SCENE + 'radar: {video: {spokes: 512, samples: 128}}\n')
    return (
        (TrackerNode, {}),
        (RadarSimulatorNode, {'scenario': str(scene), 'rate': 2.0}),
        (RadarSimulatorNode, {'scenario': str(video)}),
        (PlotExtractorNode, {}),
        (NmeaOutputNode, {'udp': ''}),
        (AisInputNode, {'udp': ''}),
        (PpiDisplayNode, {'address': '127.0.0.1:0'}),
        (RecorderNode, {'folder': str(tmp_path / 'recording'), 'keep_free_mb': 0}),
    )


@pytest.fixture
def published(graph, tmp_path):
    """The names of all topics that nodes of this package publish, without those under a node's
    own name."""
    found, made = set(), []
    for k, (kind, parameters) in enumerate(nodes(tmp_path)):
        node = graph.make(kind, ('-r', f'__node:=node_{k}'), **parameters)
        own = f'{node.get_fully_qualified_name()}/'
        pairs = node.get_publisher_names_and_types_by_node(node.get_name(), node.get_namespace())
        found |= {name for name, _ in pairs if not name.startswith(own)}
        made.append(node)
    for node in made:
        node.close()
    return {name.removeprefix('/') for name in found}


def test_every_published_topic_has_a_row_and_a_message_in_the_doc_and_is_recorded(published):
    assert len(published) > 30
    rows = {
        name
        for row in re.findall(r'^\| (`[^|]*`) \|', PAGE, re.M)
        for name in re.findall(r'`/?([^`]+)`', row)
    }
    messages = set(re.findall(r'^# /?([\w/]+)', PAGE, re.M))
    ours = {
        one for one in published - OF_RCLPY if not one.startswith('ais/')
    }  # doc/ais.md has them
    assert ours <= rows, f'no row: {sorted(ours - rows)}'
    assert ours <= messages | sent_by_hand(), f'no message: {sorted(ours - messages)}'
    recorded = {
        one.name.removeprefix('/') for one in recorded_topics.of_this_package([topics.PLOTS], [])
    }
    assert published <= recorded, f'not recorded: {sorted(published - recorded)}'
    assert set(RecorderParameters().without.split()) <= recorded


def sent_by_hand():
    """Topics of one number or one point: the page shows one of each, as a command."""
    return {*topics.NUMBERS, topics.ACQUIRE, topics.EXPLAIN}
