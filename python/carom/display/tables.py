"""Tables of quantities and their values, for terminals and notebooks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from rich.table import Table
from rich.text import Text

from carom.display.markup import Html, element

Rows = Iterator[tuple[str, str]]
"""Quantities and their values."""


def two_columns(title: str) -> Table:
    """Return an empty table of quantities and their values."""
    table = Table(title=Text(title), title_justify="left", show_header=False)
    table.add_column(style="bold", overflow="fold")  # names of bodies can be long
    table.add_column(overflow="fold")
    return table


def add(table: Table, quantity: str, value: str) -> None:
    """Add a row; brackets in it are text, not markup."""
    table.add_row(Text(quantity), Text(value))


def html_table(rows: Iterable[tuple[str, str]]) -> Html | None:
    """Return a table of quantities and their values as HTML; None of none."""
    left = "text-align: left"
    lines = [
        element("tr", element("th", quantity, style=left), element("td", value, style=left))
        for quantity, value in rows
    ]
    return element("table", lines) if lines else None
