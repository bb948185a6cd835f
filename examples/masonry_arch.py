"""A masonry arch of loose stones stands by friction and its own weight, and falls where it is thin.

Heyman's thinnest semicircular arch has a thickness of 0.1075 of its mean radius. This one is drawn
with 27 stones of mean radius 1 m; the first is thicker than that, and stands, the second is not.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from tempfile import TemporaryDirectory

import meshio
import numpy as np

import carom

STONES = 27
DEPTH = 0.2  # [m]


def stone(number: int, thickness: float) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes [m] and hexahedra of a stone, straight between its two faces."""
    lattice = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 0.5, 1)], float)
    radius = 1.0 + thickness * (lattice[:, 0] - 0.5)
    angle = np.pi * (1.0 - (number + np.array([0, 1])) / STONES)
    faces = [np.column_stack([radius * np.cos(a), radius * np.sin(a)]) for a in angle]
    across = lattice[:, 2:]
    place = (1.0 - across) * faces[0] + across * faces[1]
    nodes = np.column_stack([place[:, 0], -DEPTH * lattice[:, 1], place[:, 1]])
    first = np.array([0, 1, 4, 3, 6, 7, 10, 9])
    return nodes, np.array([first, first + 1])


def scenario(folder: Path, thickness: float, end_time: float) -> carom.Scenario:
    """Describe the arch; the meshes of its stones are written into a folder."""
    bodies = []
    for number in range(STONES):
        file = folder / f"stone-{number}.vtu"
        nodes, cells = stone(number, thickness)
        meshio.Mesh(nodes, [("hexahedron", cells)]).write(file)
        mesh = carom.MeshFile(file=str(file))
        bodies.append(carom.Body(name=f"stone-{number}", material="stone", mesh=mesh))
    rock = carom.SaintVenantKirchhoff(
        young=1e9,
        poisson=0.2,
        density=2000.0,
        damping=carom.Damping(mass=0.5, stiffness=1e-3),
    )
    return carom.Scenario(
        title="A masonry arch",
        dimension=3,
        analysis=carom.Dynamic(end_time=end_time, time_step=5e-3, gravity=[0.0, 0.0, -9.81]),
        output=carom.Output(fields_every=0.02),
        materials={"stone": rock},
        bodies=bodies,
        obstacles=[carom.Plane(name="ground", point=[0.0, 0.0, 0.0], normal=[0.0, 0.0, 1.0])],
        contact=carom.Contact(friction=1.0),
    )


def main(out: str | Path | None = None, *, end_time: float = 0.6) -> None:
    """Let a thick arch stand and a thin one fall; check how far the crowns come down."""
    directory = Path(out or "results")
    for thickness, stands in ((0.15, True), (0.08, False)):
        with TemporaryDirectory() as folder:
            case = scenario(Path(folder), thickness, end_time)
            result = carom.run(case, out=directory / f"arch-{thickness}", force=True)
            crown = result.fields.body(f"stone-{STONES // 2}")["displacement"][-1][:, 2].mean()
        print(f"thickness {thickness}: after {end_time:g} s the crown is {-crown:.1e} m lower")
        assert (crown > -1e-3) == stands


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path)
    main(parser.parse_args().out)
