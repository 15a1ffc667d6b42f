"""The targets to send in each scan: their short numbers, and the last word on ended ones."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..types import IntArray, append, take
from .nmea import LOST, TWO_DIGITS, Targets


class Told(NamedTuple):
    """What receivers know.

    slots    {target number: its short number}
    numbers  [N] target numbers of `targets`
    targets  N rows as last sent, none of them lost
    """

    slots: dict[int, int]
    numbers: IntArray
    targets: Targets


class Word(NamedTuple):
    """What to send now.

    numbers  [M]     target numbers
    targets  M rows  with their short numbers
    waiting  number of targets that are not sent, because all short numbers are in use
    """

    numbers: IntArray
    targets: Targets
    waiting: int


def nothing_told() -> Told:
    """The state of a receiver that knows no target."""
    none, words = np.zeros(0), np.zeros(0, 'U1')
    numbers = np.zeros(0, np.int64)
    return Told({}, numbers, Targets(numbers, words, words, words, *[none] * 6))


def slots(
    held: dict[int, int], numbers: Sequence[int], greatest: int = TWO_DIGITS
) -> dict[int, int]:
    """A short number for each target's own number, because TTM has few digits.

    held      {target number: short number} of the scan before
    numbers   the targets of this scan
    greatest  largest short number

    A target keeps its number for life. A new target gets its own number if that is short enough and
    free, else the lowest free one. So TT07 is 07; when 07 is gone, TT107 may be 07. A target that
    is still being acquired has no number yet, here a negative one. It gets the highest free one.
    When all are in use, the rest wait: they are not in the result.
    """
    short = range(1, greatest + 1)
    kept = {number: held[number] for number in numbers if number in held}
    taken = set(kept.values())
    for number in numbers:
        if number in kept:
            continue
        free = (
            number
            if number in short and number not in taken
            else next(
                (slot for slot in (short if number > 0 else reversed(short)) if slot not in taken),
                None,
            )
        )
        if free is None:
            break
        kept[number] = free
        taken.add(free)
    return kept


def word(told: Told, targets: Targets, greatest: int = TWO_DIGITS) -> tuple[Told, Word]:
    """What receivers know after a scan, and what to send.

    targets   of the scan, with their own numbers in `number`; negative while they have none
    greatest  largest short number that receivers accept

    A target that was lost, or is no longer there (cancelled, or its tracker has ended), is sent
    once more as LOST, with its last values if there are no newer ones. After that its short number
    is free. A lost target that was never sent is not sent now.
    """
    missing = ~np.isin(told.numbers, targets.number)
    gone = take(told.targets, missing)
    gone = gone._replace(number=told.numbers[missing], status=np.full(missing.sum(), LOST))
    known = (targets.status != LOST) | np.isin(targets.number, told.numbers)
    every = append(gone, take(targets, known))
    chosen = slots(told.slots, every.number.tolist(), greatest)
    every = take(every, np.isin(every.number, list(chosen)))
    numbers = every.number
    alive = every.status != LOST
    every = every._replace(number=np.array([chosen[n] for n in numbers.tolist()], np.int64))
    waiting = int(known.sum() + missing.sum()) - len(numbers)
    return (
        Told({n: chosen[n] for n in numbers[alive].tolist()}, numbers[alive], take(every, alive)),
        Word(numbers, every, waiting),
    )
