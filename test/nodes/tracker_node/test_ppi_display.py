"""The PPI beside a tracker over DDS: what a viewer gets and what its commands do."""

import asyncio

import numpy as np
import pytest

pytest.importorskip('rclpy')
pytest.importorskip('aiohttp', reason='no aiohttp: the display is not tested')
import aiohttp
from rcl_interfaces.srv import SetParameters
from rclpy.node import Node
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Trigger

from marine_tracker.display import server
from marine_tracker.nodes import convert, topics
from marine_tracker.nodes.ppi_display_node import PpiDisplayNode

SHIPS = [(3.1, 20, 200, 12), (2.2, 300, 90, 7), (4.0, 110, 285, 15)]


@pytest.fixture
def sea(simulated):
    return simulated(SHIPS, 200)


def test_a_viewer_sees_the_picture_of_the_tracker(bridge, sea, display, look):
    here = bridge(sea, cpa_limit_nm=2.0, tcpa_limit_min=60.0)
    node = display(here)

    async def act(viewer):
        await viewer.until(lambda me: 'pulse' in me.newest)
        await asyncio.to_thread(here.sail, 14)
        await viewer.until(
            lambda me: (
                {'targets', 'own', 'plots', 'alarms', 'trails', 'limits', 'health'}
                <= set(me.newest)
                and me.newest['targets']['time'] * 1e9 >= here.stamp(here.last.end) - 1e6
                and me.newest['plots']['stamp'] * 1e9 >= here.stamp(here.last.start) - 1e6
            )
        )
        return viewer.newest

    seen = look(node, act)
    picture = here.tracker._operator.picture
    columns = seen['targets']['columns']
    assert columns['number'] == picture.targets.number.tolist()
    assert len(columns['number']) == 3
    place = np.stack([columns['x'], columns['y']], 1)
    assert place == pytest.approx(picture.motion.position, abs=0.06)
    assert columns['cpa'] == pytest.approx(picture.approach.cpa, abs=0.6)
    assert columns['bearing'] == pytest.approx(picture.approach.bearing, abs=1e-4)
    # Echoes lie where the radar put them.
    echoes = np.stack([seen['plots']['x'], seen['plots']['y']], 1)
    assert echoes == pytest.approx(convert.plots_positions(here.last), abs=1.5)
    assert seen['own']['heading'] == pytest.approx(0, abs=1e-6)
    dangers = [alarm for alarm in seen['alarms']['alarms'] if alarm['kind'] == 'danger']
    assert dangers and all(alarm['number'] in columns['number'] for alarm in dangers)
    assert all(alarm['state'] == 'active unacknowledged' for alarm in dangers)
    assert 2 in columns['alarm']
    assert seen['limits']['cpa_limit_nm'] == 2.0
    assert any('tracking' in name for name in seen['health']['parts'])
    trails = seen['trails']
    assert all(len(trail) == len(trails['own']) for trail in trails['targets'].values())


def test_commands_of_the_page_reach_the_tracker(bridge, sea, display, look):
    here = bridge(sea, cpa_limit_nm=2.0, tcpa_limit_min=60.0, acquisition='nowhere')
    node = display(here)
    here.sail(8)
    operator = here.tracker._operator

    async def act(viewer):
        ask = viewer.command
        east, north = here.place(2).tolist()
        said = await ask('acquire', x=east + 90, y=north - 60)
        assert said['ok'], said
        await asyncio.to_thread(
            here.wait, lambda: len(operator.memory.arpa.acquisition.clicks.since)
        )
        await asyncio.to_thread(here.sail, 6)
        (number,) = operator.picture.targets.number.tolist()
        assert number
        await asyncio.to_thread(here.sail_on, lambda: len(operator.picture.alerts.id))
        assert (await ask('acknowledge', number=number))['ok']
        await asyncio.to_thread(
            here.wait, lambda: [s for s in here.standing().values() if s == 'active acknowledged']
        )
        assert 'acknowledged' in (await ask('acknowledge_all'))['text']
        assert (await ask('limits', cpa_nm=0.35, tcpa_min=18.5))['ok']
        assert operator.arpa.parameters.cpa_limit_nm == 0.35
        assert operator.arpa.parameters.tcpa_limit_min == 18.5
        said = await ask('trial', course_deg=77.0, speed_kn=9.5, delay_min=1.5)
        assert said['ok'], said
        await asyncio.to_thread(here.sail, 1)
        await viewer.until(lambda me: me.newest.get('trial', {}).get('on'))
        trial = viewer.newest['trial']
        assert (trial['course_deg'], trial['speed_kn']) == (77.0, 9.5)
        assert trial['targets'] and isinstance(trial['safe_deg'], list)
        assert (await ask('trial_off'))['ok']
        await viewer.until(lambda me: not me.newest['trial']['on'])
        assert (await ask('cancel', number=number))['ok']
        await asyncio.to_thread(
            here.wait, lambda: not len(operator.memory.arpa.acquisition.targets.id)
        )
        assert '0 targets' in (await ask('cancel_all'))['text']

    look(node, act)


def test_without_a_tracker_a_command_is_answered_with_what_is_missing(graph, look):
    node = graph.make(PpiDisplayNode, address='127.0.0.1:0', token='pass', tracker='none_there')
    try:

        async def act(viewer):
            return [
                await viewer.command('acquire', x=1, y=2),
                await viewer.command('trial', course_deg=1, speed_kn=2, delay_min=3),
                await viewer.command('acknowledge_all'),
            ]

        for said in look(node, act):
            assert not said['ok'] and said['text'].startswith('no tracker'), said
    finally:
        node.close()


def test_a_tracker_that_answers_late_or_never_harms_nothing(graph, node_helpers, monkeypatch, look):
    wait, _ = node_helpers
    monkeypatch.setattr(server, 'ANSWER_S', 0.5)
    display = graph.make(PpiDisplayNode, address='127.0.0.1:0', token='pass')
    mute = Node('mute', context=graph.context)  # serves, but is not spun yet
    for name in (topics.CANCEL_ALL, topics.ACKNOWLEDGE, topics.SILENCE):
        mute.create_service(Trigger, name, lambda request, response: response)
    mute.create_service(SetParameters, 'tracker/set_parameters', lambda request, response: response)
    wait(lambda: all(client.service_is_ready() for client in display._commands._triggers.values()))
    wait(display._commands._set.service_is_ready)
    try:

        async def act(viewer):
            said = [
                await viewer.command('cancel_all'),
                await viewer.command('trial', course_deg=4, speed_kn=5, delay_min=6),
            ]
            graph.add(mute)
            await asyncio.sleep(1.0)  # now it answers what nobody waits for any more
            return [*said, await viewer.command('acknowledge_all')]

        late, trial, last = look(display, act)
        assert not late['ok'] and not trial['ok'] and 'no answer in time' in late['text']
        assert last['text'] == 'refused'  # as the service leaves its answer
        assert not display.failures.counts and not graph.errors
    finally:
        display.close()


def test_alarms_go_with_their_tracker(graph, bridge, sea, display, look):
    here = bridge(sea, cpa_limit_nm=2.0, tcpa_limit_min=60.0)
    node = display(here)

    async def act(viewer):
        await asyncio.to_thread(here.sail, 14)
        await viewer.until(lambda me: me.newest.get('alarms', {}).get('alarms'))
        graph.executor.remove_node(here.tracker)
        graph.nodes.remove(here.tracker)
        here.tracker.destroy_node()
        await viewer.until(lambda me: me.newest['alarms']['alarms'] == [])

    look(node, act)


async def harass(address, until):
    """Clients that mean no good, until the task has ended, and 1,000 wrong messages at least."""
    host, port = address.split('/')[2].split(':')
    async with aiohttp.ClientSession() as session:
        count = 0
        while count < 1000 or not until.done():
            async with session.ws_connect(address + 'live') as link:
                for k in range(250):
                    await link.send_str(f'{{"command": "cancel_all", "id": -{k}' + '}' * (k % 3))
                await link.send_bytes(b'\xff' * 20_000)  # ends the connection
                count += 251
            reader, writer = await asyncio.open_connection(host, int(port))
            writer.write(b'GET /live HTTP/1.1\r\n' + bytes(range(256)) * 50)
            writer.close()
            async with session.get(address + '%2e%2e/tracker.yaml') as page:
                assert page.status == 404
            await asyncio.sleep(0.02)


def test_the_tracks_are_the_same_without_a_display_with_one_and_under_bad_clients(
    graph, node_helpers, sea, bridge, display, look
):
    clouds = []
    for with_display in (False, 'display', 'bad clients'):
        here = bridge(sea)
        heard = here.listen(PointCloud2, topics.TRACKS_CLOUD)
        node = display(here) if with_display else None

        async def act(viewer, here=here, node=node, bad=with_display == 'bad clients'):
            sailing = asyncio.ensure_future(asyncio.to_thread(here.sail, 20))
            if bad:
                await harass(node.server.url.split('#')[0], sailing)
                assert node.server.counts[server.BAD] >= 1000
                assert not node.failures.counts
            await sailing

        if node:
            look(node, act)
        else:
            here.sail(20)
        here.wait(lambda heard=heard: len(heard) >= 20)
        clouds.append([bytes(message.data) for message in heard.messages])
        graph.executor.remove_node(here.tracker)
    assert clouds[0] == clouds[1] == clouds[2]
    assert len(clouds[0][-1]) > 100


def test_a_wrong_address_ends_the_start_with_one_line(launch):
    process = launch('nodes.run ppi_display', '--ros-args', '-p', 'address:=nowhere')
    assert process.ends() == 1
    assert 'host:port' in process.said and 'Traceback' not in process.said
