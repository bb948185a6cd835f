"""Whether data that were read have the form that their type promises."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin

from typing_extensions import get_type_hints, is_typeddict


def misfit(value: object, kind: Any, key: str = "") -> str | None:  # noqa: ANN401 (any type)
    """Return what does not fit, such as "energy.initial is missing"; None if all does.

    Parameters
    ----------
    value
        What was read from JSON.
    kind
        A `TypedDict`, whose keys must be there and others may be; a list, a dictionary, a union,
        literals, or a plain type. Whole numbers are numbers too.
    key
        Dotted path of the value.
    """
    return next(_misfits(value, kind, key), None)


def _misfits(value: object, kind: Any, key: str) -> Iterator[str]:  # noqa: ANN401 (as above)
    origin, name = get_origin(kind), key or "it"
    if origin in (Union, UnionType):
        some = [misfit(value, one, key) for one in get_args(kind)]
        if None not in some:
            yield str(some[0])
    elif is_typeddict(kind):
        if isinstance(value, Mapping):
            yield from _misfits_in(value, kind, key)
        else:
            yield f"{name} is no table"
    elif origin in (list, dict):
        if not isinstance(value, origin):
            yield f"{name} is no {'list' if origin is list else 'table'}"
            return
        members = value.items() if isinstance(value, dict) else enumerate(value)
        for place, member in members:
            yield from _misfits(member, get_args(kind)[-1], f"{key}.{place}".lstrip("."))
    elif origin is Literal:
        if value not in get_args(kind):
            yield f"{name} is {value!r:.40}"
    elif not isinstance(value, (int, float) if kind is float else kind):
        yield f"{name} is {value!r:.40}"


def _misfits_in(table: Mapping[str, object], kind: Any, key: str) -> Iterator[str]:  # noqa: ANN401
    for member, hint in get_type_hints(kind).items():
        place = f"{key}.{member}".lstrip(".")
        if member in table:
            yield from _misfits(table[member], hint, place)
        elif member in kind.__required_keys__:
            yield f"{place} is missing"
