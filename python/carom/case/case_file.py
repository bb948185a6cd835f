"""The case file: a scenario as TOML."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomlkit
from pydantic.fields import FieldInfo
from tomlkit.exceptions import ParseError, TOMLKitError
from tomlkit.items import AoT, Array, InlineTable, Item, Table

from carom.case.description import Description
from carom.errors import InputError


def read(path: Path) -> dict[str, Any]:
    """Read a case file into nested dictionaries and lists.

    Raises
    ------
    InputError
        The file cannot be read, or is not TOML; the message gives the line and the column.
    """
    try:
        # Editors of Windows put a mark in front of UTF-8, which "-sig" takes away.
        return tomlkit.parse(path.read_text(encoding="utf-8-sig")).unwrap()
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"not UTF-8 text, at byte {error.start}; save it as UTF-8") from error
    except ParseError as error:
        what = str(error).removesuffix(f" at line {error.line} col {error.col}")
        place = f"line {error.line}, column {error.col + 1}"  # tomlkit counts columns from 0
        raise InputError(f"{place}: not TOML: {what}") from error
    except TOMLKitError as error:
        raise InputError(f"not TOML: {error}") from error


def with_paths_from(directory: Path, data: dict[str, Any]) -> dict[str, Any]:
    """Return a case whose relative paths, which begin at its own file, begin at a directory."""

    def placed(value: object) -> object:
        if isinstance(value, dict):
            return {
                key: str(directory / entry)
                if key in ("file", "result") and isinstance(entry, str)
                else placed(entry)
                for key, entry in value.items()
            }
        return [placed(entry) for entry in value] if isinstance(value, list) else value

    return {
        key: placed(value) if key in ("bodies", "patterns", "obstacles", "initial") else value
        for key, value in data.items()
    }


def write(scenario: Description, *, complete: bool = False) -> str:
    """Return the TOML text of a scenario; if not `complete`, without what equals its default."""
    writer = _Writer(complete=complete)
    document = tomlkit.document()
    for key, value in writer.stated(scenario).items():
        document.add(key, writer.section(value))
    return tomlkit.dumps(document)


@dataclass(frozen=True)
class _Writer:
    complete: bool

    def section(self, value: object) -> Item:
        """Return a top-level entry: a table, a table of tables, or what `entry` makes of it."""
        if isinstance(value, Description):
            return self._table(value)
        if isinstance(value, dict):
            group = tomlkit.table(is_super_table=True)
            for name, member in value.items():
                group.add(name, self._table(member))
            return group
        return self._entry(value)

    def _entry(self, value: object) -> Item:
        """Return an entry of a table: parts are written in a line, lists of them as [[…]]."""
        if isinstance(value, Description):
            return self._inline(value)
        if not isinstance(value, tuple):
            return tomlkit.item(value)
        if value and all(isinstance(member, Description) for member in value):
            return AoT([self._table(member) for member in value])
        return self._array(value)

    def _array(self, value: tuple[object, ...]) -> Array:
        """Return a list in a line; of functions of time there are tables, numbers and texts."""
        array = tomlkit.array()
        for member in value:
            array.append(self._entry(member))
        return array

    def _table(self, part: Description) -> Table:
        table = tomlkit.table()
        for key, value in self.stated(part).items():
            table.add(key, self._entry(value))
        return table

    def _inline(self, part: Description) -> InlineTable:
        table = tomlkit.inline_table()
        for key, value in self.stated(part).items():
            # No [[…]] begins within a line.
            table.add(key, self._array(value) if isinstance(value, tuple) else self._entry(value))
        return table

    def stated(self, part: Description) -> dict[str, Any]:
        """Return the fields to write, ``kind`` first; what is None or empty cannot be written."""
        stated = {
            name: part.given(name)
            for name, field in type(part).model_fields.items()
            if name == "kind" or self._is_written(part.given(name), field)
        }
        return {"kind": stated.pop("kind"), **stated} if "kind" in stated else stated

    def _is_written(self, value: object, field: FieldInfo) -> bool:
        default = field.get_default(call_default_factory=True)
        if value is None or value in ((), {}):
            return bool(value != default)
        return self.complete or bool(value != default)
