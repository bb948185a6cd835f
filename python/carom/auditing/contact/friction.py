"""Friction as the auditor sees it: what a law says of speed, distance, pressure and age."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.functions.formula import Formula
from carom.case.friction import (
    Friction,
    FrictionFormula,
    OrthotropicFriction,
    RateAndState,
    StaticKinetic,
)


@dataclass(frozen=True)
class Slide:
    """How contacts slide in a step, each of shape [count].

    Parameters
    ----------
    speed
        Mean speed of slip [m/s].
    distance
        How far they have slid in the middle of the step [m], whichever way.
    pressure
        Normal reaction per area of the reference configuration [Pa].
    age
        Age in the middle of the step [s].
    """

    speed: Array
    distance: Array
    pressure: Array
    age: Array


class Law:
    """Friction of a pair: a coefficient, or a law.

    Parameters
    ----------
    given
        What the case says.
    """

    def __init__(self, given: Friction) -> None:
        self.grain = given if isinstance(given, OrthotropicFriction) else None
        """What the case says of directions, if there are two with laws of their own."""
        self.directions: tuple[Law, Law] = (self, self)
        """The laws of both directions."""
        if isinstance(given, OrthotropicFriction):
            self.directions = (Law(given.along), Law(given.across))
        self._given = given
        self._formula = Formula(given.formula) if isinstance(given, FrictionFormula) else None
        names = self._formula.names() if self._formula else set()
        self.constant = isinstance(given, float | int)
        """Whether it is a coefficient, or one of each direction."""
        by_distance = isinstance(given, StaticKinetic) and given.distance is not None
        self.ages = isinstance(given, RateAndState)
        """Whether it knows how old a contact is."""
        self.remembers = "s" in names or by_distance or self.ages
        """Whether it depends on what happened before a step."""
        self.bounded = self._formula is None
        """Whether the law is between what it says of the least and the most of distance and age."""
        self.presses = "p" in names
        """Whether it depends on the pressure."""
        if self.grain is not None:
            both = self.directions
            self.constant = all(law.constant for law in both)
            self.remembers = any(law.remembers for law in both)
            self.bounded = all(law.bounded for law in both)
            self.presses = any(law.presses for law in both)

    @property
    def holding(self) -> float | None:
        """μ up to which a contact holds that sticks, where it jumps to less as it slides."""
        given = self._given
        if not isinstance(given, StaticKinetic) or given.static is None:
            return None
        jumps = given.speed is None and given.distance is None and given.static != given.kinetic
        return given.static if jumps else None

    @property
    def new_age(self) -> float:
        """The age of a contact that is new [s]."""
        given = self._given
        if not isinstance(given, RateAndState):
            return 0.0
        return given.distance / given.speed if given.age is None else given.age

    def aged(self, age: Array, speed: Array, dt: float) -> Array:
        """Return ages [s] after a time at a constant speed [m/s]: θ' = 1 − v θ/D."""
        given = self._given
        if not isinstance(given, RateAndState):
            return age
        rate = speed / given.distance
        sliding = rate > 0
        decay = np.exp(-rate * dt)
        grown = np.where(sliding, -np.expm1(-rate * dt) / np.where(sliding, rate, 1.0), dt)
        return age * decay + grown

    def coefficient(self, slide: Slide) -> Array:
        """Return μ of contacts that slide like this, shape [count]."""
        given, v = self._given, slide.speed
        if isinstance(given, float | int):
            return np.full(len(v), float(given))
        if isinstance(given, RateAndState):
            older = slide.age * given.speed / given.distance
            direct = given.direct * np.log1p(v / given.speed)
            return given.reference + direct + given.evolution * np.log1p(older)
        if isinstance(given, StaticKinetic):
            left = np.zeros(len(v))
            if given.speed is not None:
                left = np.exp(-v / given.speed)
            elif given.distance is not None:
                left = np.maximum(1.0 - slide.distance / given.distance, 0.0)
            static = given.kinetic if given.static is None else given.static
            return given.kinetic + (static - given.kinetic) * left + given.viscous * v
        assert self._formula is not None
        found = self._formula(v=v, s=slide.distance, p=slide.pressure)
        return np.broadcast_to(found, v.shape)

    def extremes(self, slide: Slide, time: float) -> list[Slide]:
        """Return between what contacts slide of which nothing is known, at a time [s] of the run.

        All laws but formulas change one way with distance and age.
        """
        nothing = np.zeros(len(slide.speed))
        oldest = np.full(len(nothing), self.new_age + time)
        return [
            replace(slide, distance=nothing, age=oldest),
            replace(slide, distance=nothing + np.inf, age=nothing),
        ]

    @property
    def fixed(self) -> float:
        """μ of one direction where it is a coefficient, else NaN."""
        return float(self._given) if isinstance(self._given, float | int) else np.nan

    @property
    def most(self) -> float:
        """The largest μ that there can be; infinite where the law has no bound."""
        if self.grain is not None:
            return max(law.most for law in self.directions)
        given = self._given
        if isinstance(given, float | int):
            return float(given)
        if isinstance(given, StaticKinetic) and given.viscous == 0.0:
            return max(given.kinetic, given.static or 0.0)
        return np.inf
