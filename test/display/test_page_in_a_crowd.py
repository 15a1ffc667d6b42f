"""Crowds: what the page costs with very many ships on it."""

import asyncio
import os

import pytest

pytest.importorskip('aiohttp', reason='no aiohttp: the display is not tested')

TAPS = 12
ANSWER_MS = 200
# From the event as the browser got it to the frame after the panel has shown the target.
WATCH = """
window.taps = [];
addEventListener('click', event => {
  const before = document.getElementById('selected-name').textContent;
  const look = () => {
    if (document.getElementById('selected-name').textContent !== before)
      requestAnimationFrame(() => taps.push(performance.now() - event.timeStamp));
    else requestAnimationFrame(look);
  };
  look();
}, {capture: true});
"""


@pytest.mark.slow
@pytest.mark.parametrize('nautical_miles', [3, 12])
def test_among_1200_ships_on_a_slow_phone_a_tap_is_answered_in_a_fifth_of_a_second(
    visit, nautical_miles
):
    if os.getloadavg()[0] > (os.cpu_count() or 1):
        pytest.skip('this machine is busy with other work: nothing can be measured')

    async def act(page, sea):
        await page.evaluate(WATCH)
        await page.call('Emulation.setCPUThrottlingRate', rate=4)
        await asyncio.sleep(4)
        for k in range(TAPS):
            ship = await page.evaluate(
                '(() => { const {view, middleX, middleY, radius} = ppi.scopeNow();'
                "const box = document.getElementById('picture').getBoundingClientRect();"
                'const seen = ppi.state.targets.map(t => ppi.toScreen(view, t.x, t.y)).filter('
                '([x, y]) => Math.hypot(x - middleX, y - middleY) < radius - 20);'
                f'const [x, y] = seen[{k} * 7 % seen.length]; return [box.x + x, box.y + y]; }})()'
            )
            await page.click(*ship)
            await asyncio.sleep(0.37)
            await page.evaluate('ppi.marks.id = null')
            await asyncio.sleep(0.3)
        taps = sorted(await page.evaluate('taps'))
        print(nautical_miles, 'NM:', [round(tap) for tap in taps])
        assert len(taps) >= TAPS - 2 and taps[-2] < ANSWER_MS

    visit(
        act,
        f'?range={nautical_miles}',
        ships=1200,
        dangers=9,
        plots=900,
        period=2.5,
        width=412,
        height=915,
    )
