"""Springs, dampers and point masses: where they are as the bodies move that they are attached to.

Results have the length of a spring and its force, but not where its ends are. These follow from the
case and from the displacements, by the rules of the core: of a body that deforms the nearest node,
of a rigid one the point that moves with it, of a set the mean of its nodes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from carom.case.body import RigidBody
from carom.case.foreign_body import ForeignEntry
from carom.case.point_mass import PointMass
from carom.case.scenario import Scenario
from carom.case.spring import Place, Spring
from carom.case.travel import travel
from carom.errors import InputError
from carom.io.frames import Frames
from carom.results.fields import Part, parts
from carom.view.named_nodes import named_nodes

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Attachment:
    """A place: the mean of nodes by their shares, what moves with an obstacle, or what stays.

    Parameters
    ----------
    at
        Where it is as the case is drawn [m], shape [D].
    label
        What it is of, in words.
    nodes, shares
        The nodes that it moves with, among those of all bodies, and their shares.
    moved
        How far it is moved in each frame [m], shape [frame_count, D], where that is known without
        nodes.
    is_fixed
        Whether it stays where it is.
    """

    at: Array
    label: str
    nodes: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    shares: Array = field(default_factory=lambda: np.empty(0))
    moved: Array | None = None
    is_fixed: bool = False


@dataclass(frozen=True)
class Link:
    """A spring or a damper.

    Parameters
    ----------
    name
        Its name.
    kind
        ``"damper"`` if it has no stiffness, ``"spring"`` otherwise.
    ends
        Where it is attached.
    free_length
        Its length without tension [m].
    """

    name: str
    kind: Literal["spring", "damper"]
    ends: tuple[Attachment, Attachment]
    free_length: float

    @property
    def drawn_length(self) -> float:
        """Its length as the case is drawn [m]."""
        return float(np.linalg.norm(self.ends[1].at - self.ends[0].at))


@dataclass(frozen=True)
class Lump:
    """A point mass: its mass [kg], and where it is."""

    mass: float
    place: Attachment


@dataclass(frozen=True)
class Connections:
    """What is attached to the bodies of a run.

    Parameters
    ----------
    frames
        The file with the bodies.
    links, lumps
        Springs and dampers, and point masses, that can be drawn.
    missing
        What cannot, and why, in sentences.
    """

    frames: Frames
    dimension: int
    links: tuple[Link, ...] = ()
    lumps: tuple[Lump, ...] = ()
    missing: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.links or self.lumps)

    @cached_property
    def places(self) -> tuple[Attachment, ...]:
        """The two ends of every link, one after the other, then the places of the lumps."""
        ends = tuple(end for link in self.links for end in link.ends)
        return (*ends, *(lump.place for lump in self.lumps))

    @cached_property
    def drawn(self) -> Array:
        """Where the places are as the case is drawn [m], shape [place_count, D]."""
        return np.array([place.at for place in self.places]).reshape(-1, self.dimension)

    @cached_property
    def _rows(self) -> slice:
        nodes = [place.nodes for place in self.places if len(place.nodes)]
        together = np.concatenate(nodes) if nodes else np.zeros(1, dtype=np.int64)
        return slice(int(together.min()), int(together.max()) + 1)

    def moved(self, frame: int) -> Array:
        """Return how far the places have moved in a frame [m], shape [place_count, D]."""
        result = np.zeros_like(self.drawn)
        if not self:
            return result
        rows = self._rows
        u = self.frames.read("displacement", [frame], rows)[0][:, : self.dimension]
        for into, place in zip(result, self.places, strict=True):
            if place.moved is not None:
                into[:] = place.moved[frame]
            elif len(place.nodes):
                into[:] = place.shares @ u[place.nodes - rows.start]
        return result

    def ends(self, places: Array) -> Array:
        """Return the ends of the links among places, shape [link_count, 2, D]."""
        return places[: 2 * len(self.links)].reshape(-1, 2, self.dimension)

    def marks(self, places: Array) -> Array:
        """Return where the lumps are among places, shape [lump_count, D]."""
        return places[2 * len(self.links) :]

    def forces(self, history: Mapping[str, Array], frames: Sequence[int]) -> Array:
        """Return the tension in the links at frames [N], shape [frame, link_count].

        It is interpolated between rows of the history, which need not be at the times of frames;
        NaN where the history does not have it.
        """
        times = self.frames.times[np.asarray(frames, dtype=np.int64)]
        result = np.full((len(times), len(self.links)), np.nan)
        for index, link in enumerate(self.links):
            force = history.get(f"{link.name}.force")
            if force is not None and len(force):
                result[:, index] = np.interp(times, history["time"], force)
        return result


def label(place: Place | PointMass) -> str:
    """Return in words what a place is of."""
    if place.body is not None:
        return place.body if place.on is None else f"{place.on} of {place.body}"
    return place.obstacle or "a fixed point"


def connections(scenario: Scenario, frames: Frames) -> Connections:
    """Return what is attached to the bodies of a case, as far as it can be found again."""
    if not (scenario.springs or scenario.masses):
        return Connections(frames, scenario.dimension)
    finder = _Finder(scenario, frames)
    links, lumps, missing = [], [], []
    for spring in scenario.springs:
        try:
            links.append(finder.link(spring))
        except InputError as error:
            missing.append(f"The spring {spring.name} is not drawn: {error}.")
    for mass in scenario.masses:
        try:
            lumps.append(finder.lump(mass))
        except InputError as error:
            missing.append(f"The mass on {mass.body} is not drawn: {error}.")
    return Connections(frames, scenario.dimension, tuple(links), tuple(lumps), tuple(missing))


class _Finder:
    """Finds places of a case on the nodes of its results."""

    def __init__(self, scenario: Scenario, frames: Frames) -> None:
        self._scenario, self._frames = scenario, frames
        # Springs and masses are of no body of another code.
        entries = (body for body in scenario.bodies if not isinstance(body, ForeignEntry))
        self._bodies = {body.name: body for body in entries}
        self._obstacles = {obstacle.name: obstacle for obstacle in scenario.obstacles}
        self._parts: dict[str, Part] = parts(frames, [body.name for body in scenario.bodies])

    def link(self, spring: Spring) -> Link:
        first, second = (self._attached(place) for place in spring.between)
        drawn = float(np.linalg.norm(second.at - first.at))
        return Link(
            spring.name,
            "spring" if spring.stiffness or spring.force is not None else "damper",
            (first, second),
            drawn if spring.free_length is None else spring.free_length,
        )

    def lump(self, mass: PointMass) -> Lump:
        return Lump(mass.mass, self._attached(mass))

    def _attached(self, place: Place | PointMass) -> Attachment:
        if place.body is None:
            return self._beside(place)
        part, entry = self._parts[place.body], self._bodies[place.body]
        name, drawn = label(place), self._frames.points[part.nodes, : self._scenario.dimension]
        if place.point is None:
            nodes = named_nodes(entry.mesh, place.on or "all", drawn)
            shares = np.full(len(nodes), 1.0 / len(nodes))
            return self._of_nodes(name, part, nodes, shares, shares @ drawn[nodes])
        at = np.array(place.point)
        if isinstance(entry, RigidBody):
            shares = _rigid_shares(drawn, at)
            return self._of_nodes(name, part, np.arange(len(drawn)), shares, at)
        nearest = int(((drawn - at) ** 2).sum(axis=1).argmin())
        return self._of_nodes(name, part, np.array([nearest]), np.ones(1), drawn[nearest])

    def _of_nodes(
        self, name: str, part: Part, nodes: NDArray[np.int64], shares: Array, at: Array
    ) -> Attachment:
        return Attachment(at, name, part.nodes.start + nodes, shares)

    def _beside(self, place: Place) -> Attachment:
        """Return a place that is of no body."""
        name, at = label(place), np.array(place.point)
        dimension, times = self._scenario.dimension, self._frames.times
        if place.obstacle is None:
            return Attachment(at, name, moved=np.zeros((len(times), dimension)), is_fixed=True)
        moved = travel(self._obstacles[place.obstacle], times, dimension=dimension)
        return Attachment(at, name, moved=moved)


def _rigid_shares(drawn: Array, at: Array) -> Array:
    """Return shares of all nodes whose mean is a point, however a rigid body moves them.

    They are the smallest ones with Σ s = 1 and Σ s X = P. What a body that is a line or a sheet
    does not reach is left out, as in the core.
    """
    middle = drawn.mean(axis=0)
    size = float(np.abs(drawn - middle).max()) or 1.0
    conditions = np.vstack([np.ones(len(drawn)), (drawn - middle).T / size])
    wanted = np.concatenate([[1.0], (at - middle) / size])
    shares, *_ = np.linalg.lstsq(conditions, wanted, rcond=1e-9)
    return np.asarray(shares)
