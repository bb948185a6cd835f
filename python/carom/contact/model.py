"""What may touch what in somebody else's time loop."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom import _carom
from carom.building.build import obstacle_surfaces
from carom.case.contact import Contact, FrictionSolver, Pair
from carom.case.obstacle import Obstacle
from carom.contact.contacts import Candidates, Contacts
from carom.contact.ledger import PairWork, Step
from carom.contact.mass import Mass
from carom.contact.surface import Surface
from carom.errors import InputError
from carom.friction.arrays import numbers, shown, vectors
from carom.messages import known


class ContactModel:
    """Surfaces of your bodies and rigid obstacles, and what may touch what.

    It knows one step at a time: what it found, the reactions so far, and those of the step before,
    from which the next one starts. All positions are those of your points, by your numbers.

    Parameters
    ----------
    points
        Your nodes without deformation [m], shape [point_count, D], D = 2 or 3. Those on surfaces
        count.
    surfaces
        The boundary of each body that may touch others.
    obstacles
        `carom.Plane`, `carom.RigidSphere` and the others; they may move.
    condition
        Where in time contact is ruled, as in `carom.Contact`: ``gap``, at the end of the step,
        never penetrates; ``midpoint`` rules the increment of the step, and lands nodes on their
        targets; ``endpoint`` the velocity at its end. What normal reactions take on landing with
        ``midpoint`` is given back by impulses, as in a run of carom, where there is a mass; without
        it that stays in the books.
    friction
        Coulomb's coefficient of pairs that do not state their own.
    pairs
        What single pairs do differently.
    targets, discretisation, sources, solver
        As in `carom.Contact`.
    theta
        θ of your time scheme, the weight of the new velocity in d = Δt ((1 − θ) v + θ v₊), which
        ``endpoint`` has to know. None: load steps without inertia, with the condition ``gap``.
    dofs
        Your number of the unknown of each node and component, shape [point_count, D]; -1 where
        motion is prescribed. Without it component i of node n is D n + i.
    dof_count
        How many unknowns there are; without it one more than the largest number.
    mass
        Your mass M [kg], for the impulses of ``midpoint``: what is on its diagonal, shape
        [dof_count]; a matrix of shape [dof_count, dof_count], NumPy or scipy.sparse; or a function
        or ``LinearOperator`` that multiplies with it. It couples no two surfaces.

    Raises
    ------
    InputError
        If arrays do not fit, facets make no surface, or a value is out of range.
    """

    def __init__(
        self,
        points: ArrayLike,
        surfaces: Sequence[Surface],
        obstacles: Sequence[Obstacle] = (),
        *,
        condition: str = "gap",
        friction: float = 0.0,
        pairs: Sequence[Pair] = (),
        targets: str = "smooth",
        discretisation: str = "node-to-segment",
        sources: str | None = None,
        solver: FrictionSolver | None = None,
        theta: float | None = 0.5,
        dofs: ArrayLike | None = None,
        dof_count: int | None = None,
        mass: Any = None,  # noqa: ANN401 (an array, a matrix, a function)
    ) -> None:
        self._shape = _points(points)
        reference = vectors("points", points, contacts=self._shape[0], dimension=self._shape[1])
        self.dofs = self._numbered(dofs)
        self.dof_count = self._counted(dof_count)
        contact = Contact(
            condition=condition,
            friction=friction,
            pairs=tuple(pairs),
            targets=targets,
            discretisation=discretisation,
            sources=sources,
            solver=solver or FrictionSolver(),
        )
        check_names(surfaces, obstacles, pairs)
        self._moving = [o.name for o in obstacles if o.velocity is not None or o.motion is not None]
        self._needs_velocity = condition == "endpoint"
        spec = {
            "obstacles": [obstacle.model_dump(mode="json") for obstacle in obstacles],
            "contact": contact.model_dump(mode="json"),
            "theta": theta,
        }
        self._native = _carom.PlantedContact(
            json.dumps(spec),
            reference,
            [(surface.name, surface.facets, surface.self_contact) for surface in surfaces],
            self.dofs < 0,
            obstacle_surfaces(obstacles),
        )
        self._known_names: dict[int, tuple[str, str]] = {}
        self._mass: Mass | None = None
        if mass is not None:
            self._mass = Mass(mass, self.dofs, self.dof_count, surfaces)
        self._searches = self._evaluations = 0
        self._is_searched = self._is_evaluated = self._is_solved = False

    @property
    def time(self) -> float:
        """Time since the first step [s], for obstacles that move as functions of it."""
        return self._native.time

    def search(
        self,
        points: ArrayLike,
        *,
        velocity: ArrayLike | None = None,
        time_step: float | None = None,
        reach: float | None = None,
    ) -> Candidates:
        """Start a step, and find what may touch in it.

        Parameters
        ----------
        points
            Where the nodes are at the start [m], shape [point_count, D].
        velocity
            Their velocities there [m/s], shape [point_count, D], by which they are predicted to
            move on; without it they stay.
        time_step
            Length of the step [s]. It goes with a velocity and with obstacles that move.
        reach
            How far around the predicted way things are looked for [m]. Without it twice as far as
            anything moves, as in a run of carom.

        Raises
        ------
        InputError
            If arrays do not fit, or neither a velocity nor a reach says how far to look.
        """
        at = self._vectors("points", points)
        moving = np.zeros(self._shape) if velocity is None else self._vectors("velocity", velocity)
        for name, value in (("time_step", time_step), ("reach", reach)):
            if value is not None and not (np.isfinite(value) and value > 0.0):
                raise InputError(f"{name} = {value:g}: must be greater than 0", name)
        if time_step is None and (velocity is not None or self._moving):
            what = f"obstacle {self._moving[0]!r} moves" if self._moving else "there is a velocity"
            raise InputError(
                f"time_step is missing, and {what}: give the length of the step [s]", "time_step"
            )
        if velocity is None and (reach is None or self._needs_velocity):
            raise InputError(
                "velocity is missing: give it with time_step, so that it is known "
                + (
                    "what the condition rules"
                    if self._needs_velocity
                    else "how far to look, or give reach"
                ),
                "velocity",
            )
        self._native.search(at, moving, time_step or 1.0, reach)
        self._is_searched, self._is_evaluated, self._is_solved = True, False, False
        self._searches += 1
        return Candidates(self._native.count, self._searches)

    def evaluate(self, candidates: Candidates, points: ArrayLike) -> Contacts:
        """Evaluate what takes part in the step at a guess of its end.

        Parameters
        ----------
        candidates
            As the last search found them.
        points
            Where the nodes are thought to be at the end of the step [m], shape [point_count, D].
            Gaps are those at the end, or half way there, as the condition is written.

        Raises
        ------
        InputError
            If the candidates are those of an earlier search, or arrays do not fit.
        """
        if not self._is_searched or candidates.number != self._searches:
            raise InputError(
                f"candidates are of search {candidates.number}, and the last is "
                f"{self._searches}: search at the start of each step",
                "candidates",
            )
        found = self._native.evaluate(self._vectors("points", points))
        self._evaluations += 1
        self._is_evaluated, self._is_solved = True, not len(found["gap"])
        return Contacts(
            pair=tuple(self._names(k) for k in found["pair"].tolist()),
            node=found["node"],
            gap=found["gap"],
            frame=found["frame"],
            friction=found["mu"],
            offset=found["offset"],
            guess=found["guess"],
            starts=found["starts"],
            nodes=found["nodes"],
            weights=found["weights"],
            _model=self,
            _number=self._evaluations,
        )

    def missed(self, points: ArrayLike) -> Candidates | None:
        """Find what went through its target unforeseen in a step that has converged.

        With the condition ``endpoint`` it is what arrives and has to be stopped in this step.

        Parameters
        ----------
        points
            Where the nodes are at the end of the step [m], shape [point_count, D].

        Returns
        -------
        None if nothing was missed. Otherwise what takes part from now on: iterate on with that.

        Raises
        ------
        ConvergenceError
            If that has happened eight times in the step.
        InputError
            If there was no search, or arrays do not fit.
        """
        self._refuse_unless(
            self._is_evaluated, "nothing was evaluated in this step: search and evaluate first"
        )
        if not self._native.missed(self._vectors("points", points)):
            return None
        self._is_evaluated = self._is_solved = False
        self._searches += 1
        return Candidates(self._native.count, self._searches)

    def accept(
        self,
        points: ArrayLike,
        *,
        velocity: ArrayLike | None = None,
        reactions: ArrayLike | None = None,
    ) -> Step:
        """End the step: keep its reactions for the next one, and book what they did.

        Parameters
        ----------
        points
            Where the nodes are at the end of the step [m], shape [point_count, D].
        velocity
            How fast they are there [m/s], shape [point_count, D], if there is a mass: add
            ``Step.velocity_change`` to the velocities of your unknowns.
        reactions
            Those of the contacts as last evaluated [N], shape [n, D], if you have solved for them
            yourself; without it those of `solve`.

        Raises
        ------
        InputError
            If contacts were not solved for, or arrays do not fit.
        """
        self._refuse_unless(
            self._is_evaluated, "nothing was evaluated in this step: search and evaluate first"
        )
        at = self._vectors("points", points)
        if (velocity is None) != (self._mass is None):
            raise InputError(
                "velocity and mass go together: give the model a mass, and accept the velocity at "
                "the end of the step",
                "velocity",
            )
        moving = None if velocity is None else (self._vectors("velocity", velocity), self._mass)
        if reactions is not None:
            self._native.set_reactions(numbers("reactions", reactions))
        else:
            self._refuse_unless(
                self._is_solved, "the contacts have no reactions: solve first, or give reactions"
            )
        done = self._native.accept(at, moving)
        change = None if self._mass is None else self._mass.change(done["landed"])
        self._is_searched = self._is_evaluated = self._is_solved = False
        columns = zip(done["friction"], done["normal_contact"], done["prescribed"], strict=True)
        pairs = {self._names(k): PairWork() for k in self._native.all_pairs()}
        whole = PairWork()
        for k, column in zip(done["pair"].tolist(), columns, strict=True):
            pairs[self._names(k)] = work = PairWork(*map(float, column))
            whole.add(work)
        measured = (done["certificate"], done["min_gap"], done["pressing"])
        return Step(whole, pairs, *measured, velocity_change=change)

    def _names(self, number: int) -> tuple[str, str]:
        """Return the names of the two solids of a pair by its number."""
        if number not in self._known_names:
            a, b = self._native.pair_names(number) or ("", "")
            self._known_names[number] = (a, b)
        return self._known_names[number]

    def native_at(self, contacts: Contacts) -> Any:  # noqa: ANN401 (the native object)
        """Return the native side of contacts that are the last ones evaluated.

        Raises
        ------
        InputError
            If they are not.
        """
        if contacts._number != self._evaluations or not self._is_evaluated:
            raise InputError(
                "contacts are not those that were last evaluated: evaluate, then solve", "contacts"
            )
        return self._native

    def has_reactions(self) -> None:
        """Take note that the contacts are solved for."""
        self._is_solved = True

    def _vectors(self, name: str, values: ArrayLike) -> NDArray[np.float64]:
        array = numbers(name, values)
        if array.shape != self._shape:
            raise InputError(
                f"{name} has shape {shown(array.shape)}; must be {shown(self._shape)}, one row for "
                "each point",
                name,
            )
        return array

    def _numbered(self, dofs: ArrayLike | None) -> NDArray[np.int64]:
        if dofs is None:
            return np.arange(self._shape[0] * self._shape[1], dtype=np.int64).reshape(self._shape)
        array = np.asarray(dofs)
        if array.shape != self._shape or array.dtype.kind not in "iu":
            raise InputError(
                f"dofs has shape {shown(array.shape)} and type {array.dtype}; must be integers of "
                f"shape {shown(self._shape)}, one for each point and component",
                "dofs",
            )
        return np.ascontiguousarray(array, dtype=np.int64)

    def _counted(self, dof_count: int | None) -> int:
        least = int(self.dofs.max(initial=-1)) + 1
        if dof_count is not None and dof_count < least:
            raise InputError(
                f"dof_count = {dof_count}: dofs has {least - 1}; must be at least {least}",
                "dof_count",
            )
        return least if dof_count is None else dof_count

    @staticmethod
    def _refuse_unless(holds: bool, message: str) -> None:
        if not holds:
            raise InputError(message, "contacts")


def _points(points: ArrayLike) -> tuple[int, int]:
    shape = np.shape(points)
    if len(shape) != 2 or shape[1] not in {2, 3} or not shape[0]:
        raise InputError(
            f"points has shape {shown(shape)}; must be [point_count, 2] or [point_count, 3]",
            "points",
        )
    return shape


def check_names(
    surfaces: Sequence[Surface], obstacles: Sequence[Obstacle], pairs: Sequence[Pair]
) -> None:
    """Refuse names that are there twice or not at all, and what pairs cannot have here."""
    names: dict[str, None] = {}
    for thing in (*surfaces, *obstacles):
        if thing.name in names:
            raise InputError(f"{thing.name!r} is the name of two surfaces or obstacles", "surfaces")
        names[thing.name] = None
    if not surfaces:
        raise InputError(
            "surfaces: there is none; give the boundary of one body at least", "surfaces"
        )
    for index, pair in enumerate(pairs):
        key = f"pairs.{index}"
        for name in pair.between:
            if name not in names:
                raise InputError(f"{key}.between: {name!r}: {known(name, names)}", f"{key}.between")
        refused: Mapping[str, object] = {
            "interference": pair.interference,
            "restitution": pair.restitution,
            "cohesion": pair.cohesion,
            "resolve_overlap": pair.resolve_overlap,
        }
        for what, value in refused.items():
            if value is not None:
                raise InputError(
                    f"{key}.{what}: only runs of carom have it; leave it out", f"{key}.{what}"
                )
