"""How hard the pairs press at the times of the history, from what bodies do between its rows.

The momentum of a body changes by gravity, damping and the forces of those that it touches. Where it
touches one at a time their force is known, and with it the normal force of an obstacle, whose
normal is the same everywhere. Of two bodies the normals differ from place to place: the sum of the
normal forces is at least the resultant without what friction may add to it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.contact.obstacles import HalfSpace
from carom.auditing.model import AuditModel
from carom.auditing.records.rows import Rows
from carom.auditing.steps.scales import ROUND_OFF, SAFETY, Scales

PRESSED = 1e-6
"""Normal forces of pairs depend on normals, which are where the run's last correction was."""

Force = tuple[Array, float]
"""A force [N], shape [D], and how far it may be off [N]."""


class PressingOfRun:
    """Normal forces of pairs in all stages of a run.

    Parameters
    ----------
    stages
        Those of every stage, and the number of its first row among those of the run.
    total
        Normal forces of the rows of the run [N], shape [row_count].
    """

    def __init__(self, stages: Sequence[tuple[int, Pressing]], total: Array) -> None:
        self._stages, self.total = stages, total

    def bounds(self, row: int, active: Iterable[str]) -> dict[str, tuple[float, float]]:
        """Return for the pairs that may press at a row how hard, at least and at most [N]."""
        first, stage = self._at(row)
        return stage.bounds(row - first, active)

    def apart(self, row: int, active: Iterable[str]) -> dict[str, tuple[float, float]]:
        """Return the same without what the row says of their sum [N]."""
        first, stage = self._at(row)
        return stage.apart(row - first, active)

    def _at(self, row: int) -> tuple[int, Pressing]:
        # The row between two stages is of the first.
        return next((one for one in reversed(self._stages) if one[0] < row), self._stages[0])


class Pressing:
    """Normal forces of pairs in a stage.

    Parameters
    ----------
    model, scales
        The model and its magnitudes.
    rows
        The history.
    pairs
        Names of the pairs that have touched.
    stored
        For the times of stored steps [s] the normal forces of the pairs that press [N].
    """

    def __init__(
        self,
        model: AuditModel,
        scales: Scales,
        rows: Rows,
        pairs: Mapping[str, frozenset[str]],
        stored: Mapping[float, Mapping[frozenset[str], float]],
    ) -> None:
        self._model, self._scales, self._rows = model, scales, rows
        self._pairs, self._stored = pairs, stored
        self.total: Array = rows.history["normal_force"]
        self._bodies = {body.name: body for body in model.bodies}
        self._free = [body.name for body in model.bodies if not model.driven(body)]
        """Bodies that neither springs nor loads act on."""
        self._normals = {
            entry.name: obstacle.shape.normal
            for entry, obstacle in zip(model.scenario.obstacles, model.obstacles, strict=True)
            if isinstance(obstacle.shape, HalfSpace)
        }
        self._forces = {name: self._resultants(name) for name in self._bodies}

    def bounds(self, row: int, active: Iterable[str]) -> dict[str, tuple[float, float]]:
        """Return for the pairs that may press at a row how hard, at least and at most [N]."""
        total = float(self.total[row])
        if self._model.coheres:
            # Other pairs may pull, whatever the row says of the sum.
            return self.apart(row, active)
        off = PRESSED * total
        found = {name: (a, min(b, total)) for name, (a, b) in self.apart(row, active).items()}
        low, high = (sum(bound[side] for bound in found.values()) for side in (0, 1))
        return {
            name: (max(a, total - (high - b) - off), min(b, total - (low - a) + off))
            for name, (a, b) in found.items()
        }

    def apart(self, row: int, active: Iterable[str]) -> dict[str, tuple[float, float]]:
        """Return the same without what the row says of their sum [N]."""
        names = list(active)
        stored = self._stored.get(float(self._rows.times[row]))
        if stored is not None:
            off = PRESSED * abs(float(self.total[row]))
            forces = {name: stored.get(self._pairs[name], 0.0) for name in names}
            least = -np.inf if self._model.coheres else 0.0
            return {name: (max(f - off, least), f + off) for name, f in forces.items()}
        if self._model.coheres and len(self._pairs) == 1:
            total = float(self.total[row])
            off = PRESSED * abs(total)
            return dict.fromkeys(names, (total - off, total + off))
        found = dict.fromkeys(names, (-np.inf if self._model.coheres else 0.0, np.inf))
        for name, (force, error) in self.resultants(row, names).items():
            found[name] = self._normal_part(name, force, error)
        return found

    def resultants(self, row: int, active: Iterable[str]) -> dict[str, Force]:
        """Return the forces on the bodies of pairs, on the first by name, where they are known."""
        known: dict[str, Force] = {}
        if not self._rows.single[row] or self._model.massless or self._model.static:
            return known
        if self._model.condition == "midpoint" and any(b.rigid for b in self._bodies.values()):
            # What arrives with the end of a step has a reaction that no row has: it is small, but
            # where a whole body is in its way, not as small as round-off.
            return known
        unknown = set(active)
        # Of whatever touches only one more, that one's force is what is left.
        while True:
            for body in self._free:
                left = [name for name in unknown if body in self._pairs[name]]
                if len(left) == 1:
                    break
            else:
                return known
            force, error = self.rest(row, body, known)
            sign = 1.0 if body == self._first(left[0]) else -1.0
            known[left[0]] = (sign * force, error)
            unknown.discard(left[0])

    def rest(self, row: int, body: str, known: Mapping[str, Force]) -> Force:
        """Return what acts on a body at a row besides gravity, damping and known forces."""
        force, error = self._forces[body][0][row].copy(), float(self._forces[body][1][row])
        for name, (part, off) in known.items():
            if body in self._pairs[name]:
                force -= part if body == self._first(name) else -part
                error += off
        return force, error

    def _first(self, pair: str) -> str:
        return min(name for name in self._pairs[pair] if name in self._bodies)

    def _normal_part(self, pair: str, force: Array, error: float) -> tuple[float, float]:
        normals = [self._normals[name] for name in self._pairs[pair] if name in self._normals]
        if normals:
            normal = float(force @ normals[0])
            if self._model.coheres:
                return normal - error, normal + error
            return max(normal - error, 0.0), max(normal, 0.0) + error
        if self._model.coheres:
            return -np.inf, np.inf
        friction = max(
            (
                side.law.most
                for side in self._model.sides
                if {self._model.name(side.source), self._model.name(side.target)}
                == self._pairs[pair]
            ),
            default=0.0,
        )
        least = (float(np.linalg.norm(force)) - error) / float(np.hypot(1.0, friction))
        return max(least, 0.0), float("inf")

    def _resultants(self, name: str) -> tuple[Array, Array]:
        """Return m Δv/Δt − m g + α m v̄ of the steps that end at the rows, and how far it is off."""
        model, rows, body = self._model, self._rows, self._bodies[name]
        mass, damping = body.mass.total, body.law.mass_damping
        v = rows.drift(name)
        h = np.diff(rows.times, prepend=rows.times[0] - rows.dt)
        before = np.concatenate([v[:1], v[:-1]])
        # Damping knows nothing of impulses at the end of a step: velocities there are the scheme's.
        moved = np.diff(rows.centre(name), axis=0, prepend=rows.centre(name)[:1]) / h[:, None]
        scheme = (1 - 1 / model.theta) * before + moved / model.theta
        mean = (1 - model.xi) * before + model.xi * scheme
        force = mass * ((v - before) / h[:, None] - model.gravity + damping * mean)
        place = self._scales.displacement_in(h)
        off = place * (1 / h + damping) / (model.theta * h) + SAFETY * ROUND_OFF * (
            self._scales.speed / h
            + damping * (self._scales.speed + self._scales.reach / (model.theta * h))
        )
        return force, mass * off
