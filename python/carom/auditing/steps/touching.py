"""The contacts of a step: those it started with, those it ended with, and their impulses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

from carom.auditing.arrays import Array, turned_with
from carom.auditing.bodies.body import AuditBody
from carom.auditing.steps import contacts
from carom.auditing.steps.contacts import Contacts
from carom.auditing.steps.finding import find
from carom.auditing.steps.states import States


class Touching:
    """What touches in a step.

    Parameters
    ----------
    states
        The states of the step.
    """

    def __init__(self, states: States) -> None:
        self._states = states

    @cached_property
    def all(self) -> Contacts:
        """The contacts of the step, where the condition is written, with their whole reactions."""
        written = 1.0 if self._states.model.condition in ("gap", "massless") else 0.5
        found = self.find(self._states.end, written)
        if not self._states.model.mixed:
            return found
        return found.placed(found.massless, self.find(self._states.end, 0.5))

    @cached_property
    def impulses(self) -> list[Contacts]:
        """The same contacts at the end of the step.

        Their reactions are the parts that are impulses there: those of landing, and of settling.
        """
        at_end = self.find(self._states.end, 1.0, like=self.all)
        impulses = (self._states.landing, self._states.settling)
        return [replace(at_end, reaction=reaction) for reaction in impulses]

    @cached_property
    def pressed(self) -> Contacts:
        """The contacts of the step with the reactions that bore its motion."""
        return self.all.less(self.impulses)

    @property
    def whole_force(self) -> tuple[Array, Array]:
        """r_n and r_t with impulses, each part in its own frame [N], [count] and [count, D].

        What impulses have of r_t is turned into the frame of the step.
        """
        pressed = self.pressed
        normal, across = pressed.normal_force, pressed.friction_force
        for part in self.impulses:
            normal = normal + part.normal_force
            across = across + turned_with(part.friction_force, part.normal, pressed.normal)
        return normal, across

    @cached_property
    def start_gaps(self) -> Array:
        """Gaps of the contacts of the step at its start [m], shape [count]."""
        return self.find(self._states.end, 0.0, like=self.all).gap

    def impulse(self, body: AuditBody) -> Array:
        """Return the impulses on the nodes of a body at the end of the step [N s]."""
        forces = contacts.all_forces(self.impulses, len(self._states.model.points))
        impulse: Array = self._states.dt * forces[body.span]
        return impulse

    @cached_property
    def first(self) -> Contacts:
        """The contacts that the step started with, where the start of the step is.

        Only those of pairs without mass have a part in the step, if there are others.
        """
        found = self.at_start
        return found.only(found.massless) if self._states.model.mixed else found

    @cached_property
    def at_start(self) -> Contacts:
        """The contacts of the state at the start of the step, where that is."""
        return self.find(self._states.start, 0.0)

    @cached_property
    def balanced(self) -> Contacts:
        """The contacts of the step whose pairs have a side without mass."""
        return self.pressed.only(self.pressed.massless)

    @cached_property
    def moved(self) -> Contacts:
        """The others, whose pairs are ruled by the motion."""
        return self.pressed.only(~self.pressed.massless)

    def find(
        self, state: Mapping[str, Any], weight: float, *, like: Contacts | None = None
    ) -> Contacts:
        """Return the contacts of a state as they are at this part of the step."""
        time = float(self._states.start["time"]) + weight * self._states.dt
        position = self._states.position(weight)
        step = (float(self._states.start["time"]), self._states.time)
        model = self._states.model
        in_time = model.dimension == 2 and not model.static
        begun = self._states.position(0.0) if in_time else None
        return find(model, state, position, time, step=step, like=like, begun=begun)
