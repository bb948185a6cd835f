"""Scenes in which contact goes wrong in other codes, and went wrong in this one.

Each is a function that returns what of a case is its own: bodies, obstacles, times. Sizes are of
the order of a metre, bodies of rubber, and what should come to rest is damped. Erleben's set of
degenerate contacts (Erleben, ACM Trans. Graph. 37, 2018) is among them, written anew.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import meshio
import numpy as np

Case = dict[str, Any]
Map = Callable[[np.ndarray], np.ndarray]

SCENES: dict[str, Callable[[Path], Case]] = {}
"""All scenes by name; each is given a folder for its meshes."""

MATERIAL = {"kind": "neo-hookean", "young": 1e6, "poisson": 0.3, "density": 1000.0}
DAMPING = {"mass": 5.0, "stiffness": 1e-3}
SPEEDS = (10, 100, 1000)
"""Of bullets, in their sizes per second."""


def scene(make: Callable[[Path], Case]) -> Callable[[Path], Case]:
    """Enter a scene under its name."""
    SCENES[make.__name__.replace("_", " ")] = make
    return make


def case(
    bodies: list[Case],
    obstacles: list[Case],
    end: float = 1.0,
    step: float = 2e-3,
    *,
    friction: float = 0.3,
    damped: bool = True,
    gravity: bool = True,
) -> Case:
    """Return a case of these bodies."""
    parts = [body["mesh"] for body in bodies] + obstacles
    places = [[part[k] for k in ("corner", "point") if k in part] for part in parts]
    places += [part["points"] for part in parts if "points" in part]
    dimension = next(len(place[0]) for place in places if place)
    down = [0.0] * (dimension - 1) + [-9.81]
    return {
        "dimension": dimension,
        "analysis": {
            "kind": "dynamic",
            "end_time": end,
            "time_step": step,
            "gravity": down if gravity else None,
        },
        "materials": {"m": {**MATERIAL, **({"damping": DAMPING} if damped else {})}},
        "bodies": [{"name": f"body-{k}", "material": "m", **body} for k, body in enumerate(bodies)],
        "obstacles": obstacles,
        "contact": {"friction": friction},
    }


def block(corner: list[float], size: list[float], divisions: list[int], **more: Any) -> Case:
    """Return a box of cells, in the plane a rectangle."""
    kind = "rectangle" if len(corner) == 2 else "box"
    return {"mesh": {"kind": kind, "corner": corner, "size": size, "divisions": divisions}, **more}


def shaped(folder: Path, form: Map, divisions: list[int], **more: Any) -> Case:
    """Return a body whose cells are those of a unit square or cube, moved by `form`."""
    axes = [np.linspace(0.0, 1.0, n + 1) for n in divisions]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    number = np.arange(grid[..., 0].size).reshape(grid.shape[:-1])
    if len(divisions) == 2:
        corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        kind = "quad"
    else:
        corners = [(*xy, z) for z in (0, 1) for xy in ((0, 0), (1, 0), (1, 1), (0, 1))]
        kind = "hexahedron"
    part = [
        number[tuple(slice(c, c + n) for c, n in zip(corner, divisions, strict=True))].ravel()
        for corner in corners
    ]
    points = form(grid.reshape(-1, len(divisions)))
    if len(divisions) == 2:
        points = np.pad(points, ((0, 0), (0, 1)))
    file = folder / f"mesh{len(list(folder.iterdir()))}.vtu"
    meshio.write_points_cells(file, points, [(kind, np.stack(part, axis=1))])
    return {"mesh": {"kind": "file", "file": str(file)}, **more}


def stl(folder: Path, vertices: list[list[float]], triangles: list[list[int]], name: str) -> Case:
    """Return an obstacle of triangles."""
    file = folder / f"{name}.stl"
    meshio.write_points_cells(file, np.array(vertices, float), [("triangle", np.array(triangles))])
    return {"name": name, "kind": "surface", "file": str(file)}


def floor(dimension: int, height: float = 0.0) -> Case:
    """Return a floor."""
    up = [0.0] * (dimension - 1)
    return {"name": "floor", "kind": "plane", "point": [*up, height], "normal": [*up, 1.0]}


def fixed(name: str, corner: list[float], size: list[float]) -> Case:
    """Return a box that does not move."""
    return {"name": name, "kind": "box", "corner": corner, "size": size}


def turned(centre: list[float], angle: float, size: list[float]) -> Map:
    """Return a map from the unit square to a rectangle about its centre."""
    c, s = np.cos(angle), np.sin(angle)
    return lambda x: ((x - 0.5) * size) @ np.array([[c, s], [-s, c]]) + centre


def on_corner(centre: list[float], size: float) -> Map:
    """Return a map from the unit cube to a cube that stands on a corner."""
    up = np.ones(3) / np.sqrt(3)
    aside = np.array([1.0, -1.0, 0.0]) / np.sqrt(2)
    axes = np.stack([aside, np.cross(up, aside), up])
    return lambda x: ((x - 0.5) * size) @ axes.T + centre


def spike(centre: list[float], height: float, *, down: bool = False, ridge: bool = False) -> Map:
    """Return a map from the unit cube to a spike, or a wedge with a ridge along y."""

    def form(x: np.ndarray) -> np.ndarray:
        width = 0.5 * (1.0 - 0.96 * x[:, 2])
        out = (x - [0.5, 0.5, 0.0]) * [1.0, 1.0, height]
        out[:, 0] *= width
        out[:, 1] *= 0.5 if ridge else width
        if down:
            out[:, 1:] *= -1.0
        return out + centre

    return form


@scene
def stack_in_the_plane(_: Path) -> Case:
    """Return the scene: five flush boxes of unequal meshes."""
    sizes = [4, 6, 4, 6, 4]
    return case(
        [block([0.0, float(k)], [1.0, 1.0], [n, n]) for k, n in enumerate(sizes)], [floor(2)]
    )


@scene
def stack_in_space(_: Path) -> Case:
    """Return the scene: three flush boxes of unequal meshes."""
    up = [block([0.0, 0.0, float(k)], [1.0] * 3, [n] * 3) for k, n in enumerate((2, 3, 2))]
    return case(up, [floor(3)])


@scene
def inset_stack(_: Path) -> Case:
    """Return the scene: boxes that get smaller upwards."""
    sizes = [1.0, 0.73, 0.41]
    bodies = [
        block([0.5 - s / 2, 0.5 - s / 2, sum(sizes[:k])], [s] * 3, [2] * 3)
        for k, s in enumerate(sizes)
    ]
    return case(bodies, [floor(3)])


@scene
def pyramid_of_boxes(_: Path) -> Case:
    """Return the scene: four, three, two, one."""
    bodies = [
        block([1.1 * i + 0.55 * row, float(row)], [1.0, 1.0], [3, 3])
        for row in range(4)
        for i in range(4 - row)
    ]
    return case(bodies, [floor(2)], friction=0.6)


@scene
def box_on_its_edge(folder: Path) -> Case:
    """Return the scene: a square that falls over its corner."""
    form = turned([0.0, 0.8], np.pi / 4 + 0.05, [1.0, 1.0])
    return case([shaped(folder, form, [6, 6])], [floor(2)], end=2.0)


@scene
def cube_on_its_corner(folder: Path) -> Case:
    """Return the scene: a cube that falls on its corner."""
    return case([shaped(folder, on_corner([0.0, 0.0, 0.9], 1.0), [3] * 3)], [floor(3)])


@scene
def corner_on_corner(folder: Path) -> Case:
    """Return the scene: a square on its corner falls on that of another."""
    below = turned([0.0, 0.72], np.pi / 4, [1.0, 1.0])
    above = turned([0.0, 2.25], np.pi / 4, [1.0, 1.0])
    walls = [fixed("left", [-1.2, 0.0], [0.6, 0.4]), fixed("right", [0.6, 0.0], [0.6, 0.4])]
    held = shaped(folder, below, [5, 5])
    return case([held, shaped(folder, above, [5, 5])], [floor(2), *walls], end=1.0)


@scene
def wedge_between_two_blocks(folder: Path) -> Case:
    """Return the scene: a sharp wedge is driven into the gap between two blocks."""

    def form(x: np.ndarray) -> np.ndarray:
        width = 0.02 + 0.5 * x[:, 1]
        return np.stack([(x[:, 0] - 0.5) * width, 1.0 + x[:, 1]], axis=1)

    blocks = [block([-1.0, 0.0], [0.99, 1.0], [5, 5]), block([0.01, 0.0], [0.99, 1.0], [5, 5])]
    wedge = shaped(folder, form, [2, 8], velocity=[0.0, -3.0])
    return case([*blocks, wedge], [floor(2)], end=0.5, step=1e-3)


def needle(folder: Path, cells: int) -> Case:
    """Return a needle that falls on a sheet held at its rim."""
    sheet = block([-0.5, -0.5, 0.0], [1.0, 1.0, 0.1], [cells, cells, 1])
    pin = shaped(
        folder, spike([0.03, 0.02, 0.62], 0.5, down=True), [1, 1, 3], velocity=[0, 0, -3.0]
    )
    rims = [
        fixed("rim-a", [-0.6, -0.6, -0.3], [1.2, 0.2, 0.3]),
        fixed("rim-b", [-0.6, 0.4, -0.3], [1.2, 0.2, 0.3]),
    ]
    return case([sheet, pin], rims, end=0.4, step=1e-3)


@scene
def needle_on_a_coarse_sheet(folder: Path) -> Case:
    """Return the scene: facets much larger than the tip."""
    return needle(folder, 3)


@scene
def needle_on_a_fine_sheet(folder: Path) -> Case:
    """Return the scene: facets about as large as the tip is wide higher up."""
    return needle(folder, 10)


def plate() -> Case:
    """Return a plate of coarse cells, just above 0.3 m."""
    return block([-0.5, -0.5, 0.31], [1.0, 1.0, 0.2], [5, 5, 2])


@scene
def plate_over_a_post(_: Path) -> Case:
    """Return the scene: a coarse plate falls over a post narrower than its cells."""
    return case([plate()], [fixed("post", [-0.08, -0.08, 0.0], [0.16, 0.16, 0.3]), floor(3)])


@scene
def plate_over_a_post_in_the_plane(_: Path) -> Case:
    """Return the scene: the same in the plane."""
    plate = block([-0.5, 0.31], [1.0, 0.2], [5, 2])
    return case([plate], [fixed("post", [-0.08, 0.0], [0.16, 0.3]), floor(2)])


@scene
def plate_across_a_beam(_: Path) -> Case:
    """Return the scene: neither has a node over the other."""
    return case([plate()], [fixed("beam", [-1.0, -0.08, 0.0], [2.0, 0.16, 0.3]), floor(3)])


@scene
def plate_over_a_pyramid(folder: Path) -> Case:
    """Return the scene: a pyramid of triangles under the middle of a coarse plate."""
    base = [[-0.3, -0.3, 0.0], [0.3, -0.3, 0.0], [0.3, 0.3, 0.0], [-0.3, 0.3, 0.0]]
    triangles = [[0, 2, 1], [0, 3, 2], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]
    pyramid = stl(folder, [*base, [0.02, 0.03, 0.3]], triangles, "pyramid")
    return case([plate()], [pyramid, floor(3, -0.001)])


@scene
def block_slides_off_a_table(_: Path) -> Case:
    """Return the scene: it tips over the edge."""
    sliding = block([-0.6, 0.5], [0.4, 0.2], [6, 3], velocity=[2.0, 0.0])
    return case(
        [sliding], [fixed("table", [-2.0, 0.0], [2.0, 0.5]), floor(2)], end=1.0, friction=0.1
    )


@scene
def cliff_edges(_: Path) -> Case:
    """Return the scene: a cube comes down half over the edge of another, edge along edge."""
    below, above = block([0.0] * 3, [1.0] * 3, [3] * 3), block([0.5, 0.0, 1.05], [1.0] * 3, [3] * 3)
    return case([below, above], [floor(3)])


@scene
def internal_edges(_: Path) -> Case:
    """Return the scene: a cube slides over the seam between two cubes that stand side by side."""
    below = [block([float(k), 0.0, 0.0], [1.0] * 3, [2] * 3) for k in range(2)]
    slider = block([0.1, 0.25, 1.0], [0.5] * 3, [2] * 3, velocity=[2.0, 0.0, 0.0])
    return case([*below, slider], [floor(3)], end=0.6, friction=0.1)


def standing(folder: Path, below: Map, above: Map) -> Case:
    """Return one shape that falls on another which stands on the floor."""
    bodies = [
        shaped(folder, below, [2, 2, 4]),
        shaped(folder, above, [2, 2, 4], velocity=[0, 0, -1.0]),
    ]
    return case(bodies, [floor(3)], end=0.8, step=1e-3)


@scene
def spikes(folder: Path) -> Case:
    """Return the scene: tip on tip, nearly."""
    return standing(folder, spike([0, 0, 0], 0.8), spike([0.004, 0.003, 1.62], 0.8, down=True))


@scene
def spike_and_wedge(folder: Path) -> Case:
    """Return the scene: a tip on a ridge."""
    above = spike([0.0, 0.1, 1.62], 0.8, down=True)
    return standing(folder, spike([0, 0, 0], 0.8, ridge=True), above)


@scene
def wedges(folder: Path) -> Case:
    """Return the scene: ridge across ridge."""

    def above(x: np.ndarray) -> np.ndarray:
        form = spike([0.0, 0.0, 1.62], 0.8, down=True, ridge=True)(x)
        return np.stack([-form[:, 1], form[:, 0], form[:, 2]], axis=1)

    return standing(folder, spike([0, 0, 0], 0.8, ridge=True), above)


@scene
def spike_in_a_crack(folder: Path) -> Case:
    """Return the scene: a tip goes into the gap between two blocks."""
    blocks = [
        block([-1.02, -0.5, 0.0], [1.0] * 3, [2] * 3),
        block([0.02, -0.5, 0.0], [1.0] * 3, [2] * 3),
    ]
    above = shaped(folder, spike([0, 0, 1.85], 0.8, down=True), [2, 2, 4], velocity=[0, 0, -1.0])
    return case([*blocks, above], [floor(3)], end=0.8, step=1e-3)


@scene
def wedge_in_a_crack(folder: Path) -> Case:
    """Return the scene: a ridge goes into the gap between two blocks, along it."""
    blocks = [
        block([-1.02, -0.5, 0.0], [1.0] * 3, [2] * 3),
        block([0.02, -0.5, 0.0], [1.0] * 3, [2] * 3),
    ]
    above = spike([0, 0, 1.85], 0.8, down=True, ridge=True)
    body = shaped(folder, above, [2, 2, 4], velocity=[0, 0, -1.0])
    return case([*blocks, body], [floor(3)], end=0.8, step=1e-3)


@scene
def spike_in_a_hole(folder: Path) -> Case:
    """Return the scene: a tip goes into the hole between four rigid posts and a floor."""
    at = [(-0.55, -0.05), (0.05, -0.05), (-0.05, -0.55), (-0.05, 0.05)]
    sizes = [(0.5, 0.1), (0.5, 0.1), (0.1, 0.5), (0.1, 0.5)]
    posts = [
        fixed(f"post-{k}", [*a, 0.0], [*s, 0.6])
        for k, (a, s) in enumerate(zip(at, sizes, strict=True))
    ]
    above = shaped(
        folder, spike([0.0, 0.0, 1.42], 0.8, down=True), [2, 2, 4], velocity=[0, 0, -1.0]
    )
    return case([above], [*posts, floor(3, -0.001)], end=0.8, step=1e-3)


@scene
def ring_through_itself(_: Path) -> Case:
    """Return the scene: a thin ring is thrown at a wall and folds upon itself."""
    ring = {
        "mesh": {
            "kind": "ring",
            "centre": [0.0, 0.0],
            "inner_radius": 0.8,
            "outer_radius": 1.0,
            "divisions": [60, 3],
        },
        "velocity": [15.0, -5.0],
    }
    wall = {"name": "wall", "kind": "plane", "point": [1.1, 0.0], "normal": [-1.0, 0.0]}
    return case([ring], [wall], end=0.3, step=4e-4, friction=0.5, damped=False)


@scene
def folding_strip(_: Path) -> Case:
    """Return the scene: a tall strip buckles under its weight and lies down in folds."""
    strip = block([0.0, 0.0], [0.1, 3.0], [2, 60], velocity=[0.0, 0.0], spin=0.05)
    walls = [
        {"name": "left", "kind": "plane", "point": [-0.5, 0.0], "normal": [1.0, 0.0]},
        {"name": "right", "kind": "plane", "point": [0.6, 0.0], "normal": [-1.0, 0.0]},
    ]
    made = case([strip], [floor(2), *walls], end=1.5, step=2e-3)
    made["materials"]["m"]["young"] = 2e5
    return made


@scene
def sliding_spool(folder: Path) -> Case:
    """Return the scene: a spool slides along two rails, between its flanges."""

    def form(x: np.ndarray) -> np.ndarray:
        across, along = 2.0 * x[:, :2] - 1.0, 2.0 * x[:, 2] - 1.0
        reach, length = np.abs(across).max(axis=1), np.linalg.norm(across, axis=1)
        round_ = (
            across * np.divide(reach, length, out=np.zeros_like(reach), where=length > 0)[:, None]
        )
        radius = np.where(np.abs(along) > 0.55, 0.3, 0.15)
        disc = round_ * radius[:, None]
        return np.stack([disc[:, 0], 0.8 * along, 0.651 + disc[:, 1]], axis=1)

    rails = [
        fixed("left", [-1.0, -0.35, 0.0], [4.0, 0.1, 0.5]),
        fixed("right", [-1.0, 0.25, 0.0], [4.0, 0.1, 0.5]),
    ]
    spool = shaped(folder, form, [4, 4, 8], velocity=[2.0, 0.3, 0.0])
    return case([spool], rails, end=0.8, friction=0.1)


@scene
def house_of_cards(folder: Path) -> Case:
    """Return the scene: thin cards lean on one another in two storeys."""
    length, thin, angle, apart = 1.0, 0.03, np.radians(70.0), 1e-3
    along, across = length * np.cos(angle), thin * np.sin(angle)
    height = length * np.sin(angle) + thin * np.cos(angle)

    def leaning(middle: float, low: float) -> list[Case]:
        aside = 0.5 * (along + across) + apart
        return [
            shaped(
                folder,
                turned(
                    [middle + s * aside, low + height / 2],
                    np.pi / 2 + s * (np.pi / 2 - angle),
                    size,
                ),
                [20, 2],
            )
            for s, size in ((-1, [length, thin]), (1, [length, thin]))
        ]

    pitch = 2.0 * (along + across) + 0.05
    deck = block([-0.15, height + apart], [pitch + 0.3, thin], [20, 2])
    cards = [*leaning(0.0, apart), *leaning(pitch, apart), deck]
    cards += leaning(0.5 * pitch, height + thin + 2.0 * apart)
    made = case(cards, [floor(2)], friction=0.6)
    made["materials"]["m"]["young"] = 2e9
    return made


@scene
def ball_rolls_far(_: Path) -> Case:
    """Return the scene: a ball rolls 100 m over the seams of a fine floor."""
    tops = [[0.1 * k - 1.0, 0.0] for k in range(1030, -1, -1)]
    ground = {"name": "ground", "kind": "polygon", "points": [[-1.0, -1.0], [102.0, -1.0], *tops]}
    mesh = {"kind": "disc", "centre": [0.0, 0.501], "radius": 0.5, "divisions": 8}
    ball = {"mesh": mesh, "velocity": [10.0, 0.0], "spin": -20.0}
    return case([ball, block([-0.95, 0.001], [0.2, 0.2], [2, 2])], [ground], end=10.0, damped=False)


@scene
def square_in_a_notch(folder: Path) -> Case:
    """Return the scene: a square falls on its corner into a dent of a polygon that is narrower."""
    corners = [
        [-1.0, -0.5],
        [1.0, -0.5],
        [1.0, 0.1],
        [0.25, 0.0],
        [0.0, -0.3],
        [-0.2, 0.0],
        [-1.0, 0.0],
    ]
    notch = {"name": "notch", "kind": "polygon", "points": corners}
    form = turned([0.03, 0.75], np.pi / 4, [1.0, 1.0])
    return case([shaped(folder, form, [5, 5])], [notch], end=2.0)


def round_posts(dimension: int, *, bars: bool = False) -> Case:
    """Return a coarse plate that falls on round posts smaller than its facets."""
    places = [[-0.2], [0.2]]
    if dimension == 3 and not bars:
        places = [[x, y] for x in (-0.2, 0.2) for y in (-0.2, 0.2)]
    bar = {"kind": "cylinder", "axis": [0.0, 1.0, 0.0]} if bars else {"kind": "sphere"}
    middle = "point" if bars else "centre"
    rest = [0.0, 0.2] if bars else [0.2]
    posts = [
        {"name": f"post-{k}", "radius": 0.1, **bar, middle: [*at, *rest]}
        for k, at in enumerate(places)
    ]
    aside = dimension - 1
    plate = block([-0.5] * aside + [0.31], [1.0] * aside + [0.2], [5] * aside + [2])
    return case([plate], [*posts, floor(dimension)])


@scene
def plate_on_small_discs(_: Path) -> Case:
    """Return the scene: discs touch a coarse plate between its nodes."""
    return round_posts(2)


@scene
def plate_on_small_balls(_: Path) -> Case:
    """Return the scene: balls touch facets of a coarse plate in their middles."""
    return round_posts(3)


@scene
def plate_on_thin_bars(_: Path) -> Case:
    """Return the scene: bars lie across the edges of its facets."""
    return round_posts(3, bars=True)


@scene
def gmsh_parts_that_interlock(folder: Path) -> Case:
    """Return the scene: a dovetail in its slot is thrown up and takes the other part along.

    Gmsh cuts both into triangles of second order.
    """
    left = [(-1.0, 1.0), (-0.21, 1.0), (-0.41, 0.4)]
    slot = [(-1.0, 0.0), *left, *((-x, z) for x, z in reversed(left)), (1.0, 0.0)]
    left = [(-0.39, 0.411), (-0.2, 0.99), (-0.2, 1.2), (-0.6, 1.2), (-0.6, 1.7)]
    tail = [*left, *((-x, z) for x, z in reversed(left))]
    bodies = []
    for name, corners in (("slot", slot), ("tail", tail)):
        corners.reverse()
        lines = [f"Point({k}) = {{{x}, {z}, 0, 0.2}};" for k, (x, z) in enumerate(corners, 1)]
        count = len(corners)
        lines += [f"Line({k}) = {{{k}, {k % count + 1}}};" for k in range(1, count + 1)]
        lines += [f"Line Loop(1) = {{1:{count}}};", "Plane Surface(1) = {1};"]
        file = folder / f"{name}.geo"
        file.write_text("\n".join(lines))
        bodies.append({"mesh": {"kind": "file", "file": str(file)}})
    bodies[1]["velocity"] = [0.3, 3.0]
    return case(bodies, [floor(2, -0.001)])


def bullet(dimension: int, sizes_per_second: float, *, rigid: bool) -> Case:
    """Return a block shot at a thin wall."""
    size = 0.2
    speed = size * sizes_per_second
    aside = [-size / 2] * (dimension - 1)
    velocity = [0.0] * (dimension - 1) + [-speed]
    shot = block([*aside, 0.25], [size] * dimension, [4] * dimension, velocity=velocity)
    corner, wall = [-0.5] * (dimension - 1) + [-0.02], [1.0] * (dimension - 1) + [0.04]
    bodies, obstacles = [shot], [fixed("wall", corner, wall)]
    if not rigid:
        bodies, obstacles = [shot, block(corner, wall, [8] * (dimension - 1) + [1])], []
    made = case(bodies, obstacles, end=0.6 / speed, step=0.06 / speed, gravity=False, damped=False)
    # What meets it must not be faster than sound in it: that would be another question.
    made["materials"]["m"]["young"] = max(1e6, 1e3 * (10.0 * speed) ** 2)
    return made


def _enter_bullets() -> None:
    for dimension, where in ((2, "in the plane"), (3, "in space")):
        for speed in SPEEDS:
            for rigid in (True, False):
                name = f"bullet {speed} {'rigid' if rigid else 'loose'} {where}"
                SCENES[name] = lambda _, d=dimension, s=speed, r=rigid: bullet(d, s, rigid=r)


_enter_bullets()
