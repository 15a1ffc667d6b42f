"""What alerts say."""

import math

import pytest

from marine_tracker.arpa import alarm_text, alarms


@pytest.mark.parametrize(
    ('values', 'said'),
    [
        (
            [2.0, 1852.0 * 1.25, math.radians(47), 333.0, 420.0],
            '2 stationary in the way: the first in 7.0 min, CPA 0.18 NM, now at 1.25 NM, 047.0 deg',
        ),
        # What is over has no values any more.
        ([0.0, math.nan, math.nan, math.nan, math.nan], 'nothing stationary in the way'),
    ],
)
def test_of_stationary_places_only_what_is_known_is_said(values, said):
    assert alarm_text._sentence(alarms.STATIONARY_DANGER, '', '', values) == said
