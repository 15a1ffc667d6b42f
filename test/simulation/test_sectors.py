"""Revolutions cut into sectors."""

import numpy as np
import pytest

from marine_tracker.geometry import own_ship_at
from marine_tracker.simulation import radar, scenario, sectors


@pytest.mark.parametrize('count', [2, 7, 16])
def test_every_plot_is_in_the_sector_in_which_the_beam_met_it(count):
    for (scan, _), _ in zip(radar.simulate(scenario.load('encounters'), 2), range(5)):
        parts = sectors.cut(scan, count)
        assert len(parts) == count
        assert np.concatenate([part.plots.range for part in parts]).tolist() == (
            scan.plots.range.tolist()
        )
        for part, following in zip(parts, parts[1:]):
            assert part.end == following.start
        for k, part in enumerate(parts):
            assert part.sector.angle == pytest.approx(2 * np.pi / count)
            assert part.sector.bearing == pytest.approx(k * 2 * np.pi / count)
            assert ((part.plots.time >= part.start) & (part.plots.time <= part.end)).all()
            assert part.own_ship.time[[0, -1]].tolist() == [part.start, part.end]
            position, _ = own_ship_at(scan.own_ship, part.own_ship.time)
            assert part.own_ship.position == pytest.approx(position)


def test_truth_is_told_once_a_revolution():
    loaded = scenario.load('encounters')
    whole = [truth for _, truth in radar.simulate(loaded, 1)][:20]
    parts = list(sectors.parts(radar.simulate(loaded, 1), 8))[: 8 * 20]
    for k, truth in enumerate(whole):
        told = np.concatenate([part.target for _, part in parts[8 * k : 8 * k + 8]])
        assert sorted(told.tolist()) == sorted(truth.target.tolist())


def test_a_scenario_says_in_how_many_messages_a_revolution_is_sent(make_scenario):
    assert make_scenario(radar={'sectors': 12}).radar.sectors == 12
    assert make_scenario().radar.sectors == 1
    for wrong, said in ((0, 'between 1 and 64'), (65, 'between 1 and 64'), (2.5, 'a whole number')):
        with pytest.raises(ValueError, match=f'radar.sectors is {wrong:g}; it must be {said}'):
            make_scenario(radar={'sectors': wrong})
