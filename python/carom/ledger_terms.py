"""The terms of the energy books [J].

Written by tools/make_ledger.py from ledger/terms.toml of the core.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

from typing_extensions import TypedDict

Book = Literal["run", "body", "pair"]
"""Whose energy is accounted for: that of the run as a whole, a body's, what a pair did."""


class Term(NamedTuple):
    """A term: its name, whose books have it, on which side of them it stands.

    ``stored = given − taken + defect``; reports show it by its label and in its colour.
    """

    name: str
    books: tuple[Book, ...]
    side: Literal["stored", "given", "taken"]
    label: str
    colour: str

    @property
    def sign(self) -> float:
        """Its sign in the defect."""
        return -1.0 if self.side == "given" else 1.0


TERMS = (
    Term("kinetic", ("run", "body"), "stored", "kinetic", "blue"),
    Term("strain", ("run", "body"), "stored", "strain", "orange"),
    Term("springs", ("run",), "stored", "springs", "sky"),
    Term("external", ("run", "body"), "given", "work of gravity and loads", "grey"),
    Term(
        "prescribed",
        ("run", "body", "pair"),
        "given",
        "work of supports, moving obstacles, growth",
        "brown",
    ),
    Term("contact", ("body",), "given", "received through contact", "sky"),
    Term("connections", ("body",), "given", "received through springs and dampers", "sky"),
    Term("friction", ("run", "pair"), "taken", "dissipated by friction", "green"),
    Term("viscous", ("run", "body"), "taken", "dissipated by damping and viscosity", "purple"),
    Term("dampers", ("run",), "taken", "dissipated by dampers", "purple"),
    Term("plastic", ("run", "body"), "taken", "dissipated by plastic flow", "red"),
    Term("scheme", ("run", "body"), "taken", "dissipated by the time scheme", "yellow"),
    Term("normal_contact", ("run", "pair"), "taken", "taken by normal reactions", "sky"),
    Term("settling", ("run", "pair"), "taken", "taken from closed contacts by damping", "purple"),
)
"""All terms, in the order of their columns."""


def terms(book: Book) -> tuple[Term, ...]:
    """Return the terms of a book."""
    return tuple(term for term in TERMS if book in term.books)


def names(book: Book) -> tuple[str, ...]:
    """Return the names of the terms of a book."""
    return tuple(term.name for term in terms(book))


@dataclass(frozen=True)
class Ledger:
    """What happened to the energy in a step, or since the start [J].

    Every term is computed from its own definition:
    ΔE_kinetic + ΔE_strain + ΔE_springs = external + prescribed − friction − viscous − dampers −
    plastic − scheme − normal_contact − settling + defect.

    Parameters
    ----------
    kinetic
        Change of kinetic energy.
    strain
        Change of strain energy.
    springs
        Change of the energy of springs.
    external
        Work of gravity and loads.
    prescribed
        Work of what is prescribed: motion, growth of bodies, interference that grows.
    friction
        Dissipated by friction: −Σ r_t·Δu_t ≥ 0.
    viscous
        Dissipated by damping and viscosity.
    dampers
        Dissipated by dampers: Σ c (ℓ₊ − ℓ)²/Δt ≥ 0.
    plastic
        Plastic work ∫ σ_y dα ≥ 0.
    scheme
        Dissipated by the time scheme's own algebra (θ, ξ > ½).
    normal_contact
        Taken by normal reactions: −Σ r_n Δu_n.
    settling
        Taken by damping from the velocities that closed contacts turn round in every step (θ = ½).
    """

    kinetic: float
    strain: float
    springs: float
    external: float
    prescribed: float
    friction: float
    viscous: float
    dampers: float
    plastic: float
    scheme: float
    normal_contact: float
    settling: float

    @property
    def defect(self) -> float:
        """What the other terms do not explain [J]."""
        return (
            self.kinetic
            + self.strain
            + self.springs
            - self.external
            - self.prescribed
            + self.friction
            + self.viscous
            + self.dampers
            + self.plastic
            + self.scheme
            + self.normal_contact
            + self.settling
        )


class RunTerms(TypedDict):
    """The terms of a run in a file [J]."""

    kinetic: float
    strain: float
    springs: float
    external: float
    prescribed: float
    friction: float
    viscous: float
    dampers: float
    plastic: float
    scheme: float
    normal_contact: float
    settling: float


class BodyTerms(TypedDict):
    """The terms of a body in a file [J]."""

    kinetic: float
    strain: float
    external: float
    prescribed: float
    contact: float
    connections: float
    viscous: float
    plastic: float
    scheme: float


class PairTerms(TypedDict):
    """The terms of a pair in a file [J]."""

    prescribed: float
    friction: float
    normal_contact: float
    settling: float
