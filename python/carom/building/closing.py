"""Closing overlaps at the start that the numbers of a mesh file cannot tell from touching."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from carom.case.scenario import Scenario
from carom.mesh_file import MeshArrays, Note

if TYPE_CHECKING:
    from carom._carom import Simulation
    from carom.building.simplices import Boundary

SHORT = 1e-3
"""Overlap, relative to the shortest edge of the body that gives way, that is never closed."""

ROUND_OFF = 1e-12
"""Depth, relative to the size of a body, that is not worth a move."""

Array = NDArray[np.float64]


def closed(
    scenario: Scenario,
    meshes: Mapping[str, MeshArrays],
    make: Callable[[Scenario, Mapping[str, MeshArrays]], Simulation],
) -> tuple[dict[str, MeshArrays], list[Note]]:
    """Return meshes whose overlaps below their own precision are closed, and what was moved.

    Nodes go to the surface that they are behind, as if the file had said so. Nothing is under
    stress, and no energy comes out of an overlap that was not there.

    Parameters
    ----------
    scenario
        The case, which was refused for whatever reason.
    meshes
        The meshes that bodies take from files, by the names of the bodies.
    make
        Builds a simulation.

    Raises
    ------
    InputError
        The case cannot be built even where nothing can touch.
    """
    if not any(arrays.precision > 0.0 for arrays in meshes.values()):
        return dict(meshes), []
    work = _Closing(scenario, meshes, make(_apart(scenario), meshes))
    for one, other in _pairs(scenario):
        work.close(one, other)
    return work.meshes, work.notes


def _apart(scenario: Scenario) -> Scenario:
    """Return the bodies of a scenario, of which none can touch anything."""
    pairs = [{"between": pair, "enabled": False} for pair in _pairs(scenario)]
    contact = scenario.contact.model_validate({"pairs": pairs})
    bodies = tuple(body.model_copy(update={"self_contact": False}) for body in scenario.bodies)
    stages = tuple(stage.model_copy(update={"contact": None}) for stage in scenario.stages)
    return scenario.model_copy(update={"contact": contact, "bodies": bodies, "stages": stages})


def _pairs(scenario: Scenario) -> Iterator[tuple[str, str]]:
    """Yield the names of a body and of what it may touch."""
    disabled = {frozenset(pair.between) for pair in scenario.contact.pairs if not pair.enabled}
    bodies = [body.name for body in scenario.bodies]
    for index, one in enumerate(bodies):
        for other in (*bodies[index + 1 :], *(o.name for o in scenario.obstacles)):
            if frozenset((one, other)) not in disabled:
                yield one, other


class _Closing:
    """The meshes while they are moved."""

    def __init__(
        self, scenario: Scenario, meshes: Mapping[str, MeshArrays], native: Simulation
    ) -> None:
        from carom.building.simplices import boundaries  # noqa: PLC0415 (for refused cases only)

        self.meshes, self.notes = dict(meshes), list[Note]()
        self._index = {body.name: k for k, body in enumerate(scenario.bodies)}
        self._obstacles = {obstacle.name: k for k, obstacle in enumerate(scenario.obstacles)}
        self._native = native
        description: dict[str, Any] = native.describe()
        self._bodies: list[Mapping[str, Any]] = description["bodies"]
        points = native.mesh()["points"]
        ends = np.cumsum([body["nodes"] for body in self._bodies])
        found = boundaries(native.surface(), points, len(self._bodies))
        self._boundaries = [boundary for boundary, _ in found]
        self._nodes = [
            nodes - (end - body["nodes"])
            for (_, nodes), end, body in zip(found, ends, self._bodies, strict=True)
        ]

    def close(self, one: str, other: str) -> None:
        """Move nodes of a body out of another one or an obstacle, and the other way round."""
        if other in self._obstacles:
            self._leave_obstacle(one, other)
            return
        # The finer one first: a single node of the other one that gives way would bend its side.
        order = sorted((one, other), key=lambda name: self._body(name)["smallest_edge"])
        for name, target in (order, order[::-1]):
            self._leave(name, target)

    def _leave_obstacle(self, body: str, obstacle: str) -> None:
        deepest = self._deepest(body, body)
        if deepest <= 0.0:
            return
        points = self._boundary(body).points
        gaps, normals = self._native.obstacle_gaps(self._obstacles[obstacle], points)
        which = np.flatnonzero((gaps < 0.0) & (gaps >= -deepest))
        feet = points[which] - gaps[which, None] * normals[which]
        self._move(body, obstacle, which, feet, deepest)

    def _leave(self, body: str, other: str) -> None:
        """Move the nodes of a body out of another one, or the sides of the other one back."""
        from carom.building.simplices import behind  # noqa: PLC0415 (for refused cases only)

        deepest = self._deepest(body, other)
        if deepest <= 0.0:
            return
        mine, theirs = self._boundary(body), self._boundary(other)
        which, feet = behind(mine.points, theirs, deepest)
        if self._precision(body) > 0.0:
            self._move(body, other, which, feet, deepest)
        elif len(which):
            depths = mine.points[which] - feet
            nodes, moved = _sides_back(theirs, feet, depths)
            self._move(other, body, nodes, theirs.points[nodes] + moved, deepest)

    def _move(self, body: str, other: str, which: NDArray[Any], to: Array, deepest: float) -> None:
        boundary, index = self._boundary(body), self._index[body]
        depths = np.linalg.norm(to - boundary.points[which], axis=1)
        real = depths > ROUND_OFF * self._bodies[index]["diameter"]
        which, to, depths = which[real], to[real], depths[real]
        if not len(which):
            return
        points = boundary.points.copy()
        points[which] = to
        self._boundaries[index] = boundary.at(points)
        arrays = self.meshes[body]
        moved = arrays.points.copy()
        moved[self._nodes[index][which]] = to
        self.meshes[body] = replace(arrays, points=moved)
        self.notes.append(
            Note(
                "closed-overlap",
                f"{len(which):,} nodes of {body} were moved out of {other} by {depths.max():.2g} m "
                f"or less, which is no more than its numbers can tell ({deepest:.2g} m)",
                where=f"bodies.{index}.mesh.file",
                value=float(depths.max()),
                allowed=0.0,
                remedy="write the file with more digits",
            )
        )

    def _body(self, name: str) -> Mapping[str, Any]:
        return self._bodies[self._index[name]]

    def _boundary(self, body: str) -> Boundary:
        return self._boundaries[self._index[body]]

    def _precision(self, body: str) -> float:
        return self.meshes[body].precision if body in self.meshes else 0.0

    def _deepest(self, one: str, other: str) -> float:
        """Return the overlap of two that their numbers cannot tell from touching [m]."""
        told = self._precision(one) + (self._precision(other) if other != one else 0.0)
        edges = [
            self._body(name)["smallest_edge"]
            for name in (one, other)
            if self._precision(name) > 0.0
        ]
        # Both ends of a digit, and round-off of what is written with it.
        return min(2.0 * told, SHORT * min(edges, default=0.0))


def _sides_back(boundary: Boundary, feet: Array, depths: Array) -> tuple[NDArray[np.int64], Array]:
    """Return the nodes of the pieces on which feet are, and how far these go back [m]."""
    from carom.building.simplices import pieces_at  # noqa: PLC0415 (for refused cases only)

    back = np.zeros_like(boundary.points)
    for foot, depth in zip(feet, depths, strict=True):
        for node in np.unique(boundary.pieces[pieces_at(boundary, foot)]):
            if np.linalg.norm(depth) > np.linalg.norm(back[node]):
                back[node] = depth
    nodes = np.flatnonzero(np.any(back != 0.0, axis=1))
    return nodes, back[nodes]
