"""CSV tables as arrays, with errors that name the file, the line and the cell."""

import csv
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..types import Array


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
        """The row's place, as an error names it."""
        return f'{self.path}, line {self.line[row]}'

    def numbers(
        self, name: str, *, missing: bool = False, low: float = -np.inf, high: float = np.inf
    ) -> Array:
        """A column [R] as finite numbers between `low` and `high`.

        missing  an empty cell, or `nan`, is allowed and becomes nan
        Raises ValueError for the first cell that is none.
        """
        cells = self.columns[name]
        values = np.empty(len(cells))
        for row, cell in enumerate(cells):
            try:
                values[row] = float(cell or 'nan') if missing else float(cell)
            except ValueError:
                raise ValueError(
                    f'{self.where(row)}: {name} is {cell!r}; it must be a number'
                ) from None
        wrong = ~(np.isfinite(values) | (missing & np.isnan(values)))
        if wrong.any():
            row = int(wrong.argmax())
            raise ValueError(f'{self.where(row)}: {name} is {cells[row]}; it must be finite')
        wrong = (values < low) | (values > high)
        if wrong.any():
            row = int(wrong.argmax())
            limit = f'between {low:g} and {high:g}' if np.isfinite(high) else f'at least {low:g}'
            raise ValueError(f'{self.where(row)}: {name} is {cells[row]}; it must be {limit}')
        return values

    def integers(self, name: str):
        """A column [R] as whole numbers, int64 (`3` and `3.0` are the same)."""
        values = self.numbers(name, low=-(2.0**53), high=2.0**53)
        wrong = values != np.rint(values)
        if wrong.any():
            row = int(wrong.argmax())
            raise ValueError(
                f'{self.where(row)}: {name} is {self.columns[name][row]}; it must be a whole number'
            )
        return values.astype(np.int64)


def read(path, required=()) -> Table:
    """The table in a CSV file; blank lines are skipped.

    Raises ValueError for a file that is missing, empty or not text, for a column of `required`
    that is missing, for a column named twice, and for a line with too few or too many cells.
    """
    path = Path(path)
    try:
        with open(path, newline='', encoding='utf-8-sig') as file:
            reader = csv.reader(file)
            lines = [(reader.line_num, cells) for cells in reader if cells]
    except FileNotFoundError:
        raise ValueError(f'{path} does not exist') from None
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f'{path} cannot be read as CSV: {error}') from error
    if not lines:
        raise ValueError(f'{path} is empty; its first line must name the columns')
    header = [name.strip() for name in lines[0][1]]
    for name in required:
        if name not in header:
            raise ValueError(f'{path} has no column {name}; it has {", ".join(header)}')
    if len(set(header)) < len(header):
        raise ValueError(f'{path} names a column twice: {", ".join(header)}')
    for number, cells in lines[1:]:
        if len(cells) != len(header):
            raise ValueError(
                f'{path}, line {number} has {len(cells)} cells; it must have {len(header)}'
            )
    columns = zip(*(cells for _, cells in lines[1:])) if lines[1:] else ([] for _ in header)
    return Table(
        path,
        {name: [cell.strip() for cell in column] for name, column in zip(header, columns)},
        [number for number, _ in lines[1:]],
    )
