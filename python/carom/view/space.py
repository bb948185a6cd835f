"""Bodies in space, drawn by PyVista: with light, shading and the edges of their shape."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from numpy.typing import NDArray

from carom.case.obstacle import Plane
from carom.case.travel import travel
from carom.display.colours import FORCE, INK
from carom.errors import InputError
from carom.view.arrows import LONGEST
from carom.view.body_colours import body_colours
from carom.view.camera import Sight, aim
from carom.view.coils import WIDTH, laid, shapes
from carom.view.subject import LEAST_FORCE, Subject
from carom.view.walls import add_obstacles

CREASE = 40.0
"""Angle between faces from which on the edge between them is one of the shape [degrees]."""

SHARE = 0.94
"""Of the picture, that bodies may fill."""

_LIGHT = {"ambient": 0.5, "diffuse": 0.56, "specular": 0.06, "specular_power": 12}
"""Of bodies: what faces the light has the colour of the bar, and no face is dark."""

_WIDTHS = (1.4e-3, 2.6e-3)
"""Of lines between cells, and of edges of shape, as a share of the picture's height."""

_COIL, _MARK = 5.5e-3, 4.5e-2
"""Width of the wire of springs, and size of the mark of a point mass, as a share of it."""

_SHADOW = "#D5DBE4"

FLOOR = 0.35
"""Of the size of what is seen: how far below the bodies a floor may be and yet be shown."""

_ABOVE = 2e-4
"""Of the size of what is seen: what shadows are above the wall that they fall on."""


class SpaceModel:
    """Bodies and obstacles in a plotter, at the time of one frame.

    Parameters
    ----------
    plotter
        PyVista's plotter, whose size is set.
    subject
        What is drawn.
    mappable
        Values as colours.
    frames
        The frames that are drawn: the camera stands so that all are seen.
    largest_force
        The size of the longest arrow [N].
    sight
        The axes of the picture.
    """

    def __init__(
        self,
        plotter: Any,  # noqa: ANN401 (PyVista is optional)
        subject: Subject,
        mappable: ScalarMappable,
        *,
        frames: Sequence[int],
        largest_force: float,
        sight: Sight,
    ) -> None:
        import pyvista  # noqa: PLC0415 (an extra)
        from vtkmodules.vtkFiltersCore import vtkPolyDataNormals  # noqa: PLC0415

        self._plotter, self._subject, self._mappable = plotter, subject, mappable
        seen, flat = subject.seen, subject.is_flat
        self._largest_force = largest_force
        points = reached(subject, frames)
        shown = points if flat else np.concatenate([points, *_shadows(subject, points)])
        aim(plotter, shown, sight, flat=flat, share=SHARE)
        low, high = points.min(axis=0), points.max(axis=0)
        self._size = float(np.linalg.norm(high - low)) or 1.0
        self._obstacles = add_obstacles(plotter, subject.scenario, low, high)
        dimension, times = subject.scenario.dimension, subject.frames.times
        self._travels = [
            subject.magnification * _spatial(travel(each, times, dimension=dimension))
            for each in subject.scenario.obstacles
        ]
        where = _spatial(subject.positions(frames[0]))
        triangles: Any = seen.triangles
        self._faces = pyvista.PolyData.from_regular_faces(where, triangles)
        self._colours = "points" if self._runs_on else "faces"
        data = self._faces.point_data if self._runs_on else self._faces.cell_data
        data["colours"] = self._rgb(frames[0])
        normals = vtkPolyDataNormals()
        normals.SetInputData(self._faces)
        normals.SetFeatureAngle(CREASE)
        normals.ConsistencyOff()
        shaded = self._faces if flat else normals
        body = plotter.add_mesh(shaded, scalars="colours", rgb=True, lighting=not flat, **_LIGHT)
        body.prop.interpolation = "Phong"  # the normals are there already
        body.mapper.SetResolveCoincidentTopologyToPolygonOffset()
        body.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(1.0, 1.0)
        self._lines = [self._faces]
        if subject.edges:
            self._add_lines(seen.edges, opacity=0.3, width=_WIDTHS[0] * plotter.window_size[1])
        shape = seen.rim if flat else creases(seen.triangles, where)
        self._add_lines(shape, opacity=0.85, width=_WIDTHS[1] * plotter.window_size[1])
        self._shadows = [] if flat else list(self._cast_shadows(triangles))
        self._attached = self._add_attached()
        self._arrow_actor: Any = None
        self.update(frames[0])
        # A small body in front of a large obstacle is nearer than VTK's own share of the farthest.
        plotter.renderer.SetNearClippingPlaneTolerance(1e-4)
        plotter.renderer.ResetCameraClippingRange()

    def update(self, frame: int) -> None:
        """Draw another frame."""
        where = _spatial(self._subject.positions(frame))
        for mesh in self._lines:
            mesh.points = where
        data = self._faces.point_data if self._runs_on else self._faces.cell_data
        data["colours"][:] = self._rgb(frame)
        self._faces.Modified()
        for actors, moved in zip(self._obstacles, self._travels, strict=True):
            for actor in actors:
                actor.SetPosition(*moved[frame])
        for index, mesh in self._shadows:
            plane = self._subject.scenario.obstacles[index]
            assert isinstance(plane, Plane)
            normal = np.array(plane.normal) / np.linalg.norm(plane.normal)
            height = (where - self._travels[index][frame] - np.array(plane.point)) @ normal
            mesh.points = where - np.outer(height - _ABOVE * self._size, normal)
        self._update_attached(frame)
        self._draw_forces(frame, where)

    @property
    def _runs_on(self) -> bool:
        colouring = self._subject.colouring
        return colouring is not None and (colouring.place == "points" or self._subject.smooth)

    def _rgb(self, frame: int) -> NDArray[np.uint8]:
        """Return the colours of points or triangles, shape [count, 3]."""
        subject, colouring = self._subject, self._subject.colouring
        if colouring is None or colouring.place == "rim":
            faces = body_colours(subject.seen.body, plain=colouring is not None)
            return _bytes(faces[subject.seen.face])
        values = colouring.rows(frame)
        if self._runs_on and colouring.place == "faces":
            values = subject.on_points(values)
        colours = np.asarray(self._mappable.to_rgba(np.ma.masked_invalid(values)))
        return _bytes(colours if self._runs_on else colours[subject.seen.face])

    def _add_lines(self, ends: NDArray[np.int64], *, opacity: float, width: float) -> None:
        import pyvista  # noqa: PLC0415 (an extra)

        if not len(ends):
            return
        mesh = pyvista.PolyData(
            np.asarray(self._faces.points).copy(), lines=np.insert(ends, 0, 2, axis=1).ravel()
        )
        self._lines.append(mesh)
        self._plotter.add_mesh(mesh, color=INK, opacity=opacity, line_width=width, lighting=False)

    def _cast_shadows(self, triangles: Any) -> Iterator[tuple[int, Any]]:  # noqa: ANN401
        """Yield the floors that are seen, each with what darkens below the bodies."""
        import pyvista  # noqa: PLC0415 (an extra)

        for index, obstacle in enumerate(self._subject.scenario.obstacles):
            if not (isinstance(obstacle, Plane) and self._obstacles[index] and _is_floor(obstacle)):
                continue
            mesh = pyvista.PolyData.from_regular_faces(
                np.asarray(self._faces.points).copy(), triangles
            )
            self._plotter.add_mesh(mesh, color=_SHADOW, lighting=False)
            yield index, mesh

    def _add_attached(self) -> tuple[Any, Any]:
        """Add springs and point masses, whose places `_update_attached` gives them."""
        import pyvista  # noqa: PLC0415 (an extra)

        attached, height = self._subject.attached, self._plotter.window_size[1]
        self._shapes = shapes(attached, self._size)
        coils = marks = None
        if attached.links:
            pieces = sum(map(len, self._shapes))
            lines = np.insert(np.arange(2 * pieces).reshape(-1, 2), 0, 2, axis=1)
            coils = pyvista.PolyData(np.zeros((2 * pieces, 3)), lines=lines.ravel())
            self._plotter.add_mesh(coils, color=INK, line_width=_COIL * height, lighting=False)
        if attached.lumps:
            marks = pyvista.PolyData(np.zeros((len(attached.lumps), 3)))
            self._plotter.add_mesh(
                marks, color=INK, point_size=_MARK * height, render_points_as_spheres=True
            )
        return coils, marks

    def _update_attached(self, frame: int) -> None:
        """Lay springs between their ends, and put masses where they are."""
        attached, (coils, marks) = self._subject.attached, self._attached
        places = self._subject.places(frame)
        if coils is not None:
            ends = attached.ends(places)
            lines = laid(self._shapes, ends, width=WIDTH * self._size)
            coils.points = _spatial(lines.reshape(-1, attached.dimension))
        if marks is not None:
            marks.points = _spatial(attached.marks(places))

    def _draw_forces(self, frame: int, where: NDArray[np.float64]) -> None:
        import pyvista  # noqa: PLC0415 (an extra)

        if self._arrow_actor is not None:
            self._plotter.remove_actor(self._arrow_actor, render=False)
            self._arrow_actor = None
        if not (self._subject.reactions and self._largest_force > 0.0):
            return
        force = _spatial(self._subject.forces(frame)) / self._largest_force
        size = np.linalg.norm(force, axis=1)
        acts = size > LEAST_FORCE
        if not acts.any():
            return
        tails = pyvista.PolyData(where[acts])
        tails["force"], tails["size"] = force[acts], size[acts]
        arrow = pyvista.Arrow(shaft_radius=0.018, tip_radius=0.055, tip_length=0.22)
        drawn = tails.glyph(orient="force", scale="size", factor=LONGEST * self._size, geom=arrow)
        self._arrow_actor = self._plotter.add_mesh(
            drawn, color=FORCE, ambient=0.5, diffuse=0.5, render=False, reset_camera=False
        )


class SpaceScene:
    """Bodies and obstacles in space as an image in axes.

    Parameters
    ----------
    axes
        Where the image is.
    drawing
        PyVista's plotter, see `plotter`; scenes may share one.
    model
        What it draws.
    """

    def __init__(self, axes: Axes, drawing: Any, model: SpaceModel) -> None:  # noqa: ANN401
        self._drawing, self._model = drawing, model
        width, height = drawing.window_size
        axes.set_axis_off()
        white = np.full((height, width, 3), 255, dtype=np.uint8)
        self._image = axes.imshow(white, interpolation="antialiased", aspect="auto")
        self.artists: list[Artist] = [self._image]

    def update(self, frame: int) -> None:
        """Draw another frame."""
        self._model.update(frame)
        self._drawing.render()
        self._image.set_data(self._drawing.screenshot(return_img=True))


@contextmanager
def plotter(size: tuple[int, int], *, off_screen: bool, of: str) -> Iterator[Any]:
    """Give an empty plotter of so many pixels.

    Raises
    ------
    InputError
        PyVista is not installed.
    """
    try:
        import pyvista  # noqa: PLC0415 (an extra, and slow to load)
        from vtkmodules.vtkCommonCore import vtkLogger  # noqa: PLC0415
    except ImportError as error:
        raise InputError(f'{of} needs PyVista ({error}): pip install "carom[view]"') from None
    # Without a display VTK draws by EGL or OSMesa, and says so before.
    verbosity = vtkLogger.GetCurrentVerbosityCutoff()
    if off_screen:
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    made: Any = pyvista.Plotter(off_screen=off_screen, window_size=list(size))
    try:
        made.set_background("white")
        made.enable_anti_aliasing("ssaa")
        yield made
    finally:
        made.close()
        vtkLogger.SetStderrVerbosity(verbosity)


def creases(triangles: NDArray[np.int64], points: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the edges at which a surface bends sharply, or ends, shape [edge_count, 2].

    Parameters
    ----------
    triangles
        Corners of each, shape [triangle_count, 3].
    points
        Positions [m], shape [point_count, 3].
    """
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0.0)
    ends = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(triangles)), 3)
    order = np.lexsort(ends.T)
    ends, owner = ends[order], owner[order]
    with_next = (ends[1:] == ends[:-1]).all(axis=1)
    first = np.flatnonzero(with_next)
    bends = (normal[owner[first]] * normal[owner[first + 1]]).sum(axis=1) < np.cos(
        np.radians(CREASE)
    )
    paired = np.zeros(len(ends), dtype=bool)
    paired[first] = paired[first + 1] = True
    return np.concatenate([ends[first[bends]], ends[~paired]])


def reached(subject: Subject, frames: Sequence[int]) -> NDArray[np.float64]:
    """Return what must be seen [m], shape [count, 3]: the points of few frames, boxes of many."""
    if len(frames) <= 4:
        return np.concatenate([_spatial(subject.everything(frame)) for frame in frames])
    corners = []
    for frame in frames:
        where = _spatial(subject.everything(frame))
        low, high = where.min(axis=0), where.max(axis=0)
        corners += [np.where(side, high, low) for side in np.ndindex(2, 2, 2)]
    return np.array(corners)


def _shadows(subject: Subject, points: NDArray[np.float64]) -> Iterator[NDArray[np.float64]]:
    """Yield the shadows of points on floors that are not far below them, shape [count, 3]."""
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    for obstacle in subject.scenario.obstacles:
        if isinstance(obstacle, Plane) and _is_floor(obstacle):
            normal = np.array(obstacle.normal) / np.linalg.norm(obstacle.normal)
            height = (points - np.array(obstacle.point)) @ normal
            if 0.0 <= height.min() < FLOOR * size:
                yield points - np.outer(height, normal)


def _is_floor(plane: Plane) -> bool:
    return plane.normal[2] > 0.5 * float(np.linalg.norm(plane.normal))


def _spatial(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return vectors with the missing components as zeros, shape [count, 3]."""
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))


def _bytes(colours: NDArray[np.float64]) -> NDArray[np.uint8]:
    return (255.0 * colours[:, :3] + 0.5).astype(np.uint8)
