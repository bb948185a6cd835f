"""Whether data that were read have the form that they should: keys, and kinds of values."""

from __future__ import annotations

from collections.abc import Mapping
from types import NoneType
from typing import Any

Form = type | tuple[type, ...] | dict[str, Any] | list[Any]
"""A type or several; a table of forms by key, which may have more keys; a list of one form."""

NUMBER = (int, float)
MAYBE_NUMBER = (int, float, NoneType)

_MISSING = object()


def misfit(value: object, form: Form, key: str = "") -> str | None:
    """Return what does not fit, such as "energy.initial is missing"; None if all does."""
    name = key or "it"
    if value is _MISSING:
        return f"{name} is missing"
    if isinstance(form, dict):
        if not isinstance(value, Mapping):
            return f"{name} is no table"
        parts = ((member, value.get(member, _MISSING), form[member]) for member in form)
    elif isinstance(form, list):
        if not isinstance(value, list):
            return f"{name} is no list"
        parts = ((str(index), member, form[0]) for index, member in enumerate(value))
    else:
        return None if isinstance(value, form) else f"{name} is {value!r:.40}"
    return next(filter(None, (misfit(v, f, f"{key}.{m}".lstrip(".")) for m, v, f in parts)), None)
