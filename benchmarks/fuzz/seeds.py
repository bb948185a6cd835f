"""The valid input that is spoilt."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np

from carom import case_file
from carom.friction import Problem, write
from carom.template import MESH_FILE, TEMPLATES, template

ROOT = Path(__file__).resolve().parents[2]

EVERYTHING = """
title = "Some of everything"
[analysis]
end_time = 0.01
time_step = 1e-4
scheme = { kind = "theta", theta = 0.6, xi = 0.5 }
newton = { tolerance = 1e-9, max_iterations = 20 }
max_halvings = 2
gravity = [0.0, -9.81]
[output]
fields_every = 1e-3
history_every = 1e-3
merge_contacts = 0.01
track = [{ name = "tip", body = "a", point = [0.0, 0.0] }]
[materials.rubber]
kind = "ogden"
mu = [1e3, -10.0]
alpha = [2.0, -2.0]
bulk = 1e5
density = 1000.0
damping = { mass = 0.1, stiffness = 1e-5 }
viscosity = { shear = 1.0, bulk = 0.5 }
[materials.metal]
kind = "j2-plasticity"
young = 1e6
poisson = 0.3
yield_stress = 1e3
hardening = 1e4
density = 1000.0
[materials.foam]
kind = "blatz-ko"
shear = 1e4
density = 100.0
[[bodies]]
name = "a"
material = "rubber"
mass = "lumped"
thickness = 0.5
formulation = "mean-dilatation"
mesh = { kind = "rectangle", corner = [0.0, 0.0], size = [1.0, 1.0], divisions = [3, 2] }
contact_sets = ["bottom", "left"]
velocity = [0.0, -1.0]
spin = 0.1
[[bodies]]
name = "b"
material = "metal"
hypothesis = "plane-strain"
self_contact = true
mesh = { kind = "ring", centre = [0.5, -1.2], inner_radius = 0.5, outer_radius = 1.0, divisions = [12, 2], cell = "tri6" }
[[bodies]]
name = "c"
material = "foam"
mesh = { kind = "disc", centre = [3.0, 0.0], radius = 0.5, divisions = 2, rings = 1 }
[[obstacles]]
name = "ball"
kind = "sphere"
centre = [3.0, -1.6]
radius = 1.0
motion = { y = "0.01*sin(100*t)" }
[[obstacles]]
name = "wall"
kind = "plane"
point = [-1.0, 0.0]
normal = [1.0, 0.0]
velocity = [0.1, 0.0]
[[loads]]
kind = "pressure"
body = "a"
on = "top"
pressure = { time = [0.0, 1e-3], value = [0.0, 10.0] }
follower = true
[[loads]]
kind = "traction"
body = "a"
on = "right"
traction = ["10*t", 0.0]
[[motions]]
kind = "fixed"
body = "b"
on = "inner"
components = ["y"]
[contact]
condition = "gap"
friction = 0.3
sources = "both"
targets = "faceted"
solver = { kind = "gauss-seidel", tolerance = 1e-10, max_iterations = 500, cross_check = true }
pairs = [{ between = ["a", "b"], friction = 0.5, sources = "first", discretisation = "mortar" }, { between = ["b", "c"], enabled = false }, { between = ["a", "c"], enabled = false }]
"""
"""A case with most of the tables that there are."""

IN_SPACE = """
title = "In space"
dimension = 3
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.5
[materials.soft]
kind = "neo-hookean"
young = 1e5
poisson = 0.4
density = 1000.0
[[bodies]]
name = "block"
material = "soft"
mesh = { kind = "box", corner = [0.0, 0.0, 0.0], size = [1.0, 1.0, 1.0], divisions = [2, 2, 2], cell = "tet4" }
[[bodies]]
name = "tube"
material = "soft"
mesh = { kind = "tube", base = [0.5, 0.5, 1.01], axis = [0.0, 0.0, 1.0], inner_radius = 0.2, outer_radius = 0.4, height = 0.5, divisions = [8, 1, 2] }
[[motions]]
kind = "fixed"
body = "block"
on = "bottom"
[[motions]]
kind = "prescribed"
body = "tube"
on = "top"
x = "0*t"
y = "0*t"
z = "-0.02*t"
[[obstacles]]
name = "post"
kind = "cylinder"
point = [3.0, 0.0, 0.0]
axis = [0.0, 0.0, 1.0]
radius = 0.5
[[obstacles]]
name = "step"
kind = "box"
corner = [-2.0, 0.0, 0.0]
size = [1.0, 1.0, 1.0]
[contact]
friction = 0.2
"""


def cases(folder: Path) -> list[bytes]:
    """Return case files; one refers to a mesh that is written into the folder."""
    examples = sorted((ROOT / "examples").glob("*.toml"))
    texts = [file.read_text(encoding="utf-8") for file in examples]
    texts += [template(name) for name in TEMPLATES if name != MESH_FILE]
    meshio.write(folder / "part.vtu", _hexahedra(2))
    before, _, rest = IN_SPACE.partition('mesh = { kind = "box"')
    in_a_file = before + 'mesh = { file = "part.vtu", scale = 1.0 }' + rest[rest.index("\n") :]
    in_a_file = in_a_file.replace('on = "bottom"', 'on = "all"')
    return [text.encode() for text in (*texts, EVERYTHING, IN_SPACE, in_a_file)]


def case_data(folder: Path) -> list[dict]:
    """Return the same as nested tables."""
    data = []
    for index, text in enumerate(cases(folder)):
        file = folder / f"seed{index}.toml"
        file.write_bytes(text)
        data.append(case_file.read(file))
    return data


FORMATS = {
    "gmsh.msh": {"file_format": "gmsh", "binary": True},
    "gmsh-ascii.msh": {"file_format": "gmsh", "binary": False},
    "gmsh22.msh": {"file_format": "gmsh22", "binary": False},
    "part.vtu": {},
    "part.vtk": {},
    "part.inp": {},
    "part.med": {},
    "part.xdmf": {},
    "part.mesh": {},
    "part.bdf": {},
    "part.unv.vtk": {"binary": False, "file_format": "vtk42"},
}
"""Mesh files by name, with what meshio is told to write them."""


def meshes(folder: Path) -> list[Path]:
    """Write a small part in many formats, and a closed surface."""
    files = []
    for name, options in FORMATS.items():
        mesh = _hexahedra(1)
        if options.get("file_format") == "gmsh":
            mesh.cells = mesh.cells[:1]  # format 4.1 wants to know more of each kind
        meshio.write(folder / name, mesh, **options)
        files.append(folder / name)
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
    for name, binary in (("surface.stl", False), ("surface-binary.stl", True)):
        meshio.write(
            folder / name, meshio.Mesh(points, [("triangle", triangles)]), "stl", binary=binary
        )
        files.append(folder / name)
    return files


def _hexahedra(count: int) -> meshio.Mesh:
    axis = np.linspace(0.0, 1.0, count + 1)
    points = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    n = np.arange(len(points)).reshape((count + 1,) * 3)
    a, b = slice(0, -1), slice(1, None)
    corners = [(a, a, a), (b, a, a), (b, b, a), (a, b, a), (a, a, b), (b, a, b), (b, b, b)]
    cells = np.stack([n[c] for c in [*corners, (a, b, b)]], axis=-1).reshape(-1, 8)
    bottom = n[:, :, 0]
    quads = np.stack([bottom[a, a], bottom[b, a], bottom[b, b], bottom[a, b]], axis=-1)
    return meshio.Mesh(points, [("hexahedron", cells), ("quad", quads.reshape(-1, 4))])


def problems(folder: Path) -> list[Path]:
    """Write a small contact problem, local and in both formats."""
    pick = np.random.default_rng(0)
    root = pick.normal(size=(9, 9))
    problem = Problem(root @ root.T + np.eye(9), pick.normal(size=9) - 1.0, [0.3, 0.0, 0.7])
    files = [folder / "problem.hdf5", folder / "problem.dat"]
    for file in files:
        write(problem, file, title="Three contacts")
    return files
