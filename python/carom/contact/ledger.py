"""Where the energy of contact goes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass
class PairWork:
    """What the reactions of a pair did, in joules.

    Parameters
    ----------
    friction
        Taken by friction, −Σ r_t·Δu_t ≥ 0.
    normal_contact
        Taken by normal reactions, −Σ r_n Δu_n.
    prescribed
        Work of what is prescribed: of obstacles that move, and of held unknowns that are pressed.
    """

    friction: float = 0.0
    normal_contact: float = 0.0
    prescribed: float = 0.0

    def add(self, other: PairWork) -> None:
        """Add what happened in a step."""
        self.friction += other.friction
        self.normal_contact += other.normal_contact
        self.prescribed += other.prescribed


@dataclass(frozen=True)
class Step:
    """What a step of your loop came to, as far as contact is concerned.

    Parameters
    ----------
    work
        What all reactions did [J].
    pairs
        The same pair by pair.
    certificate
        Distance from the laws of contact and friction, the sum of the bi-potential gaps [J].
    min_gap
        Smallest gap at the end among what took part [m]; infinite without contacts.
    pressing
        How many contacts press.
    velocity_change
        By how much impulses of landing change the velocities of your unknowns [m/s], shape
        [dof_count]; None without a mass. Their work is part of the books.
    """

    work: PairWork
    pairs: Mapping[tuple[str, str], PairWork]
    certificate: float
    min_gap: float
    pressing: int
    velocity_change: NDArray[np.float64] | None = None


@dataclass
class Ledger:
    """The books of contact over your loop, in joules.

    With kinetic and strain energy your own, energy is kept where their change, plus `friction` and
    `normal_contact`, less `prescribed` and the work of your loads, is zero.

    Parameters
    ----------
    work
        What all reactions did since the start.
    pairs
        The same pair by pair.
    certificate
        Largest distance of a step from the laws [J].
    min_gap
        Smallest gap so far [m].
    steps
        Steps that were added.
    """

    work: PairWork = field(default_factory=PairWork)
    pairs: dict[tuple[str, str], PairWork] = field(default_factory=dict)
    certificate: float = 0.0
    min_gap: float = float("inf")
    steps: int = 0

    def add(self, step: Step) -> None:
        """Add a step that was accepted."""
        self.work.add(step.work)
        for pair, work in step.pairs.items():
            self.pairs.setdefault(pair, PairWork()).add(work)
        self.certificate = max(self.certificate, step.certificate)
        self.min_gap = min(self.min_gap, step.min_gap)
        self.steps += 1

    @property
    def friction(self) -> float:
        """Energy taken by friction [J]."""
        return self.work.friction

    @property
    def normal_contact(self) -> float:
        """Energy taken by normal reactions [J]."""
        return self.work.normal_contact

    @property
    def prescribed(self) -> float:
        """Work of what is prescribed [J]."""
        return self.work.prescribed
