import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from marine_tracker.arpa.nmea import LOST, TRACKING, Targets
from marine_tracker.arpa.nmea_targets import nothing_told, slots, word


def targets(*numbers, lost=(), range_=1000.0):
    """Targets of these numbers, each at its number in metres beyond the range."""
    count, numbers = len(numbers), np.array(numbers, np.int64)
    figures = np.ones(count)
    return Targets(
        numbers,
        np.where(np.isin(numbers, lost), LOST, TRACKING),
        np.full(count, 'A'),
        np.array([f'TT{n:02d}' for n in numbers], str),
        range_ + numbers,
        *[figures] * 5,
    )


def said(now):
    """What a word tells: {two-digit number: (name, status, range)}."""
    rows = now.targets
    told = {
        int(n): (str(name), str(status), float(r))
        for n, name, status, r in zip(rows.number, rows.name, rows.status, rows.range)
    }
    assert len(told) == len(rows.number)  # no number twice in a scan
    return told


def play(*scans):
    told, words = nothing_told(), []
    for scan in scans:
        told, now = word(told, scan)
        words.append(now)
    return told, words


def test_every_target_is_told_once_a_scan():
    _, (first, second) = play(targets(1, 2), targets(1, 2, 3))
    assert said(first) == {1: ('TT01', 'T', 1001), 2: ('TT02', 'T', 1002)}
    assert set(said(second)) == {1, 2, 3} and second.numbers.tolist() == [1, 2, 3]


def test_a_lost_target_gets_one_last_word():
    _, words = play(targets(1, 2), targets(1, 2, lost=[2]), targets(1, 2, lost=[2]), targets(1))
    assert [said(now).get(2) for now in words] == [
        ('TT02', 'T', 1002),
        ('TT02', 'L', 1002),
        None,
        None,
    ]


def test_a_target_that_is_no_longer_there_is_lost_where_it_was_last():
    _, words = play(targets(1, 2), targets(1, range_=500.0), targets(1))
    assert said(words[1]) == {1: ('TT01', 'T', 501), 2: ('TT02', 'L', 1002)}
    assert said(words[2]) == {1: ('TT01', 'T', 1001)}


def test_when_all_have_gone_all_are_taken_back():
    _, (_, now) = play(targets(1, 2, 3), targets())
    assert [status for _, status, _ in said(now).values()] == ['L'] * 3


def test_a_lost_target_never_heard_of_is_not_told():
    _, (now,) = play(targets(1, 2, lost=[2]))
    assert set(said(now)) == {1}


def test_the_number_of_a_target_that_has_gone_is_not_given_away_in_the_same_scan():
    told, (_, second, third) = play(targets(1, 2), targets(2, 101), targets(2, 101, 102))
    assert said(second) == {1: ('TT01', 'L', 1001), 2: ('TT02', 'T', 1002), 3: ('TT101', 'T', 1101)}
    assert said(third)[1] == ('TT102', 'T', 1102)
    assert told.slots == {2: 2, 101: 3, 102: 1}


def test_a_target_that_comes_back_is_told_again():
    _, words = play(targets(5), targets(), targets(5))
    assert [said(now) and said(now)[5][1] for now in words] == ['T', 'L', 'T']


def test_more_than_99_targets_wait_and_are_counted():
    told, (first, second) = play(targets(*range(1, 121)), targets(*range(41, 121)))
    assert len(said(first)) == 99 and first.waiting == 21
    # The 40 that have gone keep their numbers for this scan's last word.
    assert len(said(second)) == 99 and second.waiting == 21
    told, now = word(told, targets(*range(41, 121)))
    assert len(said(now)) == 80 and now.waiting == 0
    assert set(now.numbers.tolist()) == set(range(41, 121))


def test_numbers_up_to_99_are_kept_and_larger_ones_take_the_lowest_free_for_life():
    held = slots({}, [1, 2, 99])
    assert held == {1: 1, 2: 2, 99: 99}
    held = slots(held, [2, 99, 100, 101])
    assert held == {2: 2, 99: 99, 100: 1, 101: 3}
    held = slots(held, [101, 102])  # 100 has gone, 101 stays as it was
    assert held == {101: 3, 102: 1}
    assert slots(held, [101, 102, 3]) == {101: 3, 102: 1, 3: 2}  # a tracker begun anew


def test_three_digits_tell_more_targets_each_by_its_own_number():
    told, now = word(nothing_told(), targets(7, 107, 640, -45), greatest=750)
    assert {n: name for n, (name, _, _) in said(now).items()} == {
        7: 'TT07',
        107: 'TT107',
        640: 'TT640',
        750: 'TT-45',  # being acquired: out of the way
    }
    _, now = word(told, targets(*range(1, 761)), greatest=750)
    assert len(said(now)) == 750 and now.waiting == 11


def test_more_targets_than_numbers_wait_until_one_is_free():
    held = slots({}, range(1, 151))
    assert held == {n: n for n in range(1, 100)}
    held = slots(held, range(50, 151))
    assert held[50] == 50 and held[100] == 1 and held[148] == 49
    assert sorted(held.values()) == list(range(1, 100)) and 149 not in held


@given(st.lists(st.lists(st.integers(-50, 400), unique=True, max_size=120), max_size=6))
def test_two_targets_never_share_a_number_and_none_changes(scans):
    held = {}
    for numbers in scans:
        now = slots(held, numbers)
        assert len(set(now.values())) == len(now) == min(len(numbers), 99)
        assert set(now.values()) <= set(range(1, 100)) and set(now) <= set(numbers)
        assert all(now[n] == held[n] for n in numbers if n in held)
        held = now


def test_a_target_being_acquired_gets_a_number_out_of_the_way_until_it_has_its_own():
    assert slots({}, [1, -123, 2, -124]) == {1: 1, 2: 2, -123: 99, -124: 98}
    _, words = play(targets(1, -123), targets(1, 2), targets(1, 2))
    assert said(words[0])[99][1] == 'T' and said(words[1])[99][1] == 'L'
    assert {n: status for n, (_, status, _) in said(words[2]).items()} == {1: 'T', 2: 'T'}
