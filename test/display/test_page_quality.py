"""What a page owes to everybody: keyboard, touch, zoom, headers, no jumps of its layout."""

import asyncio

import pytest

pytest.importorskip('aiohttp', reason='no aiohttp: the display is not tested')
import aiohttp

BUTTONS = (
    "[...document.querySelectorAll('obc-button, button, input, select, summary, canvas[tabindex]')]"
    ".filter(one => one.checkVisibility() && !one.disabled && one.id !== 'stale')"
)
FOCUSED = "document.activeElement.id || document.activeElement.name || ''"
OPEN = "for (const one of document.querySelectorAll('details')) if (!one.hidden) one.open = true"


def test_every_control_is_reached_by_the_tab_key(visit):
    async def act(page, sea):
        await page.evaluate(OPEN)
        await page.until('ppi.state.role.commands')
        await asyncio.sleep(0.4)
        wanted = await page.evaluate(
            f'{BUTTONS}.filter(one => one.id || one.name).map(one => one.id || one.name)'
        )
        assert {'picture', 'nearer', 'mark', 'acquire', 'course_deg', 'cpa_nm'} <= set(wanted)
        seen = set()
        for _ in range(2 * await page.evaluate(f'{BUTTONS}.length')):  # some have no name
            await page.call(
                'Input.dispatchKeyEvent', type='rawKeyDown', key='Tab', windowsVirtualKeyCode=9
            )
            seen.add(await page.evaluate(FOCUSED))
        assert set(wanted) <= seen, set(wanted) - seen

    visit(act, ships=2)


def test_a_finger_hits_every_control(visit, web):
    async def act(page, sea):
        await page.evaluate((web / 'node_modules/axe-core/axe.min.js').read_text() + '; 1')
        found = await page.evaluate(
            "axe.run({runOnly: ['wcag22aa', 'wcag21aa', 'best-practice']})"
            '.then(({violations}) => violations.map(one => [one.id, one.nodes[0].html]))'
        )
        assert found == []

    visit(act, ships=12, width=412, height=880)


@pytest.mark.parametrize('width', [320, 640, 1024])
def test_nothing_is_cut_off_on_narrow_screens_and_at_twice_the_size(visit, width):
    async def act(page, sea):
        await asyncio.sleep(0.4)
        wide = await page.evaluate('document.documentElement.scrollWidth')
        assert wide <= width
        picture = await page.evaluate("document.getElementById('picture').clientWidth")
        assert picture > 0.5 * width

    visit(act, ships=9, width=width, height=700)


def test_the_layout_does_not_jump(visit):
    async def act(page, sea):
        await page.evaluate(
            'window.shifts = 0; new PerformanceObserver(list => {'
            'for (const one of list.getEntries()) shifts += one.value; })'
            ".observe({type: 'layout-shift', buffered: true})"
        )
        await asyncio.sleep(2.5)
        assert await page.evaluate('shifts') < 0.1

    visit(act, ships=30)


def test_the_page_says_what_it_is_and_how_it_may_be_used(sea_server):
    base = f'http://127.0.0.1:{sea_server().server.port}/'

    async def get():
        async with aiohttp.ClientSession() as session, session.get(base) as answer:
            return await answer.text(), answer.headers

    text, headers = asyncio.run(get())
    for part in ('lang="en"', '<title>', 'name="viewport"', '<h1>', '<main>', 'charset="utf-8"'):
        assert part in text
    assert headers['X-Content-Type-Options'] == 'nosniff'
    assert headers['Referrer-Policy'] == 'no-referrer'
    assert "frame-ancestors 'none'" in headers['Content-Security-Policy']
    assert 'unsafe-eval' not in headers['Content-Security-Policy']
