"""CSV tables as arrays, with errors that name the file, the line and the cell."""

import codecs
import csv
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import IO, NamedTuple

import numpy as np

from .files import Place, regular, shortened, shown
from .types import Array, IntArray

MAX_LINE = 100_000  # characters


class Table(NamedTuple):
    """A CSV file with a header line.

    path     the file, for messages
    columns  text of the cells [R] by column name
    line     [R] line of the file each row stands on
    """

    path: Path
    columns: dict[str, list[str]]
    line: list[int]

    def __len__(self) -> int:
        return len(self.line)

    def where(self, row: int) -> str:
        """The row's place, for an error message."""
        return f'{shortened(self.path)}, line {self.line[row]}'

    def numbers(
        self, name: str, *, missing: bool = False, low: float = -np.inf, high: float = np.inf
    ) -> Array:
        """A column [R] as finite numbers between `low` and `high`.

        missing  an empty cell, or `nan`, is allowed and becomes nan
        Raises ValueError for the first cell that is not such a number.
        """
        cells = self.columns[name]
        values = np.empty(len(cells))
        for row, cell in enumerate(cells):
            try:
                values[row] = float(cell or 'nan') if missing else float(cell)
            except ValueError:
                raise ValueError(
                    f'{self.where(row)}: {name} is {shown(cell)}; it must be a number'
                ) from None
        wrong = ~(np.isfinite(values) | (missing & np.isnan(values)))
        if wrong.any():
            row = int(wrong.argmax())
            raise ValueError(
                f'{self.where(row)}: {name} is {shortened(cells[row])}; it must be finite'
            )
        wrong = (values < low) | (values > high)
        if wrong.any():
            row = int(wrong.argmax())
            limit = f'between {low:g} and {high:g}' if np.isfinite(high) else f'at least {low:g}'
            raise ValueError(
                f'{self.where(row)}: {name} is {shortened(cells[row])}; it must be {limit}'
            )
        return values

    def integers(self, name: str) -> IntArray:
        """A column [R] as whole numbers, int64 (`3` and `3.0` are the same)."""
        values = self.numbers(name, low=-(2.0**53), high=2.0**53)
        wrong = values != np.rint(values)
        if wrong.any():
            row = int(wrong.argmax())
            cell = shortened(self.columns[name][row])
            raise ValueError(f'{self.where(row)}: {name} is {cell}; it must be a whole number')
        return values.astype(np.int64)


class Rows(NamedTuple):
    """A CSV file that is being read.

    names  of the columns, without blanks around them; so are the cells
    rows   (line of the file, cells), read on demand; blank lines are skipped
    """

    names: list[str]
    rows: Iterator[tuple[int, list[str]]]


def rows(path: Place, *, broken: str = 'strict') -> Rows:
    """The rows of a CSV file, one by one: UTF-8, with or without byte order mark, or UTF-16.

    broken  for bytes that are not text: 'strict' is an error, 'replace' puts a sign for each
    Raises ValueError for a file that is missing, empty, not a regular file or not text, and for a
    column named twice.
    """
    path = Path(path)
    found = _rows(path, broken)
    _, header = next(found, (0, []))
    if not header:
        raise ValueError(f'{shortened(path)} is empty; its first line must name the columns')
    if len(set(header)) < len(header):
        raise ValueError(f'{shortened(path)} names a column twice: {shortened(", ".join(header))}')
    return Rows(header, found)


def read(path: Place, required: Sequence[str] = ()) -> Table:
    """The table in a CSV file (see `rows`).

    Raises ValueError as `rows` does, for a column of `required` that is missing, and for a line
    with too few or too many cells.
    """
    path = Path(path)
    header, found = rows(path)
    for name in required:
        if name not in header:
            raise ValueError(
                f'{shortened(path)} has no column {name}; it has {shortened(", ".join(header))}'
            )
    lines = []
    for number, cells in found:
        if len(cells) != len(header):
            raise ValueError(
                f'{shortened(path)}, line {number} has {len(cells)} cells; '
                f'it must have {len(header)}'
            )
        lines.append((number, cells))
    columns = zip(*(cells for _, cells in lines)) if lines else ([] for _ in header)
    return Table(
        path,
        {name: list(column) for name, column in zip(header, columns)},
        [number for number, _ in lines],
    )


def _rows(path: Path, broken: str) -> Iterator[tuple[int, list[str]]]:
    try:
        with open(regular(path), 'rb') as binary:
            start = binary.read(2)
        utf16 = start in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
        encoding = 'utf-16' if utf16 else 'utf-8-sig'
        with open(path, newline='', encoding=encoding, errors=broken) as file:
            reader = csv.reader(_lines(file, path))
            for cells in reader:
                if cells:
                    yield reader.line_num, [cell.strip() for cell in cells]
    except FileNotFoundError:
        raise ValueError(f'{shortened(path)} does not exist') from None
    except UnicodeDecodeError as error:
        kind = 'UTF-16' if utf16 else 'UTF-8'
        byte = error.object[error.start]
        raise ValueError(
            f'{shortened(path)}{_line_of_bad_text(path, utf16)}: the byte 0x{byte:02x} '
            f'is not {kind}; save the file as UTF-8'
        ) from None
    except OSError as error:
        raise ValueError(f'{shortened(path)} cannot be read: {error.strerror or error}') from error
    except csv.Error as error:
        raise ValueError(
            f'{shortened(path)}, line {reader.line_num} cannot be read as CSV: {error}'
        ) from error


def _lines(file: IO[str], path: Path) -> Iterator[str]:
    """Lines, none of them without end."""
    number = 0
    while line := file.readline(MAX_LINE + 1):
        number += 1
        if len(line) > MAX_LINE:
            raise ValueError(
                f'{shortened(path)}, line {number} has more than {MAX_LINE} characters; it must not'
            )
        yield line


def _line_of_bad_text(path: Path, utf16: bool) -> str:
    if utf16:
        return ''
    with open(path, 'rb') as file:
        for number, line in enumerate(file, 1):
            try:
                line.decode()
            except UnicodeDecodeError:
                return f', line {number}'
    return ''
