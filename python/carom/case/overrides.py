"""Replacing single values of a scenario, as ``--set KEY=VALUE`` does."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from copy import deepcopy
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError

from carom.errors import InputError
from carom.messages import known

_BARE_WORD = re.compile(r"[A-Za-z_][\w-]*")


def apply(data: dict[str, Any], assignments: Iterable[str]) -> dict[str, Any]:
    """Return a copy of the data with each ``KEY=VALUE`` put in its place.

    Only the way to the key must exist: whether the scenario knows the key is for it to say.
    """
    values: dict[str, Any] = {}
    for assignment in assignments:
        key, equals, text = assignment.partition("=")
        key = key.strip()
        if not (key and equals):
            raise InputError(
                f"override {assignment!r}: write KEY=VALUE, such as analysis.end_time=3"
            )
        values.pop(key, None)  # the last one counts, in its place
        values[key] = value_of(key, text.strip())
    return with_values(data, values)


def with_values(data: dict[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """Return a copy of the data with each value put where its dotted key says."""
    data = deepcopy(data)
    for key, value in values.items():
        _assign(data, key, deepcopy(value))
    return data


def value_of(key: str, text: str) -> Any:  # noqa: ANN401 (any TOML value)
    """Return what a text means as the value of a key: a TOML value, or a bare word."""
    try:
        return tomlkit.value(text).unwrap()
    except TOMLKitError:
        if _BARE_WORD.fullmatch(text):
            return text
        raise InputError(
            f"{key} = {text}: not a TOML value; a text of several words needs quotes", key
        ) from None


def _assign(data: dict[str, Any], key: str, value: object) -> None:
    *way, last = key.split(".")
    parent: Any = data
    for depth, part in enumerate(way):
        where = ".".join(way[:depth])
        if isinstance(parent, dict) and part not in parent:
            raise InputError(
                f"{key}: no {part!r} in {where or 'the scenario'}; {known(part, parent)}", key
            )
        parent = parent[_place(parent, part, key=key, where=where)]
    parent[_place(parent, last, key=key, where=".".join(way))] = value


def _place(parent: object, part: str, *, key: str, where: str) -> str | int:
    """Return the key or the index that `part` stands for in `parent`."""
    if isinstance(parent, dict):
        return part
    if parent is None:
        raise InputError(f"{key}: the case has no {where}; give all of it, as {where}=…", key)
    if not isinstance(parent, list):
        raise InputError(f"{key}: {where} is a single value and has no {part!r} in it", key)
    if not (part.isdecimal() and int(part) < len(parent)):
        entries = f"0 to {len(parent) - 1}" if parent else "none"
        raise InputError(f"{key}: {where} has no entry {part!r} (entries: {entries})", key)
    return int(part)
