"""The rows of the history and the steps between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from carom.auditing.arrays import AXES, Array, components, turning_components
from carom.auditing.model import AuditModel

GRID = 1e-6
"""Times closer than this part of a step are the same to the run."""


class Rows:
    """The history by rows, and how many steps were made for each.

    Parameters
    ----------
    model
        The model.
    history, summary
        What ``history.csv`` and ``summary.json`` say.
    """

    def __init__(
        self, model: AuditModel, history: Mapping[str, Array], summary: Mapping[str, Any]
    ) -> None:
        self.history, self.model = history, model
        self._axes = AXES[: model.dimension]
        self.times: Array = history["time"]
        self.dt = model.analysis.time_step
        self.nominal = np.zeros(len(self.times))
        """Nominal steps since the row before, none for the first, [row_count]."""
        self.nominal[1:] = np.maximum(np.ceil(np.diff(self.times) / self.dt - GRID), 1.0)
        # A step that fails becomes two halves, each of which may fail: one step more each time.
        self.steps: Array = self.nominal + history["retried_steps"]
        """Steps since the row before, NaN where that is not known, [row_count]."""
        if model.static:
            # What had to be halved goes on in halves until they are easy.
            since = np.diff(self.times, prepend=model.stage.start_time)
            shortest = (1.0 - GRID) * np.minimum(self.dt, since)
            self.steps[history["shortest_step"] < shortest] = np.nan
        if model.stabilised:
            # Nor how many steps with inertia it took where load steps failed.
            self.steps[history["retried_steps"] > 0] = np.nan
        if model.stage.velocities:
            # Nothing says of the row before what bodies were given after it.
            self.steps[1:2] = np.nan
        self.steps[:1] = 0.0
        if summary["status"] == "failed" and history["retried_steps"][-1] > 0:
            self.steps[-1] = np.nan  # the last failures made no steps
        self.single = self.steps == 1.0
        """Whether one step led from the row before to this one, [row_count]."""
        self.complete = bool(self.single[1:].all())
        """Whether every step has a row."""

    @classmethod
    def joined(
        cls, parts: Sequence[Rows], history: Mapping[str, Array], summary: Mapping[str, Any]
    ) -> Rows:
        """Return the rows of a run from those of its stages, which share the rows between them."""
        whole = cls(parts[-1].model, history, summary)
        for name in ("nominal", "steps", "single"):
            own = [getattr(part, name)[number > 0 :] for number, part in enumerate(parts)]
            setattr(whole, name, np.concatenate(own))
        whole.complete = all(part.complete for part in parts)
        return whole

    @property
    def certified(self) -> Array:
        """How far the steps of every row may be from the laws of contact [J], [row_count]."""
        certified: Array = np.fmax(self.steps, 1.0) * self.history["certificate"]
        return certified

    def __len__(self) -> int:
        return len(self.times)

    def at(self, time: float) -> int | None:
        """Return the row of a time [s], if there is one."""
        found = np.flatnonzero(self.times == time)
        return int(found[0]) if len(found) else None

    def drift(self, name: str) -> Array:
        """Return the velocities of the centre of a body [m/s], shape [row_count, D]."""
        return self._vectors(*(f"{name}.v_{axis}" for axis in self._axes))

    def centre(self, name: str) -> Array:
        """Return the places of the centre of a body [m], shape [row_count, D]."""
        return self._vectors(*(f"{name}.{axis}" for axis in self._axes))

    def turning(self) -> Array:
        """Return how fast the body turns that turns fastest [rad/s], shape [row_count]."""
        spins = [
            self._vectors(*turning_components(f"{body.name}.spin", len(self._axes)))
            for body in self.model.bodies
        ]
        fastest: Array = np.max([np.linalg.norm(spin, axis=1) for spin in spins], axis=0)
        return fastest

    @property
    def momentum(self) -> Array:
        """Momentum [kg m/s], shape [row_count, D]."""
        return self._vectors(*components("momentum", len(self._axes)))

    @property
    def angular_momentum(self) -> Array:
        """That about the origin [kg m²/s], shape [row_count, 1] or [row_count, 3]."""
        return self._vectors(*turning_components("angular_momentum", len(self._axes)))

    def _vectors(self, *columns: str) -> Array:
        return np.stack([self.history[column] for column in columns], axis=1)
