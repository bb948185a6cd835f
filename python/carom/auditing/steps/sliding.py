"""The friction coefficients of the contacts of a step, by the laws of their pairs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from carom.auditing.arrays import Array, Mask, sizes
from carom.auditing.contact.friction import Law, Slide
from carom.auditing.contact.holding import OF_BONDS
from carom.auditing.model import AuditModel
from carom.auditing.steps.bearing import bearing_area
from carom.auditing.steps.contacts import Contacts
from carom.auditing.steps.ruled import Ruled
from carom.auditing.steps.scales import Scales
from carom.auditing.steps.step import Step

Key = tuple[int, ...]
"""What tells a contact from others."""


@dataclass(frozen=True)
class Record:
    """What a contact brings to a step.

    Parameters
    ----------
    distance
        How far it has slid since the start of the run [m].
    age
        Its age [s].
    """

    distance: float
    age: float


@dataclass(frozen=True)
class Coefficients:
    """Between what both μ of each contact are, each of shape [count, 2].

    Parameters
    ----------
    least, most
        The same where the law is known; apart where a contact may hold more than resists it as it
        slides, or where what happened before the step is not stored.
    whole
        Up to which the whole reaction, with impulses at the end of the step, may be across.
    doubt
        How far these may be off, as motion and pressure are known.
    """

    least: Array
    most: Array
    whole: Array
    doubt: Array

    @property
    def fixed(self) -> Mask:
        """Where μ is a number, [count]."""
        fixed: Mask = ((self.doubt == 0.0) & (self.least == self.most)).all(axis=1)
        return fixed


class Sliding:
    """Follows contacts from step to step, as far as steps are stored.

    Parameters
    ----------
    model, scales
        The model and its magnitudes.
    """

    def __init__(self, model: AuditModel, scales: Scales) -> None:
        self._model, self._scales = model, scales
        self._records: dict[Key, Record] = {}
        self._time = model.stage.start_time
        self._off = 0.0
        self.known = model.scenario.initial is None or model.scenario.initial.result is None
        """Whether every step since the start of the run was stored."""

    def go_on(self, before: Sliding) -> None:
        """Take over what contacts bring from the stage before."""
        self._records, self._off = before._records, before._off
        self._time, self.known = before._time, before.known

    def coefficients(self, step: Step, ruled: Ruled) -> Coefficients:
        """Return the coefficients in a step, which follows the one before that was asked about."""
        self.known = self.known and float(step.start["time"]) == self._time
        found = step.touching.pressed
        out = Coefficients(*(np.zeros((len(found), 2)) for _ in range(4)))
        for law, mine in _by_law(found):
            for direction, own in enumerate(law.directions):
                if own.constant:
                    for coefficient in (out.least, out.most, out.whole):
                        coefficient[mine, direction] = own.fixed
                    continue
                parts = (out.least, out.most, out.whole, out.doubt)
                for part, values in zip(parts, self._of_law(own, step, ruled, mine), strict=True):
                    part[mine, direction] = values
        for coefficient, of_bonds in (
            *((one, OF_BONDS) for one in (out.least, out.most, out.whole)),
            (out.doubt, 0.0),
        ):
            coefficient[found.bonds] = of_bonds
        self._follow(step, ruled)
        return out

    def _of_law(
        self, law: Law, step: Step, ruled: Ruled, mine: Mask
    ) -> tuple[Array, Array, Array, Array]:
        """Return least, most, whole and doubt of the contacts of a law."""
        off = self._scales.geometry(step)
        found = step.touching.pressed
        slip, rate = sizes(ruled.slip[mine]), ruled.rate[mine]
        speed = sizes(ruled.across[mine]) * rate
        known = [self._records.get(key) for key in found.only(mine).keys]
        before = [Record(0.0, law.new_age) if record is None else record for record in known]
        slide = Slide(
            speed=speed,
            distance=np.array([record.distance for record in before]) + 0.5 * slip,
            pressure=pressures(step)[mine] if law.presses else np.zeros(len(slip)),
            age=law.aged(np.array([record.age for record in before]), speed, 0.5 * step.dt),
        )
        ends = [slide]
        if law.remembers and not self.known:
            if not law.bounded:
                nothing, all_of_it = np.zeros(len(slip)), np.full(len(slip), np.inf)
                return nothing, all_of_it, all_of_it, nothing
            ends = law.extremes(slide, step.time)
        values = np.array([law.coefficient(end) for end in ends])
        near = [law.coefficient(other) for end in ends for other in self._near(end, step, rate)]
        doubt = np.abs(np.array(near) - np.repeat(values, len(near) // len(values), axis=0))
        least, most = values.min(axis=0), values.max(axis=0)
        whole = most
        if law.holding is not None:
            # What slides has the kinetic coefficient; what sticks may have held more.
            most = np.where(slip <= off, law.holding, most)
            whole = np.full(len(slip), law.holding)
        return least, most, whole, doubt.max(axis=0)

    def _near(self, slide: Slide, step: Step, rate: Array) -> Iterator[Slide]:
        """Yield how contacts may have slid as the run evaluated them."""
        off = self._scales.geometry(step)
        pressure = slide.pressure * (1.0 + off / self._model.size)
        pressure = pressure + self._pressing(step)
        for sign in (-1.0, 1.0):
            yield replace(slide, speed=np.maximum(slide.speed + sign * off * rate, 0.0))
            far = np.maximum(slide.distance + sign * (off + self._off), 0.0)
            yield replace(slide, distance=far)
            yield replace(slide, pressure=slide.pressure + sign * (pressure - slide.pressure))
            older = off * rate * step.time + self._off * rate
            yield replace(slide, age=np.maximum(slide.age * (1.0 + sign * older), 0.0))

    def _pressing(self, step: Step) -> float:
        """Return how far pressures may be off [Pa]: normal forces, over the smallest facet."""
        total = float(np.abs(step.touching.pressed.reaction).sum())
        areas = [body.facet_areas.min() for body in self._model.bodies if len(body.facets)]
        return self._scales.reaction(step, total) / float(min(areas))

    def _follow(self, step: Step, ruled: Ruled) -> None:
        """Take note of what a step leaves."""
        found = step.touching.pressed
        self._time, self._off = step.time, self._off + self._scales.geometry(step)
        for k, key in enumerate(found.keys):
            side = found.side[k]
            if side is None or not side.law.remembers:
                continue
            before = self._records.get(key, Record(0.0, side.law.new_age))
            speed = sizes(ruled.across[k : k + 1]) * ruled.rate[k]
            age = float(side.law.aged(np.array([before.age]), speed, step.dt)[0])
            self._records[key] = Record(before.distance + float(sizes(ruled.slip[k])), age)


def pressures(step: Step) -> Array:
    """Return the pressures of the contacts of a step at their nodes [Pa], shape [count].

    They are what all contacts between the same two solids press on a node with, over the area of
    the reference configuration around it, of facets that face the contact; the mean of several.
    """
    found, model = step.touching.pressed, step.model
    loads: dict[tuple[int, frozenset[int]], float] = {}
    for k in range(len(found)):
        force = max(float(found.normal_force[k]), 0.0)
        between = frozenset((int(found.source[k]), int(found.target[k])))
        for node, share in (*found.borne(k), *found.passed_on(k)):
            loads[node, between] = loads.get((node, between), 0.0) + share * force
    position = step.position(0.0)
    out = np.zeros(len(found))
    for k in range(len(found)):
        between = frozenset((int(found.source[k]), int(found.target[k])))
        for node, share in found.borne(k):
            area, _ = bearing_area(model, int(found.source[k]), node, found.normal[k], position)
            out[k] += share * loads[node, between] / area
    return out


def _by_law(found: Contacts) -> Iterator[tuple[Law, Mask]]:
    """Yield the laws of contacts, each with its contacts."""
    laws = {id(side): side.law for side in found.side if side is not None}
    for number, law in laws.items():
        yield law, np.array([id(side) == number for side in found.side], dtype=bool)
