"""The valid input that is spoilt."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np

import carom
from carom.case import case_file
from carom.friction import Problem, write
from carom.new.template import MESH_FILE, SCRIPTS, TEMPLATES, template

HERE = Path(__file__).resolve().parent
EXAMPLES = HERE.parents[1] / "examples"


def cases(folder: Path) -> list[bytes]:
    """Return case files; one refers to a mesh that is written into the folder."""
    files = [*sorted(EXAMPLES.glob("*.toml")), HERE / "everything.toml", HERE / "in_space.toml"]
    texts = [file.read_text(encoding="utf-8") for file in files]
    texts += [template(name) for name in TEMPLATES if name not in {MESH_FILE, *SCRIPTS}]
    meshio.write(folder / "part.vtu", _hexahedra(2))
    before, _, rest = texts[len(files) - 1].partition('mesh = { kind = "box"')
    in_a_file = before + 'mesh = { file = "part.vtu", scale = 1.0 }' + rest[rest.index("\n") :]
    in_a_file = in_a_file.replace('on = "bottom"', 'on = "all"')
    return [text.encode() for text in (*texts, in_a_file)]


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
    "part.xdmf": {"data_format": "XML"},
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


SOME_STEPS = (
    *("analysis.end_time=12e-4", "output.fields_every=2e-4", "output.history_every=1e-4"),
    "output.audit=true",
)
"""What makes a short run of everything.toml."""


def stopped(folder: Path) -> Path:
    """Run some of everything, stop it in the middle and return its results."""

    def stop(state: carom.State) -> None:
        if state.time > 5.5e-4:
            raise carom.Stop

    scenario = carom.Scenario.from_toml(HERE / "everything.toml").with_overrides(SOME_STEPS)
    carom.run(scenario, out=folder / "stopped", observers=[carom.Observer(stop)])
    return folder / "stopped"


def finished(folder: Path) -> Path:
    """Run two discs that meet and return the results, which can be audited."""
    scenario = carom.Scenario.from_toml(EXAMPLES / "two_cylinders.toml").with_overrides(
        [
            "analysis.end_time=0.04",
            "bodies.0.mesh.divisions=2",
            "bodies.1.mesh.divisions=2",
            "bodies.1.mesh.centre=[4.01, 4.0]",
            "output.fields_every=1e-2",
            "output.history_every=1e-3",
            "output.audit=true",
            'output.track=[{name = "tip", body = "left", point = [3.0, 4.0]}]',
        ]
    )
    carom.run(scenario, out=folder / "finished")
    return folder / "finished"
