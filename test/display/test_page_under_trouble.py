"""Networks that die, tabs that sleep, contexts that are lost: the picture is live, or says so."""

import asyncio
import contextlib
import time

import pytest

pytest.importorskip('aiohttp', reason='no aiohttp: the display is not tested')
import aiohttp

from marine_tracker.display import browser

STALE = "!document.getElementById('stale').hidden"
LIVE = "document.getElementById('stale').hidden"
NEWEST = 'ppi.state.scan.time - 7e8'


class Air:
    """A network between viewer and server that can go dead without a word, and be slow."""

    def __init__(self, port):
        self.to, self.dead, self.writers = port, False, []

    async def __aenter__(self):
        self.server = await asyncio.start_server(self._carry, '127.0.0.1', 0)
        self.port = self.server.sockets[0].getsockname()[1]
        return self

    async def __aexit__(self, *_):
        self.server.close()
        for writer in self.writers:
            writer.close()

    async def _carry(self, reader, writer):
        far_reader, far_writer = await asyncio.open_connection('127.0.0.1', self.to)
        self.writers += [writer, far_writer]
        await asyncio.gather(
            self._pump(reader, far_writer), self._pump(far_reader, writer), return_exceptions=True
        )

    async def _pump(self, reader, writer):
        with contextlib.suppress(ConnectionError, asyncio.CancelledError):
            while data := await reader.read(4096):
                while self.dead:
                    await asyncio.sleep(0.02)
                writer.write(data)
                await writer.drain()
            writer.close()


def test_a_network_that_dies_without_a_word_gives_the_red_cross_until_fresh_data_come(
    chromium, sea_server
):
    async def go():
        sea = sea_server(vx=0.0, vy=0.0, ships=5)
        playing = asyncio.ensure_future(sea.play())
        async with Air(sea.server.port) as air:
            here = f'http://127.0.0.1:{air.port}/'
            async with browser.open_tab(chromium, here) as page:
                await page.until(f'ppi.state.targets.length == 5 && {LIVE}')
                # A ship at rest, whose messages all say the same, is not stale.
                for _ in range(40):
                    assert await page.evaluate(LIVE)
                    await asyncio.sleep(0.1)
                air.dead = True
                since = await page.until(f'{STALE} && performance.now() / 1000 - ppi.state.heard')
                assert 3.0 <= since < 3.4
                assert await page.evaluate('document.title') == 'NO LIVE DATA - PPI'
                await asyncio.sleep(1.5)
                assert await page.evaluate(STALE)
                air.dead = False
                await page.until(LIVE)
                await page.until(f'{NEWEST} >= {sea.count} && ppi.state.late < 0.5')
        playing.cancel()

    asyncio.run(go())


def test_a_hidden_tab_draws_nothing_and_shows_the_state_of_now_when_it_is_back(visit, chromium):
    async def act(page, sea):
        sea.live = False
        async with browser.open_tab(chromium, 'about:blank#other'):
            await page.until("document.visibilityState == 'hidden'")
            await asyncio.sleep(0.3)
            drawn = await page.evaluate('ppi.frames()')
            # As much as comes in an hour, while the browser hands all of it on.
            for _ in range(2700):
                sea.tell_own()
                sea.tell_scan()
                await asyncio.sleep(0)
            sea.tell_alarms(3)
            await page.until('document.title.startsWith("(1) alarm")')  # goes on while hidden
            await page.until('ppi.sound.played > 0')
            assert await page.evaluate('ppi.frames()') == drawn
        sea.live = True
        await page.call('Page.bringToFront')
        began = time.monotonic()
        await page.until(f'{NEWEST} >= {sea.count} && ppi.frames() > {drawn}')
        assert time.monotonic() - began < 1.0
        assert await page.evaluate('ppi.state.plots.length') < 20
        await page.until(LIVE)

    visit(act, '?sound=on', ships=23)


def test_a_tab_that_was_frozen_shows_the_state_of_now_within_a_second(visit):
    async def act(page, sea):
        await page.call('Page.setWebLifecycleState', state='frozen')
        for _ in range(3000):
            sea.tell_own()
            sea.tell_scan()
            await asyncio.sleep(0)
        (viewer,) = sea.server._viewers
        assert len(viewer) < 12  # one of each kind waits, however long
        await page.call('Page.setWebLifecycleState', state='active')
        await page.call('Page.bringToFront')
        began = time.monotonic()
        await page.until(f'{NEWEST} >= {sea.count}')
        assert time.monotonic() - began < 1.0

    visit(act, ships=40)


@pytest.mark.parametrize('off_s', [-11 * 60, 5 * 3600 + 40])
def test_a_clock_that_is_off_is_told_and_no_target_gets_older_or_younger(visit, off_s):
    async def act(page, sea):
        await page.evaluate(f'(now => {{ Date.now = () => now() + {off_s * 1000}; }})(Date.now)')
        await page.until(f"document.getElementById('role').textContent.includes('{off_s} s off')")
        for _ in range(10):
            assert await page.evaluate(LIVE)
            assert await page.evaluate('Math.abs(ppi.state.late) < 1')
            await asyncio.sleep(0.05)

    visit(act, ships=3)


def test_a_lost_context_is_told_by_the_red_cross_and_drawn_anew_within_a_second(visit):
    async def act(page, sea):
        # No driver to reset here: the context says that it is lost, as a real one would.
        await page.evaluate(
            'ppi.old = ppi.surface.pen; ppi.old.isContextLost = () => true;'
            "document.getElementById('picture').dispatchEvent(new Event('contextlost')); 1"
        )
        began = time.monotonic()
        # Where it was lost a fresh one stands over it: with the picture, not blank.
        await page.until(
            "(() => { const c = document.querySelector('canvas.fresh'); if (!c) return false;"
            "const {data} = c.getContext('2d').getImageData(0, 0, c.width, c.height);"
            'return data.some(value => value > 150); })()'
        )
        assert time.monotonic() - began < 1.0
        await page.until(LIVE)
        # A click goes where it went before.
        await page.evaluate('ppi.marks.id = null')
        ship = await page.evaluate(
            '(() => { const {view} = ppi.scopeNow();'
            "const box = document.getElementById('picture').getBoundingClientRect();"
            'const t = ppi.state.targets.find(t => t.number == 4);'
            'const [x, y] = ppi.toScreen(view, t.x, t.y); return [box.x + x, box.y + y]; })()'
        )
        await page.click(*ship)
        await page.until('ppi.marks.id !== null')

    visit(act, '?range=12', ships=4)


def test_while_the_context_is_lost_the_red_cross_stands(visit):
    async def act(page, sea):
        await page.evaluate(
            "Object.defineProperty(ppi.surface, 'lost', {get: () => true});"
            'ppi.surface.ready = () => document.createElement("canvas").getContext("2d")'
        )
        await page.until(STALE)
        assert 'lost' in await page.evaluate("document.getElementById('stale').textContent")

    visit(act, ships=2)


def test_a_page_of_another_server_in_the_same_browser_is_refused(visit, chromium):
    async def act(page, sea):
        async def elsewhere(request):
            return aiohttp.web.Response(text='<p>of somebody else', content_type='text/html')

        application = aiohttp.web.Application()
        application.router.add_get('/', elsewhere)
        runner = aiohttp.web.AppRunner(application)
        await runner.setup()
        await aiohttp.web.TCPSite(runner, '127.0.0.1', 0).start()
        there = f'http://127.0.0.1:{runner.addresses[0][1]}/'
        knock = (
            f"new Promise(done => {{ const s = new WebSocket('ws://127.0.0.1:{sea.server.port}/live');"
            "s.onopen = () => done('open'); s.onerror = () => done('refused'); })"
        )
        read = (
            f"fetch('http://127.0.0.1:{sea.server.port}/main.js').then(r => r.text())"
            ".then(() => 'read', () => 'refused')"
        )
        try:
            async with browser.open_tab(chromium, there) as other:
                assert await other.evaluate(knock) == 'refused'
                assert await other.evaluate(read) == 'refused'
        finally:
            await runner.cleanup()
        assert await page.evaluate(knock) == 'open'
        assert sea.server.counts['foreign origins refused'] == 1
        assert not sea.commands.given

    visit(act, ships=2)
