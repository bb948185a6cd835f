"""What contacts do to the energy in a step, each by its reaction and its motion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from carom.auditing.arrays import Array, einsum, turned_with
from carom.auditing.steps.contacts import Contacts
from carom.auditing.steps.states import States
from carom.auditing.steps.touching import Touching
from carom.ledger_terms import names


@dataclass(frozen=True)
class ContactWork:
    """What contacts do to the energy in a step [J], each of shape [count].

    Parameters
    ----------
    found
        The contacts.
    terms
        Those of the ledger of pairs.
    whole
        With a blend of stresses: friction less prescribed, had the reactions the whole weight.
    doubt
        How sure friction is.
    """

    found: Contacts
    terms: Mapping[str, Array]
    whole: Array
    doubt: Array


class Works:
    """The work of the contacts of a step.

    Parameters
    ----------
    states, touching
        The states of the step, and what touches in it.
    """

    def __init__(self, states: States, touching: Touching) -> None:
        self._states, self._touching = states, touching

    @cached_property
    def all(self) -> list[ContactWork]:
        """The work of the reactions at the end of the step, then of those at its start.

        Each counts as much as the scheme lets it.
        """
        work = list(self.rubbing) if self._states.model.blended else []
        for found in self.booked():
            w_n, w_t = found.relative(self._states.d, found.shift)
            doubt = np.zeros(len(found))
            if self._states.starts_elsewhere and self._states.uses_start:
                # Where the contacts of the start were is not stored.
                doubt = np.linalg.norm(found.reaction, axis=1) * self._states.motion
            work.append(
                ContactWork(
                    found=found,
                    terms={
                        "friction": -einsum("ki,ki->k", found.friction_force, w_t),
                        "normal_contact": -found.normal_force * (w_n - found.widening),
                        "prescribed": found.driven(self._states.held_d, found.shift)
                        + found.normal_force * found.widening,
                    },
                    whole=np.zeros(len(found)),
                    doubt=doubt,
                )
            )
        if self._states.model.blended and not self._states.model.mixed:
            return work
        return [*work, *self._impulse_work()]

    def _impulse_work(self) -> list[ContactWork]:
        """Return the work of impulses at the end of the step, by the mean of v before and after.

        Those of landing act first.
        """
        landing, settling = self._touching.impulses
        before, after = self._states.v_scheme, self._states.v1
        landed = self._landed(landing, settling)
        works = []
        for found, mean, normal, across in (
            (landing, 0.5 * (before + landed), "normal_contact", "friction"),
            (settling, 0.5 * (landed + after), "settling", "settling"),
        ):
            v_n, v_t = found.relative(mean, found.velocity)
            terms = dict.fromkeys(names("pair"), np.zeros(len(found)))
            terms[normal] = terms[normal] - self._states.dt * found.normal_force * v_n
            rubbed = einsum("ki,ki->k", found.friction_force, v_t)
            terms[across] = terms[across] - self._states.dt * rubbed
            driven = found.driven(self._states.held_v, found.velocity)
            terms["prescribed"] = self._states.dt * driven
            nothing = np.zeros(len(found))
            works.append(ContactWork(found=found, terms=terms, whole=nothing, doubt=nothing))
        return works

    def _landed(self, landing: Contacts, settling: Contacts) -> Array:
        """Return the velocities between the impulses of landing and those of settling [m/s]."""
        states = self._states
        if not landing.reaction.any():
            return states.v_scheme
        if not settling.reaction.any():
            return states.v1
        landed: Array = states.v_scheme.copy()
        forces = landing.nodal_forces(len(states.model.points))
        for index, body in enumerate(states.model.bodies):
            impulse = states.dt * forces[body.span]
            if not body.known:
                landed[body.span] = np.nan
            elif body.moves_as_a_whole:
                landed[body.span] += states.whole(body).accelerated(impulse)
            else:
                held = states.model.supports[index].held
                landed[body.span] += body.accelerated(impulse, held)
        return landed

    @property
    def doubt(self) -> float:
        """How sure the work of contacts is [J]."""
        return sum(float(work.doubt.sum()) for work in self.all)

    def booked(self) -> list[Contacts]:
        """Return the contacts whose work is booked one by one, with what of them counts."""
        model, touching = self._states.model, self._touching
        if model.blended:
            return [touching.moved] if model.mixed else []
        if model.static:
            # Normal reactions grow with the motion; what slides does so at the limit of friction.
            return [touching.pressed.weighted(0.5, 1.0), touching.first.weighted(0.5, 0.0)]
        if not model.massless:
            return [touching.pressed]
        xi = model.xi
        ends = [touching.balanced.weighted(xi, xi), touching.first.weighted(1 - xi, 1 - xi)]
        return [*ends, touching.moved]

    @cached_property
    def rubbing(self) -> list[ContactWork]:
        """What friction, μ r̄_n |w_t|, and obstacles do, r̄ = (½ − α) r₀ + (½ + α) r₁.

        Slip is measured in the frame of the end. Where a contact has no reaction there, it is not
        stored whether the run measured it there or, with the contact out of reach, at the start.
        """
        ended = {key: k for k, key in enumerate(self._touching.balanced.keys)}
        d, balanced = self._states.d, self._touching.balanced
        end_slip = _slip(balanced, d)
        late = self._touching.find(self._states.start, 1.0, like=self._touching.at_start)
        late = late.only(late.massless) if self._states.model.mixed else late
        frames = (late, self._touching.first)
        moved, left = (_slip(found, d) for found in frames)
        # In the frame of the end obstacles do their work too, where they are round.
        normals = late.normal.copy()
        for k, key in enumerate(self._touching.first.keys):
            if key in ended:
                moved[k] = left[k] = end_slip[ended[key]]
                normals[k] = balanced.normal[ended[key]]
        held = self._states.held_d
        first = self._touching.first
        by_end = balanced.driven(held, balanced.shift)
        by_end = by_end + balanced.normal_force * balanced.widening
        by_start = _turned_to(first, normals).driven(held, first.shift)
        by_start = by_start + first.normal_force * first.widening
        blend = np.append(self._states.blend, 0.0)  # the last is of nodes of no body
        work = []
        for sign, found, slip, off, driven in (
            (1.0, balanced, end_slip, np.zeros(len(end_slip)), by_end),
            (-1.0, first, moved, np.abs(moved - left), by_start),
        ):
            share = 0.5 + sign * blend[found.source]
            force = found.friction.largest * found.normal_force
            work.append(
                ContactWork(
                    found=found,
                    terms={
                        "friction": share * force * slip,
                        "normal_contact": np.zeros(len(found)),
                        "prescribed": share * driven,
                    },
                    whole=force * slip - driven,
                    doubt=np.maximum(share, 0.5) * np.abs(force) * off,
                )
            )
        return work


def _turned_to(found: Contacts, normals: Array) -> Contacts:
    """Return contacts whose reactions have turned to these normals."""
    reaction = turned_with(found.reaction, found.normal, normals)
    return replace(found, reaction=reaction, normal=normals)


def _slip(found: Contacts, motion: Array) -> Array:
    """Return how far contacts slide in a motion, by what resists it [m], shape [count]."""
    return found.friction.slip(found.relative(motion, found.shift)[1])
