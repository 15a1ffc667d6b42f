"""What launch files and layouts name is there: nodes, parameters, topics, files."""

import json
import os
import re
import signal
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from ruamel.yaml import YAML

pytest.importorskip('rclpy')
from marine_tracker.nodes import recorded_topics, run, topics
from marine_tracker.parameter_files import fields
from marine_tracker.parameters import NODES, from_mappings

ROOT = Path(run.__file__).resolve().parents[2]
FILES = sorted((ROOT / 'launch').glob('*.xml'))
ARGUMENT = re.compile(r'\$\(var (\w+)\)')
SHARE = '$(find-pkg-share marine_tracker)/'
TOPICS = {
    wanted.name: wanted.kind for wanted in recorded_topics.of_this_package([topics.PLOTS], [])
}


def tree(file):
    return ET.parse(file).getroot()


def arguments(file):
    return {one.get('name'): one for one in tree(file).findall('arg')}


def test_there_are_launch_files_for_each_use():
    assert [file.name for file in FILES] == [
        'playback.launch.xml',
        'simulation.launch.xml',
        'tracker.launch.xml',
        'two_radars.launch.xml',
    ]


@pytest.mark.parametrize('file', FILES, ids=lambda file: file.name)
def test_every_node_parameter_remap_and_argument_in_a_launch_file_exists(file):
    root, known = (
        tree(file),
        {*arguments(file), *(one.get('name') for one in tree(file).iter('let'))},
    )
    used = {
        name
        for one in root.iter()
        for value in one.attrib.values()
        for name in ARGUMENT.findall(value)
    }
    assert used <= known and {*arguments(file)} <= used
    assert all(one.get('description') for one in arguments(file).values())
    for node in root.iter('node'):
        name = node.get('exec')
        assert node.get('pkg') == 'marine_tracker' and name in run.NODES
        assert node.get('name') == name
        parameters = {field.name: field for field in fields(name)}
        for one in node.findall('param'):
            if one.get('from'):
                path = one.get('from')
                default = arguments(file).get('params_file')
                path = default.get('default') if '$(var' in path else path
                assert (ROOT / path.removeprefix(SHARE)).is_file()
            elif one.get('name') != 'use_sim_time':
                field, value = parameters[one.get('name')], one.get('value')
                if not ARGUMENT.search(value):
                    read = YAML(typ='safe', pure=True).load(value)
                    from_mappings(NODES[name], {field.name: read})
                elif field.type is str and field.default == '':
                    assert one.get('type') == 'str'  # else an empty text is no text
        for one in node.findall('remap'):
            assert one.get('from') in TOPICS
    for one in root.iter('include'):
        other = ROOT / one.get('file').removeprefix(SHARE)
        assert {arg.get('name') for arg in one.findall('arg')} <= set(arguments(other))


def test_the_layout_for_rviz_shows_topics_of_ours_by_their_types():
    layout = YAML(typ='safe', pure=True).load(ROOT / 'layouts' / 'marine_tracker.rviz')
    manager = layout['Visualization Manager']
    shown = [one for one in manager['Displays'] if 'Topic' in one]
    assert {one['Topic']['Value'] for one in shown} >= {'markers', 'radar/plots'}
    for one in shown:
        assert one['Class'].rpartition('/')[2] == TOPICS[one['Topic']['Value']].__name__
    for tool in manager['Tools']:
        assert tool.get('Topic', {'Value': 'clicked_point'})['Value'] in TOPICS
    assert manager['Global Options']['Fixed Frame'] == topics.FRAME


def test_the_layout_for_foxglove_shows_topics_of_ours_and_fields_that_they_have():
    from marine_tracker.nodes import convert, targets_cloud

    layout = json.loads((ROOT / 'layouts' / 'foxglove.json').read_text())
    fields_of = {
        '/radar/plots': convert.PLOT_FIELDS,
        '/tracks_cloud': convert.TRACK_TYPE.names,
        '/targets_cloud': targets_cloud.TARGET_TYPE.names,
    }
    named = []
    for name, panel in layout['configById'].items():
        for topic, how in panel.get('topics', {}).items():
            named.append(topic)
            if 'colorField' in how:
                assert how['colorField'] in fields_of[topic]
        named += [panel[key] for key in ('topicToRender', 'topicPath') if key in panel]
        named += [path['value'].partition('.')[0] for path in panel.get('paths', [])]
        assert name in json.dumps(layout['layout'])
    for one in named:
        assert one in TOPICS or one.removeprefix('/') in TOPICS, one


@pytest.mark.parametrize(
    ('name', 'given', 'says'),
    [
        (
            'simulation',
            ('scenario:=clean', 'rate:=4.0'),
            ('scenario clean', 'waiting for', 'rate 4'),
        ),
        ('two_radars', ('display:=false',), ('scenario two_radars_s', 'scenario two_radars_x')),
    ],
)
def test_launch_files_start_under_ros_launch(domain, node_helpers, tmp_path, name, given, says):
    wait_until, _ = node_helpers
    pytest.importorskip('launch_ros', reason='no launch_ros: not to be had from PyPI')
    from ament_index_python.packages import get_package_prefix

    share = Path(get_package_prefix('marine_tracker'), 'share', 'marine_tracker', 'launch')
    program = (
        'import sys, launch, launch.launch_description_sources as s, launch.actions as a\n'
        'service = launch.LaunchService(argv=sys.argv[2:])\n'
        'given = [tuple(one.split(":=")) for one in sys.argv[2:]]\n'
        'source = s.AnyLaunchDescriptionSource(sys.argv[1])\n'
        'service.include_launch_description(launch.LaunchDescription(\n'
        '    [a.IncludeLaunchDescription(source, launch_arguments=given)]))\n'
        'sys.exit(service.run())\n'
    )
    log = tmp_path / 'launch.log'
    with open(log, 'wb') as file:
        process = subprocess.Popen(
            [sys.executable, '-c', program, str(share / f'{name}.launch.xml'), *given],
            stdout=file,
            stderr=file,
            env={**os.environ, 'PYTHONUNBUFFERED': '1'},
        )
    try:
        wait_until(lambda: all(one in log.read_text() for one in says))
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(30)
    assert 'Traceback' not in log.read_text()
