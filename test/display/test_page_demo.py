"""The choice of what a demo shows, in the page."""

import pytest

pytest.importorskip('aiohttp', reason='no aiohttp: the display is not tested')

BOX = "document.getElementById('demo-box')"
FORM = "document.getElementById('demo').elements"
SHOWN = {
    'scenario': 'coast',
    'recording': '',
    'rate': 3.0,
    'scenarios': ['coast', 'hulls', 'imo_2'],
    'recordings': ['north_sea'],
    'run': 1,
}


def test_where_a_demo_runs_another_scene_can_be_started(visit, web):
    async def act(page, sea):
        assert await page.evaluate(f'{BOX}.hidden')
        sea.server.publish('demo', {'demo': SHOWN})
        await page.until(f'!{BOX}.hidden')
        assert 'coast, 3 x' in await page.evaluate(f'{BOX}.textContent')
        await page.evaluate(f'{BOX}.open = true')
        # A choice that somebody is making outlives what comes meanwhile.
        await page.evaluate(f"{FORM}.what.value = JSON.stringify(['scenario', 'imo_2'])")
        await page.evaluate(f"{FORM}.rate.value = '10'")
        await page.until(f'ppi.state.scan.time > 7e8 + {sea.count}')
        await page.evaluate("document.querySelector('#demo .submit').click()")
        await page.until("document.getElementById('said').textContent == 'show done'")
        (command,) = sea.commands.given
        assert command.values == {'scenario': 'imo_2', 'recording': '', 'rate': 10.0}
        # What was seen of the run before does not stay in the picture of the next.
        sea.live = False
        assert await page.evaluate('ppi.state.plots.length')
        sea.server.publish('demo', {'demo': SHOWN | {'recording': 'north_sea', 'run': 2}})
        await page.until('ppi.state.demo.run == 2')
        assert await page.evaluate('ppi.state.plots.length + ppi.state.targets.length') == 0
        assert 'north_sea' in await page.evaluate(f'{BOX}.textContent')
        await page.evaluate((web / 'node_modules/axe-core/axe.min.js').read_text() + '; 1')
        found = await page.evaluate(
            'axe.run().then(({violations}) => violations.map(one => one.id))'
        )
        assert found == []

    visit(act, ships=4)
