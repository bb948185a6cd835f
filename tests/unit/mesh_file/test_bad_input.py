"""Files that make no body: one message with the place, the value, the fact and the remedy."""

import sys
from unittest.mock import MagicMock

import meshio
import numpy as np
import pytest

from carom.errors import MeshError
from carom.mesh_file import read_body_mesh, read_surface

TETS = np.array([[0, 1, 2, 3], [1, 2, 3, 4]])
POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], dtype=float)


def refusal(mesh, tmp_path, *, name="part.vtu", **given):
    file = tmp_path / name
    if mesh is not None:
        meshio.write(file, mesh)
    options = {"body": None, "scale": 1.0, "space": 3, "key": "bodies.1.mesh"} | given
    with pytest.raises(MeshError) as caught:
        read_body_mesh(file, **options)
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith(f"{caught.value.key} = ")
    return message


def test_a_missing_file_is_named(tmp_path):
    message = refusal(None, tmp_path)
    assert message.startswith(f'bodies.1.mesh.file = "{tmp_path / "part.vtu"}": no such file')


def test_a_name_that_no_file_can_have_is_refused(tmp_path):
    assert ": cannot be read: File name too long" in refusal(None, tmp_path, name="x" * 3000)


def test_a_name_with_a_line_break_is_told_in_one_line(tmp_path):
    message = refusal(None, tmp_path, name="part\n.vtu")
    assert message.startswith(f'bodies.1.mesh.file = "{tmp_path}/part\\n.vtu": no such file')


@pytest.mark.parametrize("name", ["part.msh", "part.vtk", "part.vtu", "part.inp", "part.med"])
def test_what_is_no_mesh_is_refused_and_nothing_is_printed(tmp_path, capfd, name):
    (tmp_path / name).write_text("*ELEMENT, TYPE=C3D8\n1, 2, 3\n" if name.endswith("inp") else "?")
    assert "cannot be read" in refusal(None, tmp_path, name=name)
    assert capfd.readouterr() == ("", "")


def test_a_nastran_file_without_its_end_is_refused(tmp_path):
    meshio.write(tmp_path / "part.bdf", meshio.Mesh(POINTS, [("tetra", TETS)]))
    text = (tmp_path / "part.bdf").read_text()
    (tmp_path / "part.bdf").write_text(text.replace("ENDDATA", "$"))
    assert "has no ENDDATA; is the file cut short?" in refusal(None, tmp_path, name="part.bdf")


def test_node_numbers_that_no_array_holds_are_refused(tmp_path):
    text = f"*NODE\n1,0,0,0\n*ELEMENT, TYPE=C3D4\n1,1,1,1,{10**30}\n"
    (tmp_path / "part.inp").write_text(text)
    assert "cannot be read: " in refusal(None, tmp_path, name="part.inp")


def test_sets_that_do_not_fit_the_cells_are_refused(tmp_path, monkeypatch):
    mesh = meshio.Mesh(POINTS, [("tetra", TETS), ("triangle", TETS[:, :3])])
    mesh.cell_sets = {"part": [np.array([0])]}
    (tmp_path / "part.vtu").touch()
    monkeypatch.setattr(meshio, "read", lambda path: mesh)
    message = refusal(None, tmp_path)
    assert "its set 'part' does not fit its cells; repair the file" in message


def test_an_unknown_format_is_refused(tmp_path):
    (tmp_path / "part.xyz").write_text("?")
    assert "Could not deduce file format" in refusal(None, tmp_path, name="part.xyz")


def test_a_surface_is_no_body(tmp_path):
    mesh = meshio.Mesh(POINTS, [("triangle", TETS[:, :3]), ("line", [[0, 1]])])
    message = refusal(mesh, tmp_path)
    assert "has no volume cells, only 2 triangle, 1 line; set dimension = 2, or mesh" in message


def test_a_volume_is_no_body_in_the_plane(tmp_path):
    mesh = meshio.Mesh(POINTS, [("tetra", TETS), ("triangle", TETS[:, :3])])
    message = refusal(mesh, tmp_path, space=2)
    assert "has cells of 3 dimensions (2 tetra) in a case of 2; set dimension = 3" in message


def test_a_plane_mesh_must_be_plane(tmp_path):
    mesh = meshio.Mesh(POINTS, [("triangle", TETS[:, :3])])
    assert "is not plane: z goes from 0 m to 1 m" in refusal(mesh, tmp_path, space=2)


def test_an_unknown_set_is_answered_with_the_known_ones(tmp_path):
    mesh = meshio.Mesh(POINTS, [("tetra", TETS)], cell_data={"part": [np.array([1, 2])]})
    message = refusal(mesh, tmp_path, body="part:3")
    assert message.startswith('bodies.1.mesh.body = "part:3": no such set of cells; did you mean')
    assert "(known: part:1, part:2)" in message


def test_a_set_of_facets_is_no_body(tmp_path):
    cells = [("tetra", TETS), ("triangle", TETS[:1, :3])]
    mesh = meshio.Mesh(POINTS, cells, cell_data={"part": [np.array([1, 1]), np.array([2])]})
    assert "this set has no volume cells; " in refusal(mesh, tmp_path, body="part:2")


def test_unknown_cells_are_named(tmp_path):
    mesh = meshio.Mesh(POINTS, [("pyramid", [[0, 1, 2, 3, 4]])])
    message = refusal(mesh, tmp_path)
    assert "has 1 pyramid cell, which carom does not know; use tet4, tet10, wedge6" in message


def test_inverted_cells_are_counted(tmp_path):
    points = POINTS.copy()
    points[4] = [0.1, 0.1, 0.1]  # through the side that both cells have
    message = refusal(meshio.Mesh(points, [("tetra", TETS)]), tmp_path)
    assert "1 of 2 cells (tet4 1 from 0 in their order in the file) are inverted or flat" in message


def test_duplicate_cells_are_counted(tmp_path):
    cells = np.vstack([TETS[:1], TETS[:1][:, [1, 2, 0, 3]], TETS[:1]])
    message = refusal(meshio.Mesh(POINTS, [("tetra", cells)]), tmp_path)
    assert "2 tet4 cells with the nodes of another one (1, 2 from 0 in their order" in message


def test_what_is_not_a_number_is_counted(tmp_path):
    points = POINTS.copy()
    points[[1, 3], 0] = np.nan
    message = refusal(meshio.Mesh(points, [("tetra", TETS[:1])]), tmp_path)
    assert "2 points with a coordinate that is not a finite number (1, 3 from 0)" in message


def test_several_parts_in_an_abaqus_file_are_refused(tmp_path):
    (tmp_path / "part.inp").write_text("*Part, name=a\n*End Part\n*Part, name=b\n*End Part\n")
    assert "it has several parts" in refusal(None, tmp_path, name="part.inp")


def test_unknown_elements_of_abaqus_are_named(tmp_path):
    (tmp_path / "part.inp").write_text("*NODE\n1,0,0,0\n*ELEMENT, TYPE=COH3D8\n1,1,1,1,1,1,1,1,1\n")
    assert "elements of type COH3D8 are not known" in refusal(None, tmp_path, name="part.inp")


def test_a_geometry_without_gmsh_says_how_to_get_it(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "gmsh", None)
    (tmp_path / "part.geo").write_text("Sphere(1) = {0, 0, 0, 1};")
    message = refusal(None, tmp_path, name="part.geo")
    assert "is a geometry, which needs Gmsh" in message
    assert 'pip install "carom[gmsh]"' in message


SIDES = np.array(
    [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
)  # of the first tetrahedron, seen from outside


def stl(tmp_path, triangles, *, points=POINTS[:4]):
    file = tmp_path / "surface.stl"
    meshio.write(file, meshio.Mesh(points, [("triangle", triangles)]), binary=True)
    return file


def test_a_closed_surface_is_read_and_points_outward(tmp_path):
    for triangles in (SIDES, SIDES[:, ::-1]):
        surface = read_surface(stl(tmp_path, triangles), scale=2.0, key="obstacles.0")
        assert len(surface.points) == 4
        a, b, c = np.moveaxis(surface.points[surface.triangles], 1, 0)
        assert np.einsum("ij,ij", a, np.cross(b, c)) / 6 == pytest.approx(8 / 6)


@pytest.mark.filterwarnings("error")
def test_a_small_text_file_of_triangles_is_read_without_a_warning(tmp_path):
    """Symptom guarded against: an overflow, where letters were taken for a count of triangles."""
    file = tmp_path / "surface.stl"
    meshio.write(file, meshio.Mesh(POINTS[:4], [("triangle", SIDES)]), binary=False)
    assert len(read_surface(file, scale=1.0, key="obstacles.0").points) == 4


def test_vertices_that_are_no_numbers_are_counted(tmp_path):
    points = POINTS[:4].copy()
    points[3, 0] = np.nan
    with pytest.raises(MeshError, match="has 1 vertex with a coordinate that is not a finite"):
        read_surface(stl(tmp_path, SIDES[:2], points=points), scale=1.0, key="obstacles.0")


@pytest.mark.parametrize(
    ("triangles", "message"),
    [
        (SIDES[:3], "has 3 edges on one triangle only (the first at"),
        (np.vstack([SIDES, [[0, 2, 1]]]), "has 3 edges on more than two triangles"),
        (np.vstack([SIDES[:3], SIDES[3:, ::-1]]), "has 3 edges through which two triangles run"),
    ],
)
def test_a_surface_that_does_not_close_is_refused(tmp_path, triangles, message):
    with pytest.raises(MeshError) as caught:
        read_surface(stl(tmp_path, triangles), scale=1.0, key="obstacles.0")
    assert str(caught.value).startswith('obstacles.0.file = "')
    assert message in str(caught.value)


INP = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT, TYPE=C3D4, ELSET=part\n1,1,2,3,4\n"


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("*ELEMENT, TYPE=C3D4\n2,1,2,3,9\n", "cannot be read: node 9 is not there"),
        ("*ELEMENT, TYPE=C3D4\n2,1,2,3\n", "elements of type C3D4 need 4 nodes each"),
        ("*ELEMENT, TYPE=CAX9\n2,1,2,3\n", "elements of type CAX9 are not known"),
        ("*ELSET, ELSET=tip\n7\n", "element set TIP has element 7, which is not there"),
        ("*ELSET, ELSET=tip\nnose\n", "there is no set nose"),
        ("*SURFACE, NAME=top\n7, S1\n", "surface TOP has element 7, which is not there"),
        ("*SURFACE, NAME=top\n1, S5\n", 'surface TOP has a face "S5", which a tetra does not have'),
        ("*PART\n*END PART\n*PART\n", "it has several parts or moved instances; write one part to"),
    ],
)
def test_a_deck_that_contradicts_itself_is_refused_with_what_is_missing(tmp_path, more, message):
    (tmp_path / "part.inp").write_text(INP + more)
    assert message.lower() in refusal(None, tmp_path, name="part.inp").lower()


def held(points=POINTS, **blocks):
    """A mesh as meshio would hold it, which writers refuse and readers have been seen to return."""
    cells = [meshio.CellBlock(kind, np.array(nodes)) for kind, nodes in blocks.items()]
    mesh = meshio.Mesh(POINTS, [])
    mesh.points, mesh.cells = points, cells
    return mesh


@pytest.mark.parametrize(
    ("mesh", "space", "message"),
    [
        (held(), 3, "holds no cells"),
        (held(None, tetra=TETS), 3, "has no points; repair the file"),
        (held(tetra=[[0, 1, 2]]), 3, "its tetra cells have 3 points; repair the file"),
        (held(tetra=[[0, 1, 2, 9]]), 3, "a tetra cell refers to point 9 of 5"),
        (held(POINTS[:, :2], tetra=TETS), 3, "its points have 2 coordinates, not 3"),
        (
            held(polyhedron4=[[0, 1, 2, 3]]),
            3,
            "has polyhedra, which carom does not know; mesh with tetrahedra or hexahedra",
        ),
        (
            held(pyramid14=[[0, 1, 2, 3]]),
            3,
            "which carom does not know; use ",
        ),
    ],
)
def test_what_a_reader_returns_is_looked_at(tmp_path, monkeypatch, mesh, space, message):
    (tmp_path / "part.vtu").touch()
    monkeypatch.setattr(meshio, "read", lambda path: mesh)
    assert message in refusal(None, tmp_path, space=space)


def test_a_format_whose_package_is_missing_says_which(tmp_path, monkeypatch):
    def read(path):
        raise ModuleNotFoundError("No module named 'netCDF4'", name="netCDF4")

    (tmp_path / "part.e").touch()
    monkeypatch.setattr(meshio, "read", read)
    message = refusal(None, tmp_path, name="part.e")
    assert "reading this format needs the package netCDF4; install it" in message


def test_a_geometry_that_gmsh_cannot_mesh_says_what_gmsh_said(tmp_path, monkeypatch):
    gmsh = MagicMock()
    gmsh.open.side_effect = Exception("Wrong file")
    gmsh.logger.get.return_value = ["Info: Reading", "Error: 'part.geo', line 1: syntax error"]
    monkeypatch.setitem(sys.modules, "gmsh", gmsh)
    (tmp_path / "part.geo").write_text("?")
    message = refusal(None, tmp_path, name="part.geo")
    assert "Gmsh cannot mesh it: Error: 'part.geo', line 1: syntax error" in message


def test_a_surface_out_of_a_file_without_triangles_is_refused(tmp_path):
    file = tmp_path / "surface.vtu"
    meshio.write(file, meshio.Mesh(POINTS, [("tetra", TETS)]))
    with pytest.raises(MeshError, match="has no triangles, but tetra; save the surface as triangl"):
        read_surface(file, scale=1.0, key="obstacles.0")


def test_a_file_without_cells_is_no_riddle(tmp_path):
    (tmp_path / "empty.msh").touch()
    nothing = meshio.Mesh(POINTS, [("tetra", np.zeros((0, 4), dtype=int))])
    for mesh, name in ((None, "empty.msh"), (nothing, "part.vtu")):
        assert "holds no cells; mesh the part" in refusal(mesh, tmp_path, name=name)
