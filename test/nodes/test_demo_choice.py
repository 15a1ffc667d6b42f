"""What a demo shows, chosen in its page: simulator or player and tracker start anew behind it."""

import asyncio
import json
import re
import signal
import subprocess
import sys

import pytest

pytest.importorskip('rclpy')
pytest.importorskip('aiohttp', reason='no aiohttp: the demo has no page')
import aiohttp

from marine_tracker.commands import demo_plan
from marine_tracker.nodes import domain as domains

ADDRESS = re.compile(r'radar picture: (http://\S+/)#(\S+)')


class Viewer:
    def __init__(self, link):
        self.link, self.newest = link, {}

    async def until(self, condition, patience=60):
        async def read():
            while not condition(self.newest):
                heard = json.loads((await self.link.receive()).data)
                self.newest[heard['kind']] = heard

        await asyncio.wait_for(read(), patience)

    async def command(self, name, **values):
        self.newest.pop('answer', None)
        await self.link.send_json({'command': name, **values})
        await self.until(lambda newest: 'answer' in newest)
        return self.newest['answer']


def numbers(newest):
    return newest.get('targets', {}).get('columns', {}).get('number', [])


@pytest.mark.slow
def test_scenario_recording_and_rate_are_chosen_in_the_page(launch, command, tmp_path):
    written = command('scenario', 'write', 'imo_3', tmp_path / 'tapes' / 'trial_run')
    assert written.returncode == 0, written.stderr

    async def act(address, token):
        async with aiohttp.ClientSession() as session, session.ws_connect(address + 'live') as link:
            page = Viewer(link)
            await page.until(lambda newest: newest.get('demo', {}).get('demo'))
            demo = page.newest['demo']['demo']
            assert demo['scenario'] == 'clean' and demo['rate'] == 20.0 and demo['run'] == 1
            assert 'imazu_07' in demo['scenarios'] and demo['recordings'] == ['trial_run']
            await page.until(lambda newest: len(numbers(newest)) >= 4)
            wanted = {'scenario': 'imazu_04', 'recording': '', 'rate': 12.0}
            assert 'looking only' in (await page.command('show', **wanted))['text']
            await link.send_json({'command': 'login', 'token': token})
            for wrong, said in (
                ({'scenario': '/etc/passwd'}, 'none of those that are offered'),
                ({'recording': '../trial_run'}, 'none of those that are offered'),
                ({'rate': 0.0}, 'between'),
                ({'scenario': 7}, 'a text'),
            ):
                answer = await page.command('show', **{**wanted, **wrong})
                assert not answer['ok'] and said in answer['text'], answer
            assert (await page.command('show', **wanted))['ok']
            await page.until(lambda newest: newest['demo']['demo']['run'] == 2)
            page.newest.pop('targets', None)
            await page.until(lambda newest: len(numbers(newest)) == 1)  # one ship meets own ship
            assert (await page.command('show', **{**wanted, 'recording': 'trial_run'}))['ok']
            await page.until(lambda newest: newest['demo']['demo']['run'] == 3)
            assert page.newest['demo']['demo']['recording'] == 'trial_run'
            page.newest.pop('targets', None)
            await page.until(lambda newest: len(numbers(newest)) == 1)

    with domains.free_domain() as number:
        process = launch(
            '__main__', 'demo', '--domain', str(number), '--scenario', 'clean', '--rate', '20',
            '--recordings', str(tmp_path / 'tapes'),
        )  # fmt: skip
        assert process.says('radar picture'), process.said
        address, token = ADDRESS.search(process.said).groups()
        asyncio.run(act(address, token))
        process.stop(signal.SIGINT)
        assert 'Traceback' not in process.said


def test_recordings_are_offered_by_name_beside_the_one_that_was_given(tmp_path):
    for name in ('first', 'second'):
        (tmp_path / name).mkdir()
        (tmp_path / name / 'plots.csv').touch()
    (tmp_path / 'notes').mkdir()
    offers = demo_plan.offers('encounters', str(tmp_path / 'second'), None)
    assert offers.recordings == {name: str(tmp_path / name) for name in ('first', 'second')}
    assert offers.shown('encounters', str(tmp_path / 'second'), 2) == ('encounters', 'second', 2.0)
    assert demo_plan.offers('encounters', None, None).recordings == {}
    with pytest.raises(ValueError, match='no such folder'):
        demo_plan.offers('encounters', None, str(tmp_path / 'tapes'))


@pytest.mark.slow
def test_a_port_that_somebody_else_took_meanwhile_does_not_end_the_demo(tmp_path):
    script = (
        'import socket, sys\n'
        'from marine_tracker import cli\n'
        'from marine_tracker.commands import demo_page\n'
        'taken = socket.socket()\n'
        "taken.bind(('127.0.0.1', 0))\n"
        'taken.listen()\n'
        'demo_page.free_port = lambda: taken.getsockname()[1]\n'
        "sys.exit(cli.main(['demo', '--scenario', 'clean', '--duration', '12']))\n"
    )
    done = subprocess.run(
        [sys.executable, '-c', script], capture_output=True, text=True, timeout=100
    )
    assert done.returncode == 0, done.stderr
    assert ADDRESS.search(done.stdout)
