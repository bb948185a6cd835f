"""Cells that lie side by side without common nodes come apart, and that is told."""

import meshio
import numpy as np
import pytest

import carom
from carom.mesh_file.body import read_body_mesh

SIX = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]]
MIDDLES = [[1.5, 0, 0], [2, 0.5, 0], [1.5, 1, 0], [1, 0.5, 0]]
QUAD = [0, 1, 4, 3]
CUBE = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
HEX = [0, 1, 3, 2, 4, 5, 7, 6]


def notes(tmp_path, points, cells, space=2):
    file = tmp_path / "mesh.vtu"
    meshio.write(file, meshio.Mesh(np.array(points, float), cells))
    read = read_body_mesh(file, body=None, scale=1.0, space=space, key="bodies.0.mesh")
    return {note.code: note for note in read.notes}


# Symptom guarded against: a quad4 beside a quad8, a hanging node and nodes that were not merged
# opened a crack, and doctor and run said nothing.
@pytest.mark.parametrize(
    ("code", "points", "cells"),
    [
        ("hanging-nodes", SIX + MIDDLES, {"quad": [QUAD], "quad8": [[1, 2, 5, 4, 6, 7, 8, 9]]}),
        (
            "hanging-nodes",
            [*SIX, [2, 0.5, 0], [1, 0.5, 0]],
            {"quad": [QUAD, [1, 2, 6, 7], [7, 6, 5, 4]]},
        ),
        ("mesh-in-pieces", [*SIX, [1, 0, 0], [1, 1, 0]], {"quad": [QUAD, [6, 2, 5, 7]]}),
    ],
)
def test_a_crack_between_cells_of_the_plane_is_told(tmp_path, code, points, cells):
    found = notes(tmp_path, points, list(cells.items()))
    assert set(found) == {code}
    note = found[code]
    assert note.is_grave and note.where == "bodies.0.mesh.file"
    if code == "hanging-nodes":
        assert "1 node on the inside of sides of cells that do not have them, as at (1, 0.5)" in (
            note.message
        )
    else:
        assert "make 2 pieces that share no node" in note.message
    assert "merge the nodes" in note.remedy and "unbreakable = true" in note.remedy


def test_a_node_in_the_middle_of_a_face_hangs(tmp_path):
    top = [[x, y, 2.0] for y in (0.0, 0.5, 1.0) for x in (0.0, 0.5, 1.0)]
    middle = [[x, y, 1.0] for x, y in ((0.5, 0), (0, 0.5), (0.5, 0.5), (1, 0.5), (0.5, 1))]
    points = [*CUBE, *middle, *top]
    below = np.array([[4, 8, 5], [9, 10, 11], [6, 12, 7]])
    above = 13 + np.arange(9).reshape(3, 3)
    cells = [HEX]
    for j in range(2):
        for i in range(2):
            walk = [(j, i), (j, i + 1), (j + 1, i + 1), (j + 1, i)]
            cells.append([below[w] for w in walk] + [above[w] for w in walk])
    (note,) = notes(tmp_path, points, [("hexahedron", cells)], space=3).values()
    assert (note.code, note.value) == ("hanging-nodes", 5)


def test_meshes_that_hold_together_are_not_told_of(tmp_path):
    assert notes(tmp_path, SIX, [("quad", [QUAD, [1, 2, 5, 4]])]) == {}
    assert notes(tmp_path, SIX, [("quad", [QUAD]), ("triangle", [[1, 2, 5], [1, 5, 4]])]) == {}
    points = np.array(SIX + MIDDLES)[[1, 2, 5, 4, 6, 7, 8, 9]]
    assert notes(tmp_path, points, [("quad8", [list(range(8))])]) == {}
    assert notes(tmp_path, CUBE, [("hexahedron", [HEX])], space=3) == {}


def test_the_doctor_warns_and_a_run_says_so(tmp_path):
    file = tmp_path / "mesh.vtu"
    points = np.array([*SIX, [2, 0.5, 0], [1, 0.5, 0]], float)
    meshio.write(file, meshio.Mesh(points, [("quad", [QUAD, [1, 2, 6, 7], [7, 6, 5, 4]])]))
    scenario = carom.Scenario(
        analysis=carom.Dynamic(end_time=2e-3, time_step=1e-3),
        materials={"e": carom.SaintVenantKirchhoff(young=1e5, poisson=0.3, density=1e3)},
        bodies=[carom.Body(name="b", material="e", mesh=carom.MeshFile(file=str(file)), spin=4.0)],
    )
    with pytest.warns(
        carom.CaromWarning, match=r"1 node on the inside of sides .* merge the nodes"
    ):
        result = carom.run(scenario, out=tmp_path / "out")
    assert "hanging-nodes" in [one.code for one in result.warnings]
    from carom.doctor import examine

    (found,) = (f for f in examine(scenario).findings if "inside of sides" in f.what)
    assert found.level == "warning"
