"""The case file: a scenario as TOML."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.exceptions import ParseError, TOMLKitError
from tomlkit.items import AoT, InlineTable, Item, Table

from carom.description import Description
from carom.errors import InputError


def read(path: Path) -> dict[str, Any]:
    """Read a case file into nested dictionaries and lists.

    Raises
    ------
    InputError
        The file cannot be read, or is not TOML; the message gives the line and the column.
    """
    try:
        return tomlkit.parse(path.read_text(encoding="utf-8")).unwrap()
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"not UTF-8 text, at byte {error.start}") from error
    except ParseError as error:
        what = str(error).removesuffix(f" at line {error.line} col {error.col}")
        place = f"line {error.line}, column {error.col + 1}"  # tomlkit counts columns from 0
        raise InputError(f"{place}: not TOML: {what}") from error
    except TOMLKitError as error:
        raise InputError(f"not TOML: {error}") from error


def write(scenario: Description) -> str:
    """Return the TOML text of a scenario, without the values that equal their defaults."""
    document = tomlkit.document()
    for key, value in _stated(scenario).items():
        document.add(key, _section(value))
    return tomlkit.dumps(document)


def _section(value: object) -> Item:
    """Return a top-level entry: a table, a table of tables, or what `_entry` makes of it."""
    if isinstance(value, Description):
        return _table(value)
    if isinstance(value, dict):
        group = tomlkit.table(is_super_table=True)
        for name, member in value.items():
            group.add(name, _table(member))
        return group
    return _entry(value)


def _entry(value: object) -> Item:
    """Return an entry of a table: what has parts is written in a line, lists of such as [[…]]."""
    if isinstance(value, Description):
        return _inline(value)
    if isinstance(value, tuple) and value and isinstance(value[0], Description):
        return AoT([_table(member) for member in value])
    return tomlkit.item(list(value) if isinstance(value, tuple) else value)


def _table(part: Description) -> Table:
    table = tomlkit.table()
    for key, value in _stated(part).items():
        table.add(key, _entry(value))
    return table


def _inline(part: Description) -> InlineTable:
    table = tomlkit.inline_table()
    for key, value in _stated(part).items():
        table.add(key, _entry(value))
    return table


def _stated(part: Description) -> dict[str, Any]:
    """Return the fields that are not at their default; ``kind`` is always stated, and first."""
    fields = type(part).model_fields
    stated = {
        name: getattr(part, name)
        for name, field in fields.items()
        if name == "kind" or getattr(part, name) != field.get_default(call_default_factory=True)
    }
    return {"kind": stated.pop("kind"), **stated} if "kind" in stated else stated
