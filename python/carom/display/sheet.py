"""Tables on the screen in which no number is cut short, however many columns they have."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.measure import Measurement
from rich.table import Table
from rich.text import Text

_AROUND = 3
"""Characters between two columns."""

LONGEST = 100_000
"""Characters of a line in a pipe, at the most."""

_EDGES = 2
"""Characters at the edges of a table."""


@dataclass(frozen=True)
class Sheet:
    """Rows below a header.

    Parameters
    ----------
    header
        Title of each column.
    rows
        Cells, as many in each row.
    keys
        How many columns at the left say which row this is.
    """

    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    keys: int = 1


def print_whole(console: Console, sheet: Sheet, *, title: str | None = None) -> None:
    """Print all cells of a sheet.

    What is no terminal takes lines of any length: there a row is a line. On a terminal that is too
    narrow the columns come in several tables, each of which begins with the keys. Where not even
    one column fits beside them, words are folded.
    """
    if title:
        console.print(Text(title, style="italic"), soft_wrap=True)
    widths = _widths(sheet)
    parts = [[*range(len(widths))]]
    if console.is_terminal:
        widths[: sheet.keys] = _folded(widths[: sheet.keys], console.width // 2)
        parts = _parts(widths, sheet.keys, console.width)
    for columns in parts:
        table = Table(box=SIMPLE_HEAD)
        for column in columns:
            most = widths[column] - _AROUND if column < sheet.keys else None
            table.add_column(Text(sheet.header[column]), overflow="fold", max_width=most)
        for row in sheet.rows:
            table.add_row(*(Text(row[column]) for column in columns))
        if not console.is_terminal:
            endless = console.options.update(width=LONGEST)
            table.width = Measurement.get(console, endless, table).maximum
        console.print(table, crop=False)


def _widths(sheet: Sheet) -> list[int]:
    """Return the characters of columns in which nothing is folded but titles, at spaces."""
    columns = zip(sheet.header, *sheet.rows, strict=True)
    return [
        _AROUND + max(map(len, (*title.split(), *cells)), default=0) for title, *cells in columns
    ]


def _folded(widths: Sequence[int], most: int) -> list[int]:
    """Return widths of which the largest is made smaller, so that all together are so wide."""
    largest = max(range(len(widths)), key=lambda column: widths[column])
    excess = max(0, sum(widths) - most)
    least = _AROUND + 4
    return [
        max(least, width - excess) if column == largest and excess else width
        for column, width in enumerate(widths)
    ]


def _parts(widths: Sequence[int], keys: int, width: int) -> list[list[int]]:
    """Return the columns of each table."""
    always = list(range(keys))
    free = width - _EDGES - sum(widths[:keys])
    parts: list[list[int]] = []
    left = 0
    for column in range(keys, len(widths)):
        if not parts or widths[column] > left:
            parts.append([*always])
            left = free
        parts[-1].append(column)
        left -= widths[column]
    return parts or [always]
