"""What a study varies: a key of the case file and the values that it takes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import tomlkit
from tomlkit.exceptions import TOMLKitError

from carom.case.overrides import value_of
from carom.errors import InputError

MOST_VALUES = 100_000
"""Values of an axis, and points of a study, at the most."""


@dataclass(frozen=True)
class Axis:
    """A key and its values.

    Parameters
    ----------
    key
        Dotted key of the case file.
    values
        Its values, plain data as TOML has it.
    """

    key: str
    values: tuple[Any, ...]


def axis(text: str) -> Axis:
    """Read ``KEY=START:STOP:COUNT``, both ends included, or ``KEY=VALUE,VALUE,…``.

    Raises
    ------
    InputError
        The text is neither.
    """
    key, equals, said = (part.strip() for part in text.partition("="))
    if not (key and equals and said):
        raise InputError(
            f"--vary {text!r}: write KEY=START:STOP:COUNT or KEY=VALUE,VALUE,…, such as "
            "contact.friction=0:0.5:11"
        )
    ends = said.split(":")
    values = _between(key, ends) if len(ends) == 3 and '"' not in said else _listed(key, said)
    return Axis(key, tuple(values))


def _between(key: str, ends: list[str]) -> list[float]:
    """Return numbers at equal distances."""
    said = ":".join(ends)
    try:
        start, stop, count = float(ends[0]), float(ends[1]), int(ends[2])
    except ValueError:
        raise InputError(
            f"--vary {key}={said}: START and STOP are numbers, COUNT is an integer", key
        ) from None
    if not (np.isfinite([start, stop]).all() and 1 <= count <= MOST_VALUES):
        raise InputError(
            f"--vary {key}={said}: START and STOP must be finite, COUNT 1 to {MOST_VALUES}", key
        )
    # Rounded so that 0:0.5:11 has 0.15 and not 0.15000000000000002.
    return [float(f"{value:.12g}") for value in np.linspace(start, stop, count)]


def _listed(key: str, said: str) -> list[Any]:
    """Return the values of a list, which need not be quoted if they are bare words."""
    try:
        return list(tomlkit.value(f"[{said}]").unwrap())
    except (TOMLKitError, ValueError):
        return [value_of(key, word.strip()) for word in said.split(",")]
