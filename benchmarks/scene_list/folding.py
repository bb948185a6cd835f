"""Bodies that touch themselves, and parts that hold one another."""

from __future__ import annotations

from pathlib import Path

from .making import Case, block, case, floor, scene


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
