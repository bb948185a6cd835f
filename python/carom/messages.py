"""Turns what pydantic finds wrong into one `InputError` with a one-line message."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import tomlkit
from pydantic_core import PydanticCustomError

from carom.errors import InputError

if TYPE_CHECKING:
    from pydantic import ValidationError
    from pydantic_core import ErrorDetails

_PROBLEM = "carom_problem"
_ABSENT = object()

DATA_MESSAGES = {
    "missing": "required key is missing",
    "float_type": "must be a number",
    "finite_number": "must be a finite number",
    "int_type": "must be an integer",
    "string_type": "must be a string",
    "bool_type": "must be true or false",
    "dict_type": "must be a table",
    "model_type": "must be a table",
    "model_attributes_type": "must be a table",
    "tuple_type": "must be a list",
    "greater_than": "must be greater than {gt:g}",
    "greater_than_equal": "must be at least {ge:g}",
    "less_than": "must be less than {lt:g}",
    "less_than_equal": "must be at most {le:g}",
    "too_short": "must have {min_length} or more entries, not {actual_length}",
    "literal_error": "must be {expected}",
    "union_tag_invalid": "must be one of {expected_tags}",
    "union_tag_not_found": "required key is missing",
    "value_error": "{error}",
}
"""What carom says by pydantic's error type, formatted with the numbers pydantic gives."""


UNNAMED_KINDS = ("deformable", "dynamic")
"""Kinds of tables that need not say so."""


def problem(what: str, *, key: str | None = None, value: object = _ABSENT) -> PydanticCustomError:
    """Make the exception that a validator raises.

    Parameters
    ----------
    what
        What is wrong and what would be right.
    key
        Dotted path of the entry, relative to the model that is validated; None is the model.
    value
        The offending value; without it, only the key is shown.
    """
    context: dict[str, Any] = {"what": what, "key": key}
    if value is not _ABSENT:
        context["value"] = value
    return PydanticCustomError(_PROBLEM, "{what}", context)


_TOLD = 40
"""Names that a message lists at most."""


def inside(error: PydanticCustomError, key: str) -> PydanticCustomError:
    """Return a `problem` of a part as that of the whole, in which it is under this key."""
    context = dict(error.context or {})
    context["key"] = f"{key}.{context['key']}" if context.get("key") else key
    return PydanticCustomError(_PROBLEM, "{what}", context)


def known(name: str, names: Iterable[str]) -> str:
    """Return the nearest of the valid names, if one is near, and all of them if they are few."""
    names = list(names)
    near = difflib.get_close_matches(name, names, n=1)
    valid = f"known: {listed(names) or 'none'}"
    return f'did you mean "{near[0]}"? ({valid})' if near else valid


def listed(names: Sequence[str]) -> str:
    """Return names as a message lists them: the first of many, and how many more there are."""
    more = f" and {len(names) - _TOLD} more" if len(names) > _TOLD else ""
    return f"{', '.join(names[:_TOLD])}{more}"


def show(value: object) -> str:
    """Return a value as the case file would write it, cut to a readable length."""
    if _is_table(value):
        return "{…}"
    if isinstance(value, list | tuple) and any(map(_is_table, value)):
        text = f"[{', '.join(map(show, value))}]"
    else:
        try:
            text = tomlkit.item(value).as_string()
        except ValueError:
            text = repr(value)
    text = " ".join(text.split())
    return text if len(text) <= 60 else f"{text[:59]}…"


def _is_table(value: object) -> bool:
    """Return whether a value is a table of the case file, read or as an object."""
    return isinstance(value, Mapping) or hasattr(type(value), "model_fields")


def input_error(error: ValidationError, data: Mapping[str, Any]) -> InputError:
    """Return the first problem as an `InputError`, and say how many more there are.

    Parameters
    ----------
    error
        What pydantic raised.
    data
        What it was given, needed to tell keys from the tags of unions.
    """
    first, *others = error.errors(include_url=False)
    # What fits no member of a union is one problem, though pydantic tells of every member.
    path = _without_tags(first["loc"], data)
    others = [
        other for other in others if (p := _without_tags(other["loc"], data)) != path[: len(p)]
    ]
    key, value, what = _read(first, data)
    line = f"{key} = {show(value)}: {what}" if value is not _ABSENT else f"{key}: {what}"
    if others:
        line += f" (and {len(others)} more problem{'s' if len(others) > 1 else ''})"
    return InputError(line, key)


def _read(details: ErrorDetails, data: Mapping[str, Any]) -> tuple[str, object, str]:
    """Return the dotted key, the offending value and what is wrong with it."""
    kind, context = details["type"], details.get("ctx", {})
    path = _without_tags(details["loc"], data)
    value: object = details["input"]
    what = DATA_MESSAGES.get(kind, details["msg"]).format_map(context) if kind != _PROBLEM else ""
    if kind == _PROBLEM:
        path += [context["key"]] if context["key"] else []
        value, what = context.get("value", _ABSENT), context["what"]
    elif kind == "missing":
        value = _ABSENT
    elif kind == "union_tag_not_found":
        path, value = [*path, "kind"], _ABSENT
    elif kind == "union_tag_invalid":
        path, value = [*path, "kind"], context["tag"]
    return ".".join(path) or "scenario", value, what


def _without_tags(location: Sequence[int | str], data: object) -> list[str]:
    """Return pydantic's location without the union tags it inserts.

    A tag stands where a table of that kind was entered, before any of its keys; those in brackets
    tell forms of a value apart.
    """
    path: list[str] = []
    entered: object = None
    for part in location:
        if isinstance(part, str) and isinstance(data, int | float | str | Sequence):
            continue  # a member of a union of plain types
        if isinstance(data, Mapping):
            if data is not entered and _is_kind(part, data):
                entered = data
                continue
            data = data.get(part)
        elif isinstance(data, Sequence) and isinstance(part, int):
            data = data[part] if part < len(data) else None
        path.append(str(part))
    return [part for part in path if not part.startswith("[")]


def _is_kind(part: int | str, table: Mapping[str, object]) -> bool:
    """Return whether a part of a location is the kind of a table, which some need not name."""
    if "kind" in table:
        return table["kind"] == part
    return (part == "file" and "file" in table) or (part in UNNAMED_KINDS and part not in table)
