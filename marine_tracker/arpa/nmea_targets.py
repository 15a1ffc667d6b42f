"""What goes out about targets from scan to scan: their short numbers, and one last word."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..types import append, take
from .nmea import LOST, TWO_DIGITS, Targets


class Told(NamedTuple):
    """What receivers know.

    slots    {target number: its short number}
    numbers  [N] target numbers of `targets`
    targets  N rows as last told, none of them lost
    """

    slots: dict[int, int]
    numbers: NDArray[np.int64]
    targets: Targets


class Word(NamedTuple):
    """What to tell now.

    numbers  [M]     target numbers
    targets  M rows  with their short numbers
    waiting  targets that get no word, as all short numbers are taken
    """

    numbers: NDArray[np.int64]
    targets: Targets
    waiting: int


def nothing_told() -> Told:
    """That of a receiver who knows no target."""
    none, words = np.zeros(0), np.zeros(0, 'U1')
    numbers = np.zeros(0, np.int64)
    return Told({}, numbers, Targets(numbers, words, words, words, *[none] * 6))


def slots(
    held: dict[int, int], numbers: Sequence[int], greatest: int = TWO_DIGITS
) -> dict[int, int]:
    """A short number for each target's own number, as TTM has no more digits.

    held      {target number: short number} of the scan before
    numbers   the targets of this scan
    greatest  short number

    A target keeps what it has for life. A new one takes its own number where that is short enough
    and free, else the lowest free one; so TT07 is 07 and, when 07 has gone, TT107 may be 07.
    One that is still being acquired has no number yet, here a negative one: it takes the highest
    free one, out of the way. When all are taken, the rest wait: they are not in the answer.
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
    """What receivers know after a scan, and what to tell them of it.

    targets   of the scan, `number` their own numbers; negative while they have none
    greatest  short number that receivers take

    A target that was lost, or is no longer there (cancelled, or its tracker has ended), gets one
    last word as LOST, as it was last told if there is no more of it; after that its short
    number is free. A lost one that receivers never heard of gets none.
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
