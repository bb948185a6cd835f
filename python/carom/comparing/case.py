"""What differs between two cases."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from carom.case.scenario import Scenario

NAMING = ("name", "between")
"""Keys by which an entry of a list is known; without one it is known by its place."""


@dataclass(frozen=True)
class Change:
    """A value that two runs do not share.

    Parameters
    ----------
    key
        Where it stands, such as ``contact.friction`` or ``bodies.left.velocity``.
    first
        What it is in the first; None where it is not there.
    second
        The same in the second.
    """

    key: str
    first: Any
    second: Any


def changes(first: Scenario, second: Scenario) -> tuple[Change, ...]:
    """Return the values in which two cases differ, in the order of the case file.

    Every default is written out. Entries of lists with names are compared name by name, so that a
    body more is not a difference of all that follow.
    """
    a, b = (dict(_values("", json.loads(case.model_dump_json()))) for case in (first, second))
    keys = dict.fromkeys((*a, *b))
    return tuple(Change(key, a.get(key), b.get(key)) for key in keys if a.get(key) != b.get(key))


def _values(key: str, value: Any) -> Iterator[tuple[str, Any]]:  # noqa: ANN401 (any JSON value)
    """Yield the values below a key that are neither tables nor lists of tables."""
    if isinstance(value, Mapping):
        entries = list(value.items())
    elif isinstance(value, list) and value and all(isinstance(one, Mapping) for one in value):
        entries = [(_name(one, place), one) for place, one in enumerate(value)]
    else:
        yield key, value
        return
    for name, entry in entries:
        yield from _values(f"{key}.{name}" if key else name, entry)


def _name(entry: Mapping[str, Any], place: int) -> str:
    found = next((entry[key] for key in NAMING if entry.get(key)), place)
    return "–".join(found) if isinstance(found, list) else str(found)
