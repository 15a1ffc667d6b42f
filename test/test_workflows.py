"""What runs on the project's page: workflows call what runs here, forms can be read."""

import os
from pathlib import Path

import pytest
from ruamel.yaml import YAML

ROOT = Path(__file__).resolve().parents[1]
GITHUB = ROOT / '.github'
if not GITHUB.is_dir():
    pytest.skip('no .github beside these tests', allow_module_level=True)


def read_yaml(file):
    return YAML(typ='safe', pure=True).load(file.read_text())


def workflow(name):
    """A workflow's only job."""
    read = read_yaml(GITHUB / 'workflows' / f'{name}.yaml')
    assert set(read['on']) == {'push', 'pull_request'}
    assert read['permissions'] == {'contents': 'read'}
    (job,) = read['jobs'].values()
    assert job['timeout-minutes'] and 'checkout' in job['steps'][0]['uses']
    return job


def commands(job):
    return [line.strip() for step in job['steps'] for line in step.get('run', '').splitlines()]


def test_every_workflow_is_tested_here():
    assert {file.name for file in (GITHUB / 'workflows').iterdir()} == {'ci.yaml', 'colcon.yaml'}


def test_ci_calls_what_anybody_can_call_on_the_systems_that_have_both_pythons():
    job = workflow('ci')
    assert commands(job) == ['.ci/run'] and os.access(ROOT / '.ci' / 'run', os.X_OK)
    # Python 3.11 and 3.12, the two for which there are wheels of ROS 2 Jazzy.
    assert job['container'] == '${{ matrix.image }}'
    assert job['strategy']['matrix']['image'] == ['debian:12', 'ubuntu:24.04']


def test_colcon_builds_and_tests_on_jazzy():
    job = workflow('colcon')
    assert job['container'] == 'ros:jazzy'
    run = commands(job)
    wanted = ['rosdep install', 'colcon build', 'colcon test ', 'colcon test-result']
    places = [next(k for k, line in enumerate(run) if line.startswith(one)) for one in wanted]
    assert places == sorted(places)
    # As doc/ros.md tells people to do it.
    keys = "--skip-keys 'python3-pywavelets python3-mcap python3-mcap-ros2-support'"
    assert 'source install/setup.bash' in run and keys in ' '.join(run)


def test_forms_have_a_name_and_ask_for_something():
    forms = sorted((GITHUB / 'ISSUE_TEMPLATE').iterdir())
    assert [form.name for form in forms] == ['bug.yaml', 'idea.yaml']
    for form in forms:
        read = read_yaml(form)
        assert read['name'] and read['description']
        names = [field['id'] for field in read['body']]
        assert len(names) == len(set(names))
        assert any(field.get('validations', {}).get('required') for field in read['body'])
