"""Bodies of other codes on their way through time."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from carom import _carom
from carom.building.build import obstacle_surfaces
from carom.case.analysis import Conserving, Newton, Theta
from carom.case.contact import Contact
from carom.case.default_condition import with_default
from carom.case.obstacle import Obstacle
from carom.contact.model import check_names
from carom.errors import InputError
from carom.foreign.body import ForeignBody


@dataclass(frozen=True)
class ForeignStep:
    """What a step did.

    Parameters
    ----------
    friction, normal_contact, prescribed, scheme, defect
        Terms of the ledger in this step [J], as in `carom.Ledger`.
    certificate
        Distance from the laws of contact and friction [J].
    min_gap
        Smallest gap at the end among what took part [m]; infinite without contacts.
    pressing
        How many contacts press.
    iterations
        Newton's iterations.
    """

    friction: float
    normal_contact: float
    prescribed: float
    scheme: float
    defect: float
    certificate: float
    min_gap: float
    pressing: int
    iterations: int


class ForeignRun:
    """Bodies of other codes, taken through time by carom's own step.

    Parameters
    ----------
    bodies
        The bodies.
    obstacles
        Rigid obstacles.
    time_step
        Length of a step [s].
    contact
        The law of contact, as of a case, but by default with the condition ``midpoint``; not with
        ``massless``.
    scheme
        Time scheme.
    newton
        When the iterations of a step stop.

    Raises
    ------
    InputError
        If facets make no surface, a mass is not positive definite, or a value is out of range.
    """

    def __init__(
        self,
        bodies: Sequence[ForeignBody],
        obstacles: Sequence[Obstacle] = (),
        *,
        time_step: float,
        contact: Contact | None = None,
        scheme: Conserving | Theta | None = None,
        newton: Newton | None = None,
    ) -> None:
        if not (np.isfinite(time_step) and time_step > 0.0):
            raise InputError(f"time_step = {time_step:g}: must be greater than 0", "time_step")
        # Their mass is theirs, on the surface too.
        contact, newton = with_default("midpoint", contact or Contact()), newton or Newton()
        check_names([body.surface for body in bodies], obstacles, contact.pairs)
        dimensions = {body.points.shape[1] for body in bodies}
        if len(dimensions) > 1:
            raise InputError("bodies: some are in the plane and some in space", "bodies")
        self.time_step = time_step
        self._bodies = tuple(bodies)
        spec = {
            "obstacles": [obstacle.model_dump(mode="json") for obstacle in obstacles],
            "contact": contact.model_dump(mode="json"),
            "theta": 0.5,
            "scheme": (scheme or Conserving()).model_dump(mode="json"),
            "newton_tolerance": newton.tolerance,
            "newton_iterations": newton.max_iterations,
        }
        self._native = _carom.ForeignRun(
            json.dumps(spec), self._bodies, dimensions.pop(), obstacle_surfaces(obstacles)
        )

    def step(self) -> ForeignStep:
        """Take the bodies a step further.

        Raises
        ------
        ConvergenceError
            If the step does not converge; the bodies are where they were.
        InputError
            If a body answers with what cannot be.
        """
        return ForeignStep(**self._native.step(self.time_step))

    @property
    def time(self) -> float:
        """Time since the start [s]."""
        return self._native.time

    @property
    def law_time(self) -> float:
        """Wall time that the answers of the bodies have taken so far [s]."""
        return self._native.law_time

    @property
    def energy(self) -> float:
        """Kinetic and strain energy of all bodies [J]."""
        return float(self._native.energies.sum())

    @property
    def kinetic(self) -> float:
        """Kinetic energy of all bodies [J]."""
        return float(self._native.energies[0::2].sum())

    @property
    def strain(self) -> float:
        """Strain energy of all bodies [J]."""
        return float(self._native.energies[1::2].sum())

    def displacement(self, name: str) -> NDArray[np.float64]:
        """Return the displacements of the nodes of a body [m], shape [point_count, D]."""
        return self._of(name, "displacement")

    def velocity(self, name: str) -> NDArray[np.float64]:
        """Return the velocities of the nodes of a body [m/s], shape [point_count, D]."""
        return self._of(name, "velocity")

    def contact_force(self, name: str) -> NDArray[np.float64]:
        """Return the contact forces on the nodes of a body [N], shape [point_count, D]."""
        return self._of(name, "contact_force")

    def _of(self, name: str, what: str) -> NDArray[np.float64]:
        names = [body.name for body in self._bodies]
        if name not in names:
            raise InputError(f"{name!r}: there is no such body; known: {', '.join(names)}", "name")
        return self._native.state(names.index(name))[what]
