"""The radars as the parameter names them."""

import pytest

from marine_tracker.parameters import TrackerParameters
from marine_tracker.tracking.radars import held_updates, radars_of
from marine_tracker.tracking.tracker import Tracker


def of(text, **parameters):
    return radars_of(TrackerParameters(radars=text, **parameters))


def test_without_the_parameter_there_is_one_radar_with_the_trackers_parameters():
    (only,) = of('', range_sigma_m=7.0)
    assert (only.name, only.topic, only.parameters) == (
        '',
        'radar/plots',
        TrackerParameters(range_sigma_m=7.0),
    )


def test_a_radar_has_its_own_and_else_the_trackers():
    x, s = of(
        '[{topic: x/radar/plots, range_sigma_m: 10}, '
        '{topic: s/radar/plots, name: S band, scan_period_s: 2.4}]',
        range_sigma_m=20.0,
    )
    assert (x.name, s.name) == ('x', 'S band')
    assert (x.parameters.range_sigma_m, s.parameters.range_sigma_m) == (10.0, 20.0)
    assert s.parameters.scan_period_s == 2.4


@pytest.mark.parametrize(
    'periods, updates',
    [((2.5,), 0), ((2.5, 2.5), 2), ((2.4, 1.25), 2), ((5.0, 1.25), 5), ((2.0, 2.0, 2.0), 4)],
)
def test_as_many_updates_are_held_as_may_be_later_than_a_plot(periods, updates):
    text = str([{'topic': f't{k}', 'scan_period_s': p} for k, p in enumerate(periods)])
    assert held_updates(of(text)) == updates


@pytest.mark.parametrize(
    'text, said',
    [
        ('[', 'radars, line 1 is not YAML'),
        ('x', "radars are 'x'; they must be a list of mappings, each with topic"),
        ('[{name: x}]', r'radar 1 is .*it must be a mapping with a topic'),
        (
            '[{topic: x, rage_sigma_m: 3}]',
            'radar x has rage_sigma_m; it may have topic, name, range',
        ),
        ('[{topic: x, range_sigma_m: -3}]', 'radar x: parameter range_sigma_m is -3 m; it must be'),
        ('[{topic: x}, {topic: x, name: y}]', 'radars have the topics x, x; each must differ'),
    ],
)
def test_what_is_wrong_is_named(text, said):
    with pytest.raises(ValueError, match=said):
        Tracker(TrackerParameters(radars=text))
