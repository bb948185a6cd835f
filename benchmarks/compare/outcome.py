"""What a run is asked for and what it hands back, between processes."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from compare.energy import Motion


@dataclass(frozen=True)
class Job:
    """A run of one code.

    Parameters
    ----------
    code
        Name of the module in `compare.codes`.
    problem
        Name of the problem.
    variant
        Which of the methods of the code; each knows its own.
    friction
        Coulomb's coefficient.
    steps
        How many steps, if not all.
    """

    code: str
    problem: str
    variant: str
    friction: float
    steps: int | None = None

    def __str__(self) -> str:
        return f"{self.code}, {self.variant}, μ = {self.friction:g}"


@dataclass(frozen=True)
class Outcome:
    """What a run took and did.

    Parameters
    ----------
    version
        Of the code.
    dofs
        Unknown displacements of the bodies, those of rigid walls left out.
    steps
        Steps done.
    seconds
        CPU time [s].
    motion
        Energies and velocities, by our own routine.
    exhausted
        Steps that took all the iterations that the code was allowed.
    """

    version: str
    dofs: int
    steps: int
    seconds: float
    motion: Motion
    exhausted: int = 0

    @property
    def milliseconds(self) -> float:
        """CPU time of a step [ms]."""
        return 1e3 * self.seconds / self.steps

    def write(self, file: Path) -> None:
        """Write it to a file."""
        file.write_text(json.dumps(asdict(self)), encoding="utf-8")

    @classmethod
    def read(cls, file: Path) -> Outcome:
        """Read it from a file."""
        data = json.loads(file.read_text(encoding="utf-8"))
        return cls(**{**data, "motion": Motion(**data["motion"])})
