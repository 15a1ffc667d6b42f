"""Zones drawn on the page, and "why no target here?", over DDS: what the tracker makes of them."""

import asyncio

import numpy as np
import pytest

pytest.importorskip('rclpy')
pytest.importorskip('aiohttp', reason='no aiohttp: the display is not tested')
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped

from marine_tracker.arpa import zone_text
from marine_tracker.display import browser
from marine_tracker.nodes import convert, topics

SHIPS = [(3.1, 20, 200, 12), (2.2, 300, 90, 7), (4.0, 110, 285, 15)]
RING = {'name': 'ring', 'kind': 'guard', 'range_m': [2500.0, 3100.5]}
QUAY = {'name': 'quay', 'kind': 'exclusion', 'fixed_to': 'ground'}
QUAY |= {'corners_m': [[300.0, -20.5], [900.0, 0.0], [820.0, 700.0]]}


@pytest.fixture
def sea(simulated):
    return simulated(SHIPS, 100)


def zones_of(here):
    return here.tracker.get_parameter('zones').value


def test_zones_of_viewers_reach_the_tracker_and_all_see_what_it_has(bridge, sea, display, look):
    here = bridge(sea, zones='[{name: old, kind: guard, range_nm: [1, 2]}]')
    node = display(here)

    async def act(viewer):
        ask = viewer.command
        both = await asyncio.gather(
            *(
                asyncio.to_thread(
                    look,
                    node,
                    lambda other, zone=zone: other.command('zone_put', zone=zone, was=''),
                )
                for zone in (RING, QUAY)
            )
        )  # two others at the same time: neither loses a zone
        assert all(said['ok'] for said in both), both
        await viewer.until(lambda me: len(me.newest.get('zones', {}).get('zones', ())) == 3)
        seen = {zone['name']: zone for zone in viewer.newest['zones']['zones']}
        assert seen['ring']['range'] == [2500.0, 3100.5]
        assert seen['quay']['corners'] == QUAY['corners_m']
        assert zone_text.plain(zones_of(here)) == viewer.newest['zones']['zones']
        assert set(here.tracker._operator.arpa.zones.name) == {'old', 'ring', 'quay'}

        said = await ask('zone_put', zone=RING | {'range_m': [900, 400]}, was='ring')
        assert not said['ok'] and 'zone ring' in said['text'] and 'below' in said['text']
        crossed = [[0, 0], [900, 900], [900, 0], [0, 900]]
        said = await ask('zone_put', zone=QUAY | {'corners_m': crossed}, was='quay')
        assert not said['ok'] and 'cross' in said['text']
        said = await ask('zone_put', zone=RING, was='')
        assert not said['ok'] and 'two zones have the name ring' in said['text']
        assert (await ask('zone_put', zone=RING | {'name': 'new'}, was='old'))['ok']
        assert (await ask('zone_delete', name='quay'))['ok']
        said = await ask('zone_delete', name='quay')
        assert not said['ok'] and 'no zone quay any more' in said['text']
        names = [zone['name'] for zone in zone_text.plain(zones_of(here))]
        assert sorted(names) == ['new', 'ring']

    look(node, act)


def test_why_there_is_no_target_is_answered_in_words(bridge, sea, display, look):
    here = bridge(sea, acquisition='nowhere', min_range_m=200.0)
    node = display(here)
    here.sail(10)

    async def act(viewer):
        east, north = map(float, here.place(2))
        own = here.tracker._operator.picture.own.position
        said = await viewer.command('explain', x=east, y=north)
        assert said['ok'] and 'by hand only' in said['text'] and 'TT' in said['text'], said
        near = (own + [30, 40]).tolist()
        said = await viewer.command('explain', x=near[0], y=near[1])
        assert any(line.startswith('50 m from') for line in said['text'].splitlines()), said

    look(node, act)
    assert not here.tracker.failures.counts


def test_a_question_in_a_wrong_frame_is_answered_with_what_is_wrong(bridge, sea):
    here = bridge(sea)
    ears = here.listen(DiagnosticArray, topics.EXPLANATION, topics.reliable())
    point = PointStamped()
    point.header.stamp.sec, point.header.frame_id = 77, 'mast'
    here.say(PointStamped, topics.EXPLAIN, point)
    here.wait(lambda: len(ears))
    answer = ears[-1]
    assert answer.header.stamp.sec == 77
    assert "frame 'mast'" in answer.status[0].message


@pytest.mark.skipif(not browser.program(), reason='no Chromium')
def test_a_zone_that_is_drawn_is_the_parameter_of_the_tracker(bridge, sea, display):
    here = bridge(sea)
    node = display(here)
    here.sail(3)

    async def run():
        async with browser.open_page(node.server.url, 1200, 800) as page:
            await page.until('ppi.state.own && ppi.state.role.commands')
            await page.evaluate(
                "document.getElementById('zones-box').open = true;"
                "document.querySelector('[data-zone=ground]').click()"
            )
            box = await page.evaluate('(({x, y}) => [x, y])(ppi.canvas.getBoundingClientRect())')
            handle = (
                'import("./zones.js").then(z => { const h = z.handles(ppi.marks.draft.zone,'
                'ppi.state.own)[%d]; return ppi.toScreen(ppi.scopeNow().view, h.x, h.y) })'
            )
            under_way.clear()  # while it is dragged own ship lies still
            own = None
            while own != (own := await page.evaluate('ppi.state.own')):
                await asyncio.sleep(1.0)
            x, y = await page.evaluate(handle % 2)
            await drag(page, [box[0] + x, box[1] + y], [box[0] + x + 60, box[1] + y - 45])
            corner = await page.evaluate(f'ppi.toMap(ppi.scopeNow().view, {x} + 60, {y} - 45)')
            drawn = await page.evaluate('ppi.marks.draft.zone')
            assert drawn['corners'][2] == pytest.approx(corner, abs=12)  # half a pixel
            under_way.set()
            await page.evaluate(
                "document.querySelector('#zone [name=name]').value = 'fairway';"
                "document.querySelector('#zone [name=kind]').value = 'exclusion';"
                "document.getElementById('zone').dispatchEvent(new Event('input'));"
                "document.getElementById('zone-save').click()"
            )
            await page.until('!ppi.marks.draft')
            (zone,) = zone_text.plain(zones_of(here))
            assert (zone['name'], zone['kind'], zone['fixed_to']) == (
                'fairway',
                'exclusion',
                'ground',
            )
            assert np.array(zone['corners']) == pytest.approx(np.array(drawn['corners']), abs=0.06)
            await page.until(f"""JSON.stringify(ppi.state.zones.zones[0]?.corners)
                == JSON.stringify({zone['corners']})""")
            # What the tracker refuses is said in its words, and the drawing stays.
            await page.evaluate(
                "document.querySelector('#zones [title^=Change]').click();"
                'ppi.marks.draft.zone.corners = [[0, 0], [900, 900], [900, 0], [0, 900]];'
                "document.getElementById('zone-save').click()"
            )
            await page.until("document.getElementById('zone-says').textContent.includes('cross')")
            assert await page.evaluate('ppi.marks.draft !== null')
            assert page.errors == []

    under_way = asyncio.Event()
    under_way.set()

    async def keep_alive():
        while True:
            await under_way.wait()
            await asyncio.to_thread(here.sail, 1)
            await asyncio.sleep(0.5)

    async def drag(page, start, end):
        for kind, at in (('mousePressed', start), ('mouseMoved', end), ('mouseReleased', end)):
            await page.call(
                'Input.dispatchMouseEvent',
                type=kind,
                x=at[0],
                y=at[1],
                button='left',
                buttons=1,
                clickCount=1,
            )

    async def both():
        sailing = asyncio.ensure_future(keep_alive())
        try:
            await run()
        finally:
            sailing.cancel()

    asyncio.run(both())


def test_plots_of_all_radars_of_a_tracker_are_drawn(bridge, sea, display, look):
    radars = '[{topic: radar/plots}, {topic: other/plots, antenna_ahead_m: 30.0}]'
    here = bridge(sea, radars=radars)
    node = display(here)
    other = here.other.create_publisher(here.radar.msg_type, 'other/plots', topics.reliable(50))
    here.wait(lambda: len(node._plots) == 2 and other.get_subscription_count() == 2)

    async def act(viewer):
        await viewer.until(lambda me: 'pulse' in me.newest)
        await asyncio.to_thread(here.sail, 2)
        scan = here.last
        other.publish(convert.plots_to_cloud(scan, here.stamp(scan.start)))
        await viewer.until(lambda me: {'plots', 'plots1'} <= set(me.newest))
        first, second = (
            np.array([viewer.newest[kind]['x'], viewer.newest[kind]['y']])
            for kind in ('plots', 'plots1')
        )
        # Own ship heads north: the other antenna is 30 m further ahead.
        assert second - first == pytest.approx(np.tile([[0], [30]], len(first[0])), abs=1.5)

    look(node, act)


def test_a_lost_heading_goes_to_the_page_as_the_last_bow(bridge, sea, display, look):
    here = bridge(sea)
    node = display(here)

    def own_ship(stamp, position, velocity, heading):
        return convert.own_ship_to_odometry(stamp, position, velocity, heading)

    async def act(viewer):
        here.odometry = lambda *a: own_ship(*a, np.radians(123))
        await asyncio.to_thread(here.sail, 1)
        await viewer.until(lambda me: me.newest.get('own', {}).get('heading'))
        here.odometry = lambda *a: own_ship(*a, np.nan)
        await asyncio.sleep(0.2)  # more often the page is told nothing
        await asyncio.to_thread(here.sail, 1)
        await viewer.until(lambda me: me.newest['own']['heading'] is None)
        assert viewer.newest['own']['bow'] == pytest.approx(np.radians(123))

    look(node, act)


def test_the_command_asks_a_tracker_that_runs(bridge, sea, launch):
    here = bridge(sea, acquisition='nowhere', min_range_m=200.0)
    here.sail(8)
    east, north = here.place(2)
    asked = launch('__main__', 'explain', '--east', f'{east:.0f}', '--north', f'{north:.0f}')
    assert asked.ends() == 0, asked.said
    assert '* acquisition is by hand only' in asked.said and 'TT' in asked.said
    # By range and bearing of own ship, who must be heard for it.
    polar = launch('__main__', 'explain', '--range', '0.04', '--bearing', '77')
    while polar.process.poll() is None:
        here.send_own_ship_of([here.last])
    assert polar.ends() == 0, polar.said
    assert '* 74 m from the antenna' in polar.said, polar.said
    bow = launch('__main__', 'explain', '--range', '0.05', '--bearing', '300', '--bow')
    assert bow.ends() == 0 and '* 93 m from the antenna' in bow.said, bow.said


def test_without_a_tracker_the_command_says_so_in_one_line(graph, launch):
    asked = launch('__main__', 'explain', '--east', '1', '--north', '2', '--wait', '1.5')
    assert asked.ends() == 2
    assert 'no tracker listens' in asked.said and 'Traceback' not in asked.said
