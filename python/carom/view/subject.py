"""What pictures and films are of: the bodies of a run, in the colours of a field."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from numbers import Real
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.case.scenario import Scenario
from carom.display.time_unit import TimeUnit, time_unit
from carom.errors import InputError
from carom.io import layout
from carom.io.frames import Frames
from carom.results.result import Result, read_case
from carom.view.colouring import Colouring, chosen, colourings
from carom.view.connections import Connections, connections
from carom.view.outline import Outline, outline

LEAST_FORCE = 2e-3
"""Of the largest force that is drawn: smaller ones are none."""


MOST_MAGNIFIED = 1e15
"""By what displacements can be multiplied; beyond it nothing of the bodies can be made out."""


@dataclass(frozen=True)
class Subject:
    """What is drawn.

    Parameters
    ----------
    frames
        The file with the bodies.
    seen
        What of them is seen.
    scenario
        The case, for its obstacles.
    attached
        Springs, dampers and point masses.
    colouring
        What gives the colours; None tells bodies apart.
    magnification
        What displacements are multiplied by; 0 draws the reference configuration.
    edges
        Whether the edges of cells are drawn.
    reactions
        Whether the contact reactions are drawn.
    smooth
        Whether what is known per face is drawn as if it were continuous: as the mean of the faces
        around each point.
    """

    frames: Frames
    seen: Outline
    scenario: Scenario
    attached: Connections
    colouring: Colouring | None
    magnification: float = 1.0
    edges: bool = True
    reactions: bool = False
    smooth: bool = False

    @property
    def is_flat(self) -> bool:
        """Whether it is in the plane."""
        return self.scenario.dimension == 2

    @property
    def unit(self) -> TimeUnit:
        """The unit in which times are told."""
        return time_unit(float(self.frames.times[-1]))

    def caption(self, frame: int) -> str:
        """Return the time of a frame, to three digits and as many as the run's last time needs."""
        return f"t = {self.unit.text(float(self.frames.times[frame]), 4)}"

    def positions(self, frame: int) -> NDArray[np.float64]:
        """Return where the points that are seen are drawn [m], shape [point_count, D]."""
        moved = self.magnification * self.frames.field("displacement", frame)
        where = self.frames.points + np.nan_to_num(moved)
        return np.asarray(where[self.seen.points, : self.scenario.dimension])

    def places(self, frame: int) -> NDArray[np.float64]:
        """Return where springs and point masses are drawn [m], as of `Connections.places`."""
        if not self.attached:
            return self.attached.drawn
        return self.attached.drawn + self.magnification * self.attached.moved(frame)

    def forces(self, frame: int) -> NDArray[np.float64]:
        """Return the contact reactions at the points that are seen [N], shape [point_count, D]."""
        if "reaction" not in self.frames.names:
            return np.zeros((len(self.seen.points), self.scenario.dimension))
        taken = self.frames.field("reaction", frame)
        return np.asarray(taken[self.seen.points, : self.scenario.dimension])

    def everything(self, frame: int) -> NDArray[np.float64]:
        """Return where bodies, springs and point masses are drawn [m], shape [count, D]."""
        return np.concatenate([self.positions(frame), self.places(frame)])

    def largest_force(self, frames: Iterable[int]) -> float:
        """Return the size of the largest contact reaction [N]."""
        return max((float(np.linalg.norm(self.forces(k), axis=1).max()) for k in frames), default=0)

    def box(self, frames: Iterable[int]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the corners of the box around all that moves, in frames [m], shape [D] each."""
        ends = [(where.min(axis=0), where.max(axis=0)) for where in map(self.everything, frames)]
        low = np.min([end[0] for end in ends], axis=0)
        high = np.max([end[1] for end in ends], axis=0)
        return low, high

    def on_points(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return for each point the mean of the faces around it, shape [point_count].

        Parameters
        ----------
        values
            One for each face, shape [face_count]; NaN counts as none.
        """
        points, faces = self._meetings
        there = np.isfinite(values[faces])
        count = np.bincount(points[there], minlength=len(self.seen.points))
        total = np.bincount(points[there], values[faces[there]], minlength=len(self.seen.points))
        return np.where(count > 0, total / np.maximum(count, 1), np.nan)

    @cached_property
    def _meetings(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Every point with every face that has it, once."""
        around = self.seen.around
        faces = np.repeat(np.arange(len(around)), around.shape[1])
        pairs = np.unique(np.column_stack([around.ravel(), faces]), axis=0)
        return pairs[:, 0], pairs[:, 1]


def subject(
    results: Result | Path | str,
    *,
    field: str | None = None,
    magnification: float = 1.0,
    edges: bool = True,
    reactions: bool = False,
    smooth: bool = False,
) -> Subject:
    """Read what is to be drawn of a run, which may still be going on; see `Subject`.

    Parameters
    ----------
    results
        The results, or their directory.
    field
        What gives the colours; None is the most telling that there is, ``"body"`` tells bodies
        apart.
    magnification, edges, reactions, smooth
        See `Subject`.

    Raises
    ------
    InputError
        There are no fields, or there is no such field among them, or displacements cannot be
        multiplied by such a number.
    """
    if not (isinstance(magnification, Real) and abs(magnification) <= MOST_MAGNIFIED):
        raise InputError(
            f"--magnification {magnification}: must be a number of {MOST_MAGNIFIED:g} at most"
        )
    directory = results.path if isinstance(results, Result) else Path(results)
    frames = Frames(directory / layout.FIELDS)
    surface = directory / layout.SURFACE
    boundaries = Frames(surface) if surface.exists() else None
    seen = outline(frames, boundaries)
    scenario = read_case(directory)
    return Subject(
        frames,
        seen,
        scenario,
        connections(scenario, frames),
        chosen(colourings(frames, boundaries, seen), field),
        magnification=magnification,
        edges=edges,
        reactions=reactions,
        smooth=smooth,
    )
