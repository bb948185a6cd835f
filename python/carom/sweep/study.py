"""A study: every combination of the values of its axes, each with its folder."""

from __future__ import annotations

import hashlib
import itertools
import json
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from carom.case.scenario import Scenario
from carom.errors import InputError
from carom.io import layout
from carom.io.summary import read_summary
from carom.sweep.axis import MOST_VALUES, Axis

LONGEST_NAME = 100
"""Characters of a folder's name, above which it is cut and told apart by a digest."""


@dataclass(frozen=True)
class Point:
    """One run of a study.

    Parameters
    ----------
    values
        What the axes are here, by key.
    scenario
        The case with these values.
    directory
        Where its results are.
    """

    values: dict[str, Any]
    scenario: Scenario
    directory: Path

    def finished(self) -> dict[str, Any] | None:
        """Return the summary, if this has been run to an end that will not change.

        Raises
        ------
        InputError
            The directory has the results of another case.
        """
        try:
            case = (self.directory / layout.CASE).read_text(encoding="utf-8")
        except OSError:
            return None
        if case != self.scenario.to_toml(complete=True):
            raise InputError(
                f"{self.directory}: has results of another case; choose another --out, or replace "
                "them by --force"
            )
        try:
            summary = read_summary(self.directory / layout.SUMMARY)
        except (OSError, ValueError):
            return None
        return summary if summary.get("status") in layout.ENDED else None


def points(scenario: Scenario, axes: Sequence[Axis], out: Path) -> list[Point]:
    """Make the points of a study; the last axis varies fastest.

    Raises
    ------
    InputError
        A key is not known or given twice, a value is not allowed, or there are too many points.
    """
    keys = [axis.key for axis in axes]
    if twice := [key for key in keys if keys.count(key) > 1]:
        raise InputError(f"--vary {twice[0]}: is given twice; give all its values in one", twice[0])
    count = math.prod(len(axis.values) for axis in axes)
    if count > MOST_VALUES:
        raise InputError(f"--vary: {count} runs are more than {MOST_VALUES}; take fewer values")
    return list(_points(scenario, axes, out))


def _points(scenario: Scenario, axes: Sequence[Axis], out: Path) -> Iterator[Point]:
    for combination in itertools.product(*(axis.values for axis in axes)):
        values = {axis.key: value for axis, value in zip(axes, combination, strict=True)}
        yield Point(values, scenario.with_values(values), out / folder(values))


def folder(values: dict[str, Any]) -> str:
    """Return a name for the results at some values, such as ``friction=0.1``."""
    said = "_".join(f"{key.rpartition('.')[2]}={_word(value)}" for key, value in values.items())
    plain = re.sub(r"[^\w.=+-]", "-", said)
    keys = [key.rpartition(".")[2] for key in values]
    if plain == said and len(plain) <= LONGEST_NAME and len(set(keys)) == len(keys):
        return plain
    digest = hashlib.sha256(json.dumps(values, default=str).encode()).hexdigest()[:8]
    return f"{plain[:LONGEST_NAME]}-{digest}"


def _word(value: object) -> str:
    return value if isinstance(value, str) else json.dumps(value, default=str)
