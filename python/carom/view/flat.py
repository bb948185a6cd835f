"""Bodies of the plane, drawn by matplotlib: as lines and areas that stay sharp at any size."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PathCollection, PolyCollection
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Curve
from matplotlib.transforms import Affine2D, IdentityTransform
from numpy.typing import NDArray

from carom.case.travel import travel
from carom.display.colours import FORCE, INK, SOLID, SOLID_LINE
from carom.view.arrows import LONGEST, arrows
from carom.view.body_colours import body_colours
from carom.view.coils import WIDTH, laid, shapes
from carom.view.shading import Shading
from carom.view.solids import solid
from carom.view.subject import LEAST_FORCE, Subject

CUTS = 2
"""How often the edges of triangles are halved where colours run on."""

MARK = 3.2
"""Radius of the mark of a point mass [pt]."""


class Scene(Protocol):
    """Bodies and obstacles in a part of a figure, at the time of one frame."""

    artists: list[Artist]
    """What changes from frame to frame."""

    def update(self, frame: int) -> None:
        """Draw another frame."""


class FlatScene:
    """Bodies and obstacles of the plane in axes.

    Parameters
    ----------
    axes
        Where they are drawn; its limits say what is seen.
    subject
        What is drawn.
    mappable
        Values as colours.
    largest_force
        The size of the longest arrow [N].
    cuts
        How often the edges of triangles are halved where colours run on.
    """

    def __init__(
        self,
        axes: Axes,
        subject: Subject,
        mappable: ScalarMappable,
        *,
        largest_force: float,
        cuts: int = CUTS,
    ) -> None:
        self._subject, self._mappable = subject, mappable
        self._largest_force = largest_force
        self._to_page = axes.transData
        seen, colouring = subject.seen, subject.colouring
        self._size = float(np.hypot(np.diff(axes.get_xlim()), np.diff(axes.get_ylim())).item())
        self._obstacles = [self._add_obstacle(axes, k) for k in range(len(self._travels()))]
        self._shading = None
        if colouring is not None and (
            colouring.place == "points" or (subject.smooth and colouring.place == "faces")
        ):
            self._shading = Shading(axes, seen.triangles, cuts=cuts)
        self._faces = PolyCollection([], linewidths=0.3, zorder=2)
        self._edges = _lines(axes, len(seen.edges), linewidth=0.25, alpha=0.3, zorder=3)
        self._edges.set_visible(subject.edges)
        self._rim = _lines(axes, len(seen.rim), linewidth=0.6, capstyle="round", zorder=4)
        self._band = LineCollection([], linewidths=2.4, capstyle="butt", zorder=5)
        self._arrows = PolyCollection([], facecolors=FORCE, linewidths=0, zorder=6)
        attached = subject.attached
        self._shapes = shapes(attached, self._size)
        pieces = sum(map(len, self._shapes))
        # Dark lines with a pale edge are seen on all colours of bodies.
        self._coils = [
            _lines(axes, pieces, linewidth=2.4, edgecolor="white", capstyle="round", zorder=5.5),
            _lines(axes, pieces, linewidth=0.9, capstyle="round", zorder=5.6),
        ]
        self._marks = PathCollection(
            [Curve.unit_circle()],
            sizes=[MARK**2],
            offsets=np.zeros((len(attached.lumps), 2)),
            offset_transform=axes.transData,
            facecolors=INK,
            edgecolors="white",
            linewidths=0.8,
            zorder=5.8,
        )
        self._marks.set_transform(IdentityTransform())
        self._on_rim = colouring is not None and colouring.place == "rim"
        collections = [self._faces, self._band, self._marks, self._arrows]
        for collection in collections:
            axes.add_collection(collection, autolim=False)
        moving = [patch for patches, _, moves in self._obstacles if moves for patch in patches]
        self.artists: list[Artist] = [*moving, *([self._shading] if self._shading else [])]
        self.artists += [*collections, self._edges, self._rim, *self._coils]

    def update(self, frame: int) -> None:
        """Draw another frame."""
        subject, seen = self._subject, self._subject.seen
        where = subject.positions(frame)
        for patches, moved, _ in self._obstacles:
            for patch in patches:
                patch.set_transform(Affine2D().translate(*moved[frame]) + self._to_page)
        if self._shading is None:
            corners: Any = where[seen.around]
            self._faces.set_verts(corners)
            colours: Any = self._face_colours(frame)
            self._faces.set_facecolor(colours)
            self._faces.set_edgecolor(colours)  # or what is behind shines through between faces
        else:
            self._shading.update_values(where, self._point_values(frame), self._mappable)
        _set(self._edges, where[seen.edges])
        _set(self._rim, where[seen.rim])
        if self._on_rim:
            self._band.set_segments([*where[seen.rim]])
            colours = self._mappable.to_rgba(self._values(frame))
            self._band.set_color(colours)
        self._update_attached(frame)
        shown: Any = []
        if subject.reactions and self._largest_force > 0.0:
            force = subject.forces(frame) / self._largest_force
            acts = np.linalg.norm(force, axis=1) > LEAST_FORCE
            shown = arrows(where[acts], LONGEST * self._size * force[acts], size=self._size)
        self._arrows.set_verts(shown)

    def _update_attached(self, frame: int) -> None:
        """Lay springs between their ends, and put masses where they are."""
        attached = self._subject.attached
        if not attached:
            return
        places = self._subject.places(frame)
        lines = laid(self._shapes, attached.ends(places), width=WIDTH * self._size)
        for coil in self._coils:
            _set(coil, lines)
        self._marks.set_offsets(attached.marks(places))

    def _values(self, frame: int) -> NDArray[np.float64]:
        assert self._subject.colouring is not None
        return self._subject.colouring.rows(frame)

    def _point_values(self, frame: int) -> NDArray[np.float64]:
        values = self._values(frame)
        colouring = self._subject.colouring
        return (
            values if colouring and colouring.place == "points" else self._subject.on_points(values)
        )

    def _face_colours(self, frame: int) -> NDArray[np.float64]:
        colouring = self._subject.colouring
        if colouring is None or colouring.place == "rim":
            return body_colours(self._subject.seen.body, plain=colouring is not None)
        return np.asarray(self._mappable.to_rgba(self._values(frame)))

    def _travels(self) -> list[NDArray[np.float64]]:
        """Return where each obstacle is in every frame [m], shape [frame_count, 2]."""
        times, scenario = self._subject.frames.times, self._subject.scenario
        moved = [travel(each, times, dimension=2) for each in scenario.obstacles]
        return [self._subject.magnification * each for each in moved]

    def _add_obstacle(
        self, axes: Axes, index: int
    ) -> tuple[tuple[PathPatch, PathPatch], NDArray[np.float64], bool]:
        obstacle, moved = self._subject.scenario.obstacles[index], self._travels()[index]
        middle = np.array([np.mean(axes.get_xlim()), np.mean(axes.get_ylim())])
        reach = 2.0 * self._size + float(np.abs(moved).max(initial=0.0))
        shape = solid(obstacle, middle, reach)
        curve = Curve.make_compound_path(*(Curve(ring, closed=True) for ring in _open(shape.rings)))
        # The lines of all below the areas of all: where walls cross, none runs on in another.
        line = PathPatch(
            Curve(shape.edge), fill=False, edgecolor=SOLID_LINE, linewidth=1.6, zorder=0.5
        )
        area = PathPatch(curve, facecolor=SOLID, linewidth=0, zorder=1)
        for patch in (line, area):
            axes.add_patch(patch)
        return (line, area), moved, bool(np.ptp(moved, axis=0).any())


def _lines(
    axes: Axes,
    count: int,
    *,
    edgecolor: str = INK,
    **look: Any,  # noqa: ANN401 (as of patches)
) -> PathPatch:
    """Add so many lines of one look, as one curve: many artists would take long to draw."""
    codes = np.tile(np.array([Curve.MOVETO, Curve.LINETO], dtype=np.uint8), count)
    patch = PathPatch(
        Curve(np.zeros((2 * count, 2)), codes), fill=False, edgecolor=edgecolor, **look
    )
    axes.add_patch(patch)
    return patch


def _set(lines: PathPatch, ends: NDArray[np.float64]) -> None:
    """Put lines elsewhere; ends of shape [count, 2, 2] [m]."""
    lines.set_path(Curve(ends.reshape(-1, 2), lines.get_path().codes))


def _open(rings: tuple[NDArray[np.float64], ...]) -> list[NDArray[np.float64]]:
    """Return rings whose last point closes them; a hole runs against what it is in."""
    return [np.concatenate([r, r[:1]])[:: -1 if k else 1] for k, r in enumerate(rings)]
