"""How far two runs are apart: case, outcome, and every column of the history."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.comparing.case import Change, changes
from carom.errors import InputError
from carom.ledger_terms import names
from carom.results.result import Result

ENERGIES = frozenset(
    (*names("run"), "total", "defect", "step_defect", "translation", "rotation", "vibration")
)
"""Columns of the history that are energies, of the whole or, after a point, of a body [J]."""

OUTCOME = ("status", "end_time", "steps", "newton_iterations", "retried_steps")
"""Of the summary, before its energies."""


@dataclass(frozen=True)
class Apart:
    """How far a column of the history is apart.

    Parameters
    ----------
    column
        Its title.
    largest
        The largest difference, second less first, with its sign; in the unit of the column.
    share
        Its size in terms of the largest value that either run has in the column, of an energy in
        terms of the largest energy of either. 0 where all is zero.
    time
        When [s].
    """

    column: str
    largest: float
    share: float
    time: float


@dataclass(frozen=True)
class Comparison:
    """Two runs side by side.

    Parameters
    ----------
    first, second
        Their results.
    """

    first: Result
    second: Result

    @cached_property
    def case(self) -> tuple[Change, ...]:
        """What differs in the case, every default written out."""
        return changes(self.first.scenario, self.second.scenario)

    @cached_property
    def outcome(self) -> tuple[Change, ...]:
        """What came of both, alike or not: steps, energies [J], depth, the first contact."""
        a, b = (dict(_outcome(one.summary)) for one in (self.first, self.second))
        return tuple(Change(key, a.get(key), b.get(key)) for key in dict.fromkeys((*a, *b)))

    @cached_property
    def energy(self) -> float:
        """The largest energy of either history [J]."""
        energies = [c for c in self.columns if _is_energy(c)]
        return max((_largest(one) for c in energies for one in self.over_time(c)), default=0.0)

    @cached_property
    def columns(self) -> tuple[str, ...]:
        """The columns that both histories have, without the time."""
        return tuple(c for c in self.first.history if c in self.second.history and c != "time")

    @cached_property
    def history(self) -> tuple[Apart, ...]:
        """How far every column of both is apart, the farthest by its share first.

        At the rows of the first run that the second has reached; between its rows the second is
        taken to be linear.
        """
        found = [self._apart(column) for column in self.columns]
        return tuple(sorted(found, key=lambda apart: -apart.share))

    def over_time(self, column: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return a column of the first run, and of the second at the same times.

        Parameters
        ----------
        column
            The title of a column that both have.

        Raises
        ------
        InputError
            They have none of that title.
        """
        if column not in self.columns:
            known = ", ".join(self.columns)
            raise InputError(f"{column!r} is no column of both histories; these are: {known}")
        times, theirs = self.times, self.second.history
        return (
            self.first.history[column][: len(times)],
            np.interp(times, theirs["time"], theirs[column]),
        )

    @cached_property
    def times(self) -> NDArray[np.float64]:
        """The times of the rows that are compared [s], shape [row_count]."""
        own, other = self.first.history["time"], self.second.history["time"]
        reached = other[-1] * (1 + 1e-12) if len(other) else -np.inf
        return own[own <= reached]

    def _apart(self, column: str) -> Apart:
        a, b = self.over_time(column)
        if not len(a):
            return Apart(column, 0.0, 0.0, 0.0)
        # A column may be without a value, as the gap where nothing is near.
        known = np.isfinite(a) & np.isfinite(b)
        difference = np.where(known, b - a, np.where(np.isfinite(a) == np.isfinite(b), 0.0, np.inf))
        at = int(np.abs(difference).argmax())
        size = self.energy if _is_energy(column) else max(_largest(a), _largest(b))
        largest = float(difference[at])
        share = abs(largest) / size if size else (np.inf if largest else 0.0)
        return Apart(column, largest, float(share), float(self.times[at]))


def compare(first: Result | str | Path, second: Result | str | Path) -> Comparison:
    """Compare two runs: what differs in their cases, and how far their results are apart.

    Parameters
    ----------
    first, second
        Results, or the directories where they are.

    Returns
    -------
    Comparison
        Of both.

    Raises
    ------
    InputError
        A directory holds no results of a run that has ended.
    """
    a, b = (one if isinstance(one, Result) else Result.open(one) for one in (first, second))
    return Comparison(a, b)


def _is_energy(column: str) -> bool:
    return column.rpartition(".")[2] in ENERGIES


def _largest(values: NDArray[np.float64]) -> float:
    return float(np.abs(values[np.isfinite(values)]).max(initial=0.0))


def _outcome(summary: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    for key in OUTCOME:
        yield key, summary.get(key)
    for key, value in summary["energy"].items():
        yield f"energy.{key}", value
    yield "min_gap", summary.get("min_gap")
    worst = (summary.get("penetration") or {}).get("worst") or {}
    yield "penetration", worst.get("depth")
    contacts = summary.get("contacts") or []
    yield "contacts", len(contacts)
    if contacts:
        event = contacts[0]
        for key in ("onset", "release", "peak_force", "friction_work"):
            yield f"first contact.{key}", event.get(key)
        for key in ("restitution", "tangential_restitution"):
            yield f"first contact.{key}", (event.get("impact") or {}).get(key)
