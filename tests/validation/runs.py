"""Running cases and measuring them; shared by the tests and ``benchmarks/validate.py``."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom import Scenario
from carom.building.build import build

Array = NDArray[np.float64]

EXAMPLES = Path(__file__).parents[2] / "examples"
REFERENCE = Path(__file__).parent / "reference"


@dataclass(frozen=True)
class Run:
    """What a run gave.

    Parameters
    ----------
    history
        Columns of the history by title, SI units, each of shape [row_count].
    summary
        The native summary.
    wall
        Wall time [s].
    """

    history: dict[str, Array]
    summary: dict[str, Any]
    wall: float

    def energy(self, term: str) -> float:
        """Return a term of the summary's energies, relative to the initial energy."""
        energies: dict[str, float] = self.summary["energy"]
        return energies[term] / energies["initial"]

    def curve(self, column: str) -> Array:
        """Return an energy over time, relative to the initial energy, shape [row_count]."""
        relative: Array = self.history[column] / self.summary["energy"]["initial"]
        return relative

    @property
    def energy_change(self) -> float:
        """E(end) / E(0) − 1."""
        return self.energy("final") - 1.0

    @property
    def energy_rise(self) -> float:
        """Largest rise of the total energy above an earlier value, relative to E(0)."""
        return largest_rise(self.curve("total"))

    def rise_beyond_defect(self, *, until: float = np.inf) -> float:
        """Largest rise of the energy less the ledger's defect in the same interval, over E(0)."""
        explained = self.curve("total") - self.curve("defect")
        return largest_rise(explained[self.history["time"] <= until])


def simulate(scenario: Scenario) -> Run:
    """Run a scenario to its end without writing files."""
    start = time.perf_counter()
    simulation = build(scenario)
    while not simulation.advance(scenario.analysis.end_time, 1.0):
        pass
    simulation.finish()
    wall = time.perf_counter() - start
    columns = dict(zip(simulation.history_columns(), simulation.take_history().T, strict=True))
    return Run(history=columns, summary=simulation.summary(), wall=wall)


def example(name: str, *overrides: str) -> Scenario:
    """Return a case file of the examples with some values replaced, as ``--set`` does."""
    return Scenario.from_toml(EXAMPLES / name).with_overrides(overrides)


def theta_scheme(theta: float) -> str:
    """Return the override that sets θ = ξ."""
    return f'analysis.scheme={{kind="theta", theta={theta}, xi={theta}}}'


def reference(name: str) -> NDArray[Any]:
    """Read a reference table; its columns are addressed by title."""
    table: NDArray[Any] = np.genfromtxt(
        REFERENCE / f"{name}.csv", delimiter=",", names=True, dtype=None, encoding="utf-8"
    )
    return table


def relative_l2(values: Array, exact: Array) -> float:
    """Return |values − exact| / |exact| in the Euclidean norm over all samples."""
    return float(np.linalg.norm(values - exact) / np.linalg.norm(exact))


def largest_rise(values: Array) -> float:
    """Return the largest excess of a value over an earlier one."""
    return float(np.max(values - np.minimum.accumulate(values)))


def observed_order(sizes: Sequence[float], errors: Sequence[float]) -> float:
    """Return the exponent p of errors ∝ sizeᵖ, by least squares in logarithms."""
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def growth(values: Array, *, first: int = 1000) -> float:
    """Return the exponent p of max |values| ∝ stepᵖ from step `first` on, by least squares.

    Over the running maximum at steps spaced evenly in logarithms: ½ is a random walk, 1 a trend.
    """
    steps = np.unique(np.geomspace(first, len(values) - 1, 100).astype(int))
    largest = np.maximum.accumulate(np.abs(values))[steps]
    return float(np.polyfit(np.log(steps), np.log(largest), 1)[0])
