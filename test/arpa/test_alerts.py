import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from marine_tracker.arpa import alerts as machine
from marine_tracker.arpa.alerts import (
    ACTIVE_ACKNOWLEDGED,
    ACTIVE_UNACKNOWLEDGED,
    KEEP,
    NORMAL,
    OFF,
    ON,
    RECTIFIED_UNACKNOWLEDGED,
    Causes,
    Rule,
)
from marine_tracker.types import append

KIND = 3
LASTING = np.zeros(8, bool)
AWAY, ACKNOWLEDGE = 'away', 'acknowledge'


def causes(levels):
    """Subjects 1, 2, ... with these levels; AWAY for one that is not there."""
    there = [k for k, level in enumerate(levels) if level != AWAY]
    count = len(there)
    id = np.array(there, np.int64) + 1
    return Causes(
        id,
        id + 100,
        np.array([levels[k] for k in there], np.int8),
        np.zeros((count, 2)),
        np.repeat(np.arange(count)[:, None] * 1.0, 5, 1),
    )


def play(script, rule=None, momentary=False):
    """(state of subject 1, changes to it) after each step of 1 s; ACKNOWLEDGE is a step too."""
    rule = rule or Rule()
    alerts, out = machine.begin(), []
    for now, what in enumerate(script):
        if what == ACKNOWLEDGE:
            alerts, changed = machine.acknowledge(alerts, now, LASTING | momentary)
        else:
            alerts, changed = machine.advance(alerts, KIND, 0, causes([what]), rule, float(now))
        state = int(alerts.state[0]) if len(alerts.state) else NORMAL
        out.append((state, changed.state.tolist()))
    return out


def states(script, **about):
    return [state for state, _ in play(script, **about)]


A, B, C, N = ACTIVE_UNACKNOWLEDGED, ACTIVE_ACKNOWLEDGED, RECTIFIED_UNACKNOWLEDGED, NORMAL


@pytest.mark.parametrize(
    ('script', 'expected'),
    [
        ([ON, ON, OFF], [A, A, C]),
        ([ON, ACKNOWLEDGE, ON, OFF], [A, B, B, N]),
        ([ON, OFF, ACKNOWLEDGE, OFF], [A, C, N, N]),
        ([ON, OFF, ON, ACKNOWLEDGE, OFF, ON], [A, C, A, B, N, A]),
        ([ON, ACKNOWLEDGE, ACKNOWLEDGE, ON], [A, B, B, B]),
        ([KEEP, KEEP, ON, KEEP, KEEP, OFF, KEEP], [N, N, A, A, A, C, C]),
        ([ON, AWAY, AWAY], [A, C, C]),
        ([ON, ACKNOWLEDGE, AWAY], [A, B, N]),
        ([OFF, ACKNOWLEDGE, AWAY], [N, N, N]),
    ],
)
def test_the_states_of_bridge_alert_management(script, expected):
    assert states(script) == expected


def test_a_cause_must_hold_before_it_raises_and_be_gone_before_it_ends():
    rule = Rule(raise_after=2.0, end_after=3.0)
    assert states([ON, ON, OFF, ON, ON, ON], rule=rule) == [N, N, N, N, N, A]
    assert states([ON, KEEP, ON], rule=rule) == [N, N, A]  # the middle is no interruption
    assert states([ON, KEEP, KEEP, KEEP, ON], rule=rule) == [N, N, N, N, A]  # nor does it raise
    assert states([KEEP, KEEP, KEEP, ON, ON, ON], rule=rule) == [N, N, N, N, N, A]
    raised = [ON, ON, ON]
    assert states([*raised, OFF, OFF, KEEP, OFF, OFF, OFF, OFF], rule=rule)[3:] == [
        A,
        A,
        A,
        A,
        A,
        A,
        C,
    ]
    assert states([*raised, AWAY], rule=rule)[3:] == [C]  # gone for good: at once


def test_a_rectified_alert_comes_back_only_after_the_cause_held():
    rule = Rule(raise_after=2.0)
    assert states([ON, ON, ON, OFF, ON, OFF, ON, ON, ON], rule=rule)[2:] == [A, C, C, C, C, C, A]
    # acknowledged while the cause is coming back: raised when it has held
    assert states([ON, ON, ON, OFF, ON, ACKNOWLEDGE, ON], rule=rule)[3:] == [C, C, N, A]


def test_a_caution_needs_no_acknowledgement():
    assert states([ON, ACKNOWLEDGE, ON, OFF, ON], rule=Rule(caution=True)) == [B, B, B, N, B]


def test_an_alert_on_something_momentary_stays_until_acknowledged():
    rule = Rule(momentary=True)
    assert states([ON, AWAY, AWAY, ACKNOWLEDGE, AWAY], rule=rule, momentary=True) == [A, A, A, N, N]


@pytest.mark.parametrize(
    ('rule', 'script'),
    [(Rule(momentary=True, lapse_after=5.0), [ON]), (Rule(lapse_after=4.0), [ON, OFF])],
)
def test_what_nobody_acknowledges_lapses(rule, script):
    found = states([*script, *[AWAY] * 6], rule=rule)
    assert found[5] != N and found[6] == N
    assert states([ON] * 20, rule=Rule(lapse_after=5.0)) == [A] * 20  # the cause is there


def test_each_change_is_told_once_with_the_values_of_that_time():
    rule = Rule(raise_after=1.0)
    alerts, changed = machine.advance(machine.begin(), KIND, 0, causes([OFF, ON]), rule, 0.0)
    assert not len(changed.id)
    now_there = causes([OFF, ON])._replace(values=np.full((2, 5), 7.0))
    alerts, changed = machine.advance(alerts, KIND, 0, now_there, rule, 1.0)
    assert changed.id.tolist() == [2] and changed.number.tolist() == [102]
    assert changed.values.tolist() == [[7.0] * 5] and changed.since.tolist() == [1.0]
    assert changed.kind.tolist() == [KIND]
    later = causes([OFF, ON])._replace(values=np.full((2, 5), 9.0))
    alerts, changed = machine.advance(alerts, KIND, 0, later, rule, 2.0)
    assert not len(changed.id) and alerts.values[0, 0] == 7.0 and alerts.since.tolist() == [1.0]
    alerts, changed = machine.advance(alerts, KIND, 0, causes([]), rule, 3.0)
    assert changed.state.tolist() == [C] and changed.values[0, 0] == 7.0  # the last known


def test_acknowledging_one_a_target_a_kind_or_all():
    def raised():
        first, _ = machine.advance(machine.begin(), 1, 0, causes([ON, ON]), Rule(), 0.0)
        second, _ = machine.advance(machine.begin(), 2, 0, causes([ON, ON]), Rule(), 0.0)
        return append(first, second)

    def count(kind, number):
        alerts, changed = machine.acknowledge(raised(), 1.0, LASTING, kind, number)
        assert (alerts.state == B).sum() == len(changed.id)
        return len(changed.id)

    assert count(1, 101) == 1
    assert count(None, 101) == 2
    assert count(2, None) == 2
    assert count(None, None) == 4
    with pytest.raises(ValueError, match='no alert of kind 5 to'):
        count(5, None)
    with pytest.raises(ValueError, match='no alert of kind 1 and target 9'):
        count(1, 9)
    assert machine.acknowledge(machine.begin(), 0.0, LASTING)[1].id.tolist() == []


def test_a_cancelled_target_has_no_alerts_left():
    alerts, _ = machine.advance(machine.begin(), 1, 0, causes([ON, ON, ON]), Rule(), 0.0)
    pending, _ = machine.advance(machine.begin(), 2, 0, causes([ON]), Rule(raise_after=9.0), 0.0)
    alerts, changed = machine.dismiss(append(alerts, pending), np.array([1, 3]), 1.0)
    assert sorted(changed.id.tolist()) == [1, 3] and (changed.state == NORMAL).all()
    assert alerts.id.tolist() == [2]


# properties over whole lives of several subjects

LEVELS = st.sampled_from([OFF, KEEP, ON, AWAY])
STEPS = st.lists(st.one_of(st.just(ACKNOWLEDGE), st.tuples(LEVELS, LEVELS, LEVELS)), max_size=60)
RULES = st.builds(
    Rule,
    st.sampled_from([0.0, 1.0, 3.0]),
    st.sampled_from([0.0, 2.0, 5.0]),
    st.sampled_from([8.0, 1e9]),
    st.booleans(),
    st.booleans(),
)


def by_hand(script, rule, subject):
    """The same machine for one subject in plain Python: (state, changed) after each step."""
    state, since, turn, out = NORMAL, 0, None, []
    for now, step in enumerate(script):
        before = state
        if step == ACKNOWLEDGE:
            if state == A:
                state = N if rule.momentary else B
            elif state == C:
                state = N
        else:
            level = step[subject]
            active = state in (A, B)
            if active:
                calls = level in (OFF, AWAY) and not rule.momentary
                wait = 0 if level == AWAY else rule.end_after
            else:
                calls, wait = level == ON, rule.raise_after
            if calls:
                turn = now if turn is None else turn
            elif active or level != KEEP:
                turn = None
            if calls and now - turn >= wait:
                state = (C if state == A else N) if active else (B if rule.caution else A)
                turn = None
            elif (state == C or active and rule.momentary) and now - since > rule.lapse_after:
                state, turn = N, None
        if state != before:
            since = now
        out.append((state, state != before))
    return out


@settings(max_examples=120, deadline=None)
@given(STEPS, RULES)
def test_many_subjects_at_once_live_as_each_would_by_itself(script, rule):
    expected = [by_hand(script, rule, subject) for subject in range(3)]
    alerts = machine.begin()
    for now, step in enumerate(script):
        if step == ACKNOWLEDGE:
            alerts, changed = machine.acknowledge(alerts, now, LASTING | rule.momentary)
        else:
            alerts, changed = machine.advance(alerts, KIND, 0, causes(step), rule, float(now))
        assert len(set(alerts.id.tolist())) == len(alerts.id)
        assert len(set(changed.id.tolist())) == len(changed.id)
        found = dict(zip(alerts.id.tolist(), alerts.state.tolist()))
        for subject in range(3):
            state, changes = expected[subject][now]
            assert found.get(subject + 1, NORMAL) == state
            assert (subject + 1 in changed.id) == changes


@settings(max_examples=120, deadline=None)
@given(
    st.lists(st.one_of(st.just(ACKNOWLEDGE), LEVELS), max_size=60),
    RULES.filter(lambda rule: not rule.momentary),
)
def test_no_alert_without_a_cause_one_raise_for_each_and_never_stuck(script, rule):
    # Whatever came before, then the cause ends and the operator acknowledges twice.
    quiet = int(rule.end_after) + 1
    script = [*script, *[OFF] * quiet, ACKNOWLEDGE, ACKNOWLEDGE, *[OFF] * 2]
    out = play(script, rule)
    assert out[-1][0] == NORMAL and not out[-2][1]
    raised, causes_held, run, armed = 0, 0, 0, True
    for step, (_, changed) in zip(script, out):
        raises = A in changed or B in changed and step != ACKNOWLEDGE
        raised += raises
        if step == ACKNOWLEDGE:
            continue
        assert not raises or step == ON
        run = run + 1 if step == ON else 0
        armed = armed or step in (OFF, AWAY)
        if armed and run == 1:
            causes_held, armed = causes_held + 1, False
    assert raised <= causes_held  # at most one raise a stretch of the cause
    assert not changed


@settings(max_examples=100, deadline=None)
@given(STEPS, RULES)
def test_acknowledging_again_changes_nothing(script, rule):
    alerts = machine.begin()
    for now, step in enumerate(script):
        if step != ACKNOWLEDGE:
            alerts, _ = machine.advance(alerts, KIND, 0, causes(step), rule, float(now))
        once, _ = machine.acknowledge(alerts, now, LASTING | rule.momentary)
        twice, changed = machine.acknowledge(once, now, LASTING | rule.momentary)
        assert not len(changed.id)
        for a, b in zip(once, twice):
            np.testing.assert_array_equal(a, b)
