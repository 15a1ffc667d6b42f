"""The night palette: no bright frame, whatever happens."""

import asyncio
import io

import numpy as np
import pytest

pytest.importorskip('aiohttp', reason='no aiohttp: the display is not tested')
image = pytest.importorskip('PIL.Image', reason='no Pillow: frames of the page are not looked at')

WHITE_SHARE = 0.25  # of the luminance of white, the most that one pixel may have
MEAN = 0.01  # the most that a frame may have on average
SRGB = np.arange(256) / 255
LINEAR = np.where(SRGB <= 0.04045, SRGB / 12.92, ((SRGB + 0.055) / 1.055) ** 2.4).astype('f4')
SHARES = np.array([0.2126, 0.7152, 0.0722], 'f4')


def luminance(frame):
    """Relative luminance [H, W] of an encoded image, 1 for white."""
    return LINEAR[np.asarray(image.open(io.BytesIO(frame)).convert('RGB'))] @ SHARES


async def watched(page, act, kept):
    """The frames that the page shows while act() runs and a little longer."""
    page.frames.clear()
    await page.call('Page.startScreencast', format='png', everyNthFrame=1)
    await act()
    await asyncio.sleep(0.4)
    await page.call('Page.stopScreencast')
    assert page.frames
    kept += page.frames


def test_no_frame_is_bright(visit):
    async def act(page, sea):
        sea.tell_alarms(1, 2)
        frames = []

        async def load():
            # Pieces of the page come one after the other, as over a slow network.
            await page.call('Network.enable')
            await page.call('Network.setCacheDisabled', cacheDisabled=True)
            slow = {'offline': False, 'latency': 150, 'uploadThroughput': 2e5}
            await page.call('Network.emulateNetworkConditions', downloadThroughput=1.5e5, **slow)
            await page.open(sea.server.url.replace('/#', '/?palette=night#'))
            await page.until('window.ppi && ppi.state.targets.length')
            await page.call('Network.emulateNetworkConditions', downloadThroughput=-1, **slow)

        async def use():
            await page.evaluate(
                "for (const one of document.querySelectorAll('details')) one.open = true"
            )
            for name in ('#trial input', '#limits input', '#targets button', '#picture', '#mark'):
                await page.evaluate(f"document.querySelector('{name}').focus()")
                await asyncio.sleep(0.05)
            for key in ('n', 'q', 'o', 'e', 'a', 't', '+'):
                await page.key(key)
                await asyncio.sleep(0.05)
            places = await page.evaluate(
                "[...document.querySelectorAll('#tools obc-button')].map(one =>"
                '(({x, y}) => [x + 9, y + 9])(one.getBoundingClientRect()))'
            )
            for x, y in places:
                await page.call('Input.dispatchMouseEvent', type='mouseMoved', x=x, y=y)
                await asyncio.sleep(0.02)

        async def reconnect():
            sea.live = False
            await asyncio.to_thread(sea.server.close)
            await page.until("document.getElementById('stale').textContent.includes('No conn')")

        async def wrong_page():
            await page.open(sea.server.url.split('#')[0] + 'harbour-plan')

        await watched(page, load, frames)
        await watched(page, use, frames)
        await watched(page, wrong_page, frames)
        await page.open(sea.server.url.replace('/#', '/?palette=night#'))
        await watched(page, reconnect, frames)
        lit = [luminance(frame) for frame in frames]
        assert len(lit) > 15
        assert max(frame.max() for frame in lit) < WHITE_SHARE
        assert max(frame.mean() for frame in lit) < MEAN
        page.errors.clear()  # a page that is not there, a server that is away: both were asked for

    visit(act, '?palette=night', ships=30)


def test_by_day_the_same_measure_finds_bright_frames(visit):
    async def act(page, sea):
        lit = luminance(await page.screenshot())
        assert lit.max() > WHITE_SHARE and lit.mean() > MEAN

    visit(act, '?palette=day', ships=3)
