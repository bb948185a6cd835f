"""What an audit found: checks by name, each with its largest figure and its tolerance."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.table import Table
from rich.text import Text

from carom.auditing.catalogue import CHECKS
from carom.display.tables import two_columns

Values = float | NDArray[np.float64] | Iterable[float]


@dataclass
class Check:
    """One thing that was checked, at as many places as it could be.

    Parameters
    ----------
    name
        What it is called.
    statement
        What must hold.
    unit
        Unit of figure and tolerance.
    figure, tolerance
        The largest deviation in terms of its tolerance, and that tolerance.
    where
        Where that was.
    count
        How many numbers were compared.
    """

    name: str
    statement: str
    unit: str
    figure: float = 0.0
    tolerance: float = 0.0
    where: str = ""
    count: int = 0
    _ratio: float = field(default=-1.0, repr=False)

    @property
    def confirmed(self) -> bool:
        """Whether no figure is above its tolerance; what is not a number is."""
        return bool(self._ratio <= 1.0)

    def note(self, figures: Values, tolerances: Values, where: str) -> None:
        """Take note of deviations and what they may be at most, in the same unit."""
        figure = np.abs(np.asarray(figures, dtype=np.float64))
        tolerance = np.asarray(tolerances, dtype=np.float64)
        if figure.shape != tolerance.shape:
            figure, tolerance = np.broadcast_arrays(figure, tolerance)
        figure, tolerance = figure.ravel(), tolerance.ravel()
        if len(figure) == 0:
            return
        self.count += len(figure)
        # 0 is within any tolerance, also within 0.
        ratio = figure / np.where(tolerance > 0, tolerance, 1e-300)
        ratio[figure == 0.0] = 0.0
        ratio[np.isnan(ratio)] = np.inf
        worst = int(ratio.argmax())
        if ratio[worst] > self._ratio:
            self._ratio = float(ratio[worst])
            self.figure, self.tolerance = float(figure[worst]), float(tolerance[worst])
            self.where = where

    def as_dict(self) -> dict[str, Any]:
        """Return the check as plain data."""
        plain = asdict(self)
        del plain["_ratio"]
        return {**plain, "confirmed": self.confirmed}


@dataclass(frozen=True)
class Unchecked:
    """Something that cannot be checked from what is stored.

    Parameters
    ----------
    what
        What it is.
    numbers
        The numbers that are believed, as file and key.
    store
        What a run has to store so that they can be checked; nothing where that is not enough.
    """

    what: str
    numbers: tuple[str, ...] = ()
    store: str = ""

    def __str__(self) -> str:
        return f"{self.what}: store {self.store}" if self.store else self.what


@dataclass(frozen=True)
class Audit:
    """What an audit of a results directory found.

    Parameters
    ----------
    path
        The directory.
    checks
        The checks made.
    figures
        Figures that nothing is asked of: name, value, unit.
    unchecked
        What could not be checked.
    """

    path: Path
    checks: tuple[Check, ...]
    figures: tuple[tuple[str, float, str], ...]
    unchecked: tuple[Unchecked, ...]

    @property
    def confirmed(self) -> bool:
        """Whether every check is."""
        return all(check.confirmed for check in self.checks)

    @property
    def refuted(self) -> tuple[Check, ...]:
        """The checks that failed."""
        return tuple(check for check in self.checks if not check.confirmed)

    @property
    def verdict(self) -> str:
        """How many checks hold, how many do not, and how much could not be checked."""
        refuted, left = len(self.refuted), len(self.unchecked)
        parts = [f"{len(self.checks) - refuted} confirmed"]
        if refuted:
            parts.append(f"{refuted} refuted")
        if left:
            parts.append(f"{left} cannot be checked from what is stored")
        return ", ".join(parts)

    def as_dict(self) -> dict[str, Any]:
        """Return everything as plain data."""
        return {
            "directory": str(self.path),
            "confirmed": self.confirmed,
            "checks": [check.as_dict() for check in self.checks],
            "figures": [
                {"name": name, "value": value, "unit": unit} for name, value, unit in self.figures
            ],
            "unchecked": [asdict(left) for left in self.unchecked],
        }

    def __rich__(self) -> Table:
        table = Table(title=Text(f"Audit of {self.path}"), title_justify="left")
        table.add_column("")
        table.add_column("check", no_wrap=True)
        table.add_column("largest", justify="right", no_wrap=True)
        table.add_column("allowed", justify="right", no_wrap=True)
        table.add_column("numbers", justify="right")
        for check in self.checks:
            table.add_row(
                Text(
                    "ok" if check.confirmed else "NO", style="green" if check.confirmed else "red"
                ),
                Text(check.name),
                Text(f"{check.figure:.2g} {check.unit}".strip()),
                Text(f"{check.tolerance:.2g}"),
                Text(str(check.count)),
            )
        return table

    def remarks(self) -> Table | None:
        """Return figures and what was not checked as a table, if there is any."""
        if not (self.figures or self.unchecked):
            return None
        table = two_columns("Reported")
        for name, value, unit in self.figures:
            table.add_row(Text(name), Text(f"{value:.4g} {unit}".strip()))
        for left in self.unchecked:
            table.add_row(Text("not checked"), Text(str(left)))
        return table


class Findings:
    """Gathers checks while an audit goes."""

    def __init__(self) -> None:
        self._checks: dict[str, Check] = {}
        self._figures: dict[str, tuple[float, str]] = {}
        self._unchecked: dict[str, Unchecked] = {}

    def check(self, name: str, figures: Values, tolerances: Values, where: str) -> None:
        """Note deviations of the check `name`; see `Check.note`."""
        if name not in self._checks:
            statement, unit = CHECKS[name]
            self._checks[name] = Check(name=name, statement=statement, unit=unit)
        self._checks[name].note(figures, tolerances, where)

    def report(self, name: str, value: float, unit: str) -> None:
        """Report a figure of which the largest counts."""
        largest = self._figures.get(name, (0.0, unit))[0]
        self._figures[name] = (max(largest, abs(value)), unit)

    def leave(self, what: str, *numbers: str, store: str = "") -> None:
        """Say what was not checked, which numbers that leaves, and what to store to change that."""
        before = self._unchecked.get(what, Unchecked(what, store=store))
        kept = dict.fromkeys((*before.numbers, *numbers))
        self._unchecked[what] = Unchecked(what, tuple(kept), before.store)

    def audit(self, path: Path) -> Audit:
        """Return what was found."""
        made = {name: check for name, check in self._checks.items() if check.count}
        return Audit(
            path=path,
            checks=tuple(made[name] for name in CHECKS if name in made),
            figures=tuple((name, value, unit) for name, (value, unit) in self._figures.items()),
            unchecked=tuple(self._unchecked.values()),
        )
