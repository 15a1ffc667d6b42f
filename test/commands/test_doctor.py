import json
import sys

import pytest

from marine_tracker.commands import doctor


def test_where_the_core_works_the_exit_code_is_0(command):
    done = command('doctor', '--listen', '0')
    assert done.returncode == 0 and done.stderr == ''
    for name in (
        'Python',
        'numpy',
        'scipy',
        'PyWavelets',
        'ruamel.yaml',
        'rich',
        'matplotlib',
        'configuration',
        'Fast DDS profile',
        'ROS_DISTRO',
        'AMENT_PREFIX_PATH',
        'ROS_DOMAIN_ID',
        'rclpy',
        'ROS message packages',
    ):
        assert f'   {name}: ' in done.stdout, name


def test_json_holds_the_same_checks(command, tmp_path):
    done = command('doctor', '--listen', '0', '--json', '-', ROS_DOMAIN_ID='42')
    checks = {check['name']: check for check in json.loads(done.stdout)['checks']}
    assert checks['ROS_DOMAIN_ID']['found'] == '42'
    assert checks['numpy'] == {
        'name': 'numpy',
        'ok': True,
        'advice': '',
        'required': True,
        'found': checks['numpy']['found'],
    }


@pytest.mark.parametrize(('module', 'package'), doctor.REQUIRED.items())
def test_a_required_package_that_cannot_be_imported_is_exit_code_1(
    command, tmp_path, module, package
):
    # A broken installation, found before the real one.
    (tmp_path / f'{module.split(".")[0]}.py').write_text('raise RuntimeError("half installed")')
    source = doctor.config.path().parent
    done = command('doctor', '--listen', '0', PYTHONPATH=f'{tmp_path}:{source}')
    assert done.returncode == 1 and done.stderr == ''
    assert f'MISS   {package}: cannot be imported: half installed' in done.stdout
    assert f'-> pip install {package}' in done.stdout


def test_a_package_that_is_not_there_is_told_with_what_to_do(monkeypatch):
    monkeypatch.setitem(doctor.OPTIONAL, 'no_such_module', ('no-such', 'for a test'))
    check = {check.name: check for check in doctor.examine(0)}['no-such']
    assert not check.ok and not check.required
    assert doctor.line(check).splitlines() == [
        'note   no-such: not installed',
        '       -> pip install no-such (for a test)',
    ]


def test_a_profile_that_does_not_exist_is_told(monkeypatch):
    monkeypatch.setenv('FASTRTPS_DEFAULT_PROFILES_FILE', '/no/such.xml')
    check = {check.name: check for check in doctor.examine(0)}['Fast DDS profile']
    assert not check.ok and check.found == '/no/such.xml does not exist'


def test_python_too_old_is_told(monkeypatch):
    monkeypatch.setattr(sys, 'version_info', (3, 9, 1))
    check = next(iter(doctor.examine(0)))
    assert not check.ok and check.required and check.advice == 'install Python 3.11 or later'
