"""Spoiling valid input at random."""

from __future__ import annotations

import datetime
import random
from collections.abc import Callable, Iterator
from typing import Any

NUMBERS = (
    *(0, -0.0, 1, -1, 2, 3, 7, 0.5, 0.499999999, -0.25, 1e-3, 1e-9, 1e-30, 1e9, -1e9),
    *(5e-324, 1e-308, 1e308, -1e308, float("inf"), float("-inf"), float("nan")),
    *(10**6, 10**9, 10**12, 2**31, 2**32, 2**63, -(2**63), 10**30),
)

TEXTS = (
    *("", " ", "x", "all", "é", "\u202e", "a.b", "a/b", "../..", "\\", "nul\u0000", "\n", "{}"),
    *(
        "t",
        "1/0",
        "0/0",
        "sqrt(-t)",
        "t^t^t^t",
        "exp(exp(exp(exp(t))))",
        "((((",
        "1 +",
        "sin",
        "t t",
    ),
    *("(" * 5000, "-" * 5000 + "t", "x" * 10_000, "where(t, t)", "min()", "1e999", "step(t)*1e308"),
    *("finer", "gap", "massless", "mortar", "smooth", "faceted", "static", "dynamic", "theta"),
    *(
        "quad9",
        "tri6",
        "hex27",
        "tet10",
        "axisymmetric",
        "plane-stress",
        "mean-dilatation",
        "lumped",
    ),
    *("disc", "ring", "ball", "tube", "box", "plane", "sphere", "file", "surface"),
    *("neo-hookean", "j2-plasticity", "ogden", "blatz-ko", "yeoh", "uzawa", "admm"),
)

OTHERS = (
    *(
        True,
        False,
        [],
        {},
        [[]],
        [{}],
        [0, 0],
        [1, 1, 1],
        [float("nan")] * 2,
        ["x", 1],
        {"kind": 1},
    ),
    *(datetime.date(2026, 1, 1), datetime.time(12), {"a": {"b": {"c": []}}}, [[[[[[1]]]]]]),
    *({"kind": "disc"}, {"time": [0, 1], "value": [0, 1]}, {"time": [], "value": []}),
)

Place = tuple[Any, Any]
"""A table or list, and the key or index of an entry in it."""


def spoilt_data(data: dict[str, Any], pick: random.Random) -> None:
    """Spoil one to three places of a case in place."""
    for _ in range(pick.choice((1, 1, 1, 2, 3))):
        places = list(_places(data))
        if not places:
            return
        parent, key = pick.choice(places)
        pick.choice(_CHANGES)(parent, key, pick, places)


def _places(node: Any) -> Iterator[Place]:
    entries = node.items() if isinstance(node, dict) else enumerate(node)
    for key, value in list(entries):
        yield node, key
        if isinstance(value, dict | list):
            yield from _places(value)


def _other_value(parent: Any, key: Any, pick: random.Random, _: list[Place]) -> None:
    parent[key] = pick.choice(pick.choice((NUMBERS, TEXTS, OTHERS)))


def _other_number(parent: Any, key: Any, pick: random.Random, _: list[Place]) -> None:
    value = parent[key]
    if isinstance(value, int | float) and not isinstance(value, bool):
        factor = pick.choice((-1, 0, 0.5, 2, 10, 1e3, 1e-3, 1e6, 1e-6, 1e12, 1e-12))
        try:
            parent[key] = type(value)(value * factor)
        except (OverflowError, ValueError):
            parent[key] = 0
    else:
        parent[key] = pick.choice(NUMBERS)


def _removed(parent: Any, key: Any, _: random.Random, __: list[Place]) -> None:
    del parent[key]


def _misspelt(parent: Any, key: Any, pick: random.Random, _: list[Place]) -> None:
    if isinstance(parent, dict):
        at = pick.randrange(len(key) + 1)
        parent[key[:at] + pick.choice("abcxyz_-0.é") + key[at:]] = parent.pop(key)
    elif parent:
        parent.append(parent[key])


def _exchanged(parent: Any, key: Any, pick: random.Random, places: list[Place]) -> None:
    other, place = pick.choice(places)
    try:
        parent[key] = _copy(other[place])
    except (KeyError, IndexError):  # gone by an earlier change
        parent[key] = 0


def _repeated(parent: Any, key: Any, pick: random.Random, _: list[Place]) -> None:
    value = parent[key]
    if isinstance(value, list):
        parent[key] = [_copy(v) for v in value * pick.choice((0, 2, 3))]
    elif isinstance(parent, list):
        parent.insert(key, _copy(value))


def _copy(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _copy(member) for key, member in value.items()}
    return [_copy(member) for member in value] if isinstance(value, list) else value


_CHANGES: tuple[Callable[[Any, Any, random.Random, list[Place]], None], ...] = (
    *(_other_value, _other_value, _other_number, _other_number, _other_number),
    *(_removed, _misspelt, _exchanged, _repeated),
)


def spoilt_bytes(content: bytes, pick: random.Random) -> bytes:
    """Return a file with some of its bytes gone, flipped or put in."""
    content = bytearray(content)
    for _ in range(pick.choice((1, 1, 2, 4))):
        if not content:
            break
        at = pick.randrange(len(content))
        match pick.randrange(7):
            case 0:
                del content[at:]
            case 1 | 2:
                content[at] ^= 1 << pick.randrange(8)
            case 3:
                del content[at : at + pick.choice((1, 4, 64, 1024))]
            case 4:
                content[at:at] = pick.randbytes(pick.choice((1, 4, 64)))
            case 5:
                content[at:at] = pick.choice(
                    (b"[" * 3000, b"{" * 3000, b"-", b"9" * 20, b"nan", b"\n", b'"""', b"a=1\n")
                )
            case 6:
                lines = bytes(content).split(b"\n")
                line = pick.randrange(len(lines))
                lines[line : line + 1] = pick.choice(([], [lines[line]] * 2, [b""]))
                content = bytearray(b"\n".join(lines))
    return bytes(content)
