"""The lines of an Abaqus input file: keywords, their options and their data."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Row:
    """A line of data.

    Parameters
    ----------
    fields
        What stands between its commas.
    text
        The line as it is.
    place
        Where it is, for messages.
    goes_on
        Whether it goes on where the line before it ended in a comma.
    """

    fields: list[str]
    text: str
    place: str
    goes_on: bool = False

    def integer(self, field: int) -> int:
        """Return a field as a number of a node or an element."""
        try:
            return int(self.fields[field])
        except ValueError:
            raise self._no(field, "whole number") from None

    def number(self, field: int) -> float:
        """Return a field as a real number."""
        try:
            return float(self.fields[field].replace("D", "E").replace("d", "e"))
        except ValueError:
            raise self._no(field, "number") from None

    def first(self) -> Row:
        """Return the line with its first field only."""
        return Row(self.fields[:1], self.text, self.place)

    def _no(self, field: int, wanted: str) -> ValueError:
        column = 1 + sum(len(before) + 1 for before in self.text.split(",")[:field])
        column += len(after := self.text.split(",")[field]) - len(after.lstrip())
        found = self.fields[field]
        what = f'"{found}" is no {wanted}' if found else f"a {wanted} is missing"
        return ValueError(f"{self.place}, column {column}: {what}")


def sections(path: Path, *, name: str = "") -> Iterator[tuple[str, dict[str, str], list[Row]]]:
    """Yield each keyword with its options and its lines of data, those of included files too.

    Parameters
    ----------
    path
        The file.
    name
        What messages call it; empty for the file that the user gave.
    """
    keyword: str | None = None
    options: dict[str, str] = {}
    rows: list[Row] = []
    goes_on = False
    text = path.read_text(encoding="utf-8", errors="replace")
    for number, line in enumerate(text.splitlines(), start=1):
        begun = line.lstrip()
        if begun.startswith("**") or not begun:
            continue
        if not begun.startswith("*"):
            place = f"line {number}{f' of {name}' if name else ''}"
            rows.append(Row(_fields(line), line, place, goes_on))
            goes_on = line.rstrip().endswith(",")
            continue
        if keyword is not None:
            yield keyword, options, rows
        title, *given = (part.strip() for part in begun[1:].split(","))
        keyword, rows, goes_on = " ".join(title.upper().split()), [], False
        options = {}
        for option in given:
            key, _, value = option.partition("=")
            options[key.strip().upper()] = value.strip().strip('"')
        if keyword == "INCLUDE":
            included = options.get("INPUT", "")
            yield from sections(path.parent / included, name=included)
            keyword = None
    if keyword is not None:
        yield keyword, options, rows


def _fields(line: str) -> list[str]:
    """Return what stands between commas, without the empty fields at the end."""
    fields = [entry.strip() for entry in line.split(",")]
    while len(fields) > 1 and not fields[-1]:
        fields.pop()
    return fields
