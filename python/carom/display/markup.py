"""HTML that cannot be broken by what it holds: text is escaped unless it is already `Html`."""

from __future__ import annotations

import html
import json
import math
from collections.abc import Iterable
from typing import Any

VOID = frozenset({"br", "hr", "img", "input", "link", "meta"})
"""Elements without an end."""


class Html(str):
    """Markup that is escaped already."""

    __slots__ = ()


Child = str | Iterable[str] | None
"""Text, `Html`, several of them, or nothing."""


def element(tag: str, *children: Child, **attributes: str | bool | None) -> Html:
    """Return an element.

    Parameters
    ----------
    tag
        Its name.
    children
        What it holds; text that is not `Html` is escaped.
    attributes
        By name, with ``_`` for ``-`` and ``class_`` for ``class``; None and False are left out,
        True stands without a value.
    """
    stated = "".join(_attribute(name, value) for name, value in attributes.items())
    inside = join(*children)
    return Html(f"<{tag}{stated}>" if tag in VOID else f"<{tag}{stated}>{inside}</{tag}>")


def join(*children: Child) -> Html:
    """Return the children one after the other."""
    parts: list[str] = []
    for child in children:
        if child is None:
            continue
        for part in [child] if isinstance(child, str) else child:
            parts.append(part if isinstance(part, Html) else html.escape(part))
    return Html("".join(parts))


def _attribute(name: str, value: str | bool | None) -> str:
    if value is None or value is False:
        return ""
    name = name.rstrip("_").replace("_", "-")
    return f" {name}" if value is True else f' {name}="{html.escape(str(value))}"'


def number(value: float | None, key: str, *, digits: int = 6, unit: str = "") -> Html:
    """Return a number to read, with all its digits as the ``value`` of the element.

    Parameters
    ----------
    value
        The number; None, which JSON has in place of what is not finite, becomes a dash.
    key
        Dotted key of the number in ``summary.json``.
    digits
        Significant digits to show.
    unit
        Unit to show behind it.
    """
    if value is None:
        return element("span", "–", title="not a finite number")
    shown = element("data", format_number(value, digits), value=repr(value), data_key=key)
    return join(shown, element("span", f"\u202f{unit}", class_="unit") if unit else None)


def format_number(value: float, digits: int = 6) -> str:
    """Return a number with so many significant digits, with a true minus and powers of ten."""
    if isinstance(value, int):
        return f"{value:,}".replace(",", "\u202f").replace("-", "\u2212")
    if not math.isfinite(value):
        return str(value)
    text = f"{value:.{digits}g}"
    mantissa, _, exponent = text.partition("e")
    if exponent:
        mantissa += f"\u202f×\u202f10{_superscript(int(exponent))}"
    return mantissa.replace("-", "\u2212")


def _superscript(exponent: int) -> str:
    return str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def embedded(data: Any, *, id: str) -> Html:  # noqa: ANN401 (any JSON value)
    """Return data as JSON in an element that no text in it can end."""
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    for character in "<>&\u2028\u2029":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return Html(f'<script type="application/json" id="{html.escape(id)}">{text}</script>')
