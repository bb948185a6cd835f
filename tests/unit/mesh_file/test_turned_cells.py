"""Cells that are numbered the other way round are turned; cells that are inside out are refused."""

import meshio
import numpy as np
import pytest

import carom
from carom.building.build import build
from carom.errors import MeshError
from carom.mesh_file import read_body_mesh
from carom.mesh_file.cells import KINDS

PLANE = ["triangle", "triangle6", "quad", "quad8", "quad9"]
SIDES = {
    **{(2, 2): "line", (2, 3): "line3", (3, 3): "triangle", (3, 6): "triangle6"},
    **{(3, 4): "quad", (3, 8): "quad8", (3, 9): "quad9"},
}
SPACE = [kind for kind, of in KINDS.items() if of.dimension == 3]


def native(kind):
    """The native model of a block of some cells of a kind, upright as the core makes them."""
    cell, space = KINDS[kind].name, KINDS[kind].dimension
    mesh = (
        carom.Rectangle(corner=[0, 0], size=[3, 2], divisions=[3, 2], cell=cell)
        if space == 2
        else carom.Box(corner=[0, 0, 0], size=[3, 2, 1], divisions=[3, 2, 1], cell=cell)
    )
    body = carom.Body(name="block", material="steel", mesh=mesh)
    return build(
        carom.Scenario(
            dimension=space,
            analysis=carom.Dynamic(end_time=1.0, time_step=0.1),
            materials={"steel": carom.LinearElastic(young=1e9, poisson=0.3, density=1000.0)},
            bodies=[body],
        )
    )


def block(kind):
    """Points and cells of the block, and the facets of its boundary by their number of nodes."""
    model = native(kind)
    mesh, surface = model.mesh(), model.surface()
    cells = np.array(np.split(mesh["connectivity"], mesh["offsets"][1:-1]))
    facets = np.split(surface["connectivity"], surface["offsets"][1:-1])
    sizes = sorted({len(facet) for facet in facets})
    return mesh["points"], cells, {n: np.array([f for f in facets if len(f) == n]) for n in sizes}


def read(tmp_path, points, blocks, *, space, **sets):
    mesh = meshio.Mesh(points, blocks, **sets)
    meshio.write(tmp_path / "part.vtu", mesh)
    return read_body_mesh(
        tmp_path / "part.vtu", body=None, scale=1.0, space=space, key="bodies.0.mesh"
    )


@pytest.mark.parametrize("kind", [*PLANE, *SPACE])
@pytest.mark.parametrize("which", ["every second", "one", "all but one", "all"])
def test_cells_that_a_file_numbers_the_other_way_round_are_turned(tmp_path, kind, which):
    """Symptom guarded against: "128 of 256 cells are inverted", for triangles of scikit-fem."""
    points, cells, facets = block(kind)
    chosen = {
        "every second": np.s_[::2],
        "one": np.s_[1:2],
        "all but one": np.s_[1:],
        "all": np.s_[:],
    }[which]
    given = cells.copy()
    given[chosen] = cells[chosen][:, KINDS[kind].mirror]
    tags = np.arange(len(cells)) % 2
    space = KINDS[kind].dimension
    arrays = read(
        tmp_path,
        points,
        [(kind, given), *((SIDES[space, n], nodes) for n, nodes in facets.items())],
        space=space,
        cell_data={"part": [tags, *(np.full(len(nodes), 7) for nodes in facets.values())]},
    )
    ((name, turned),) = arrays.blocks
    assert name == KINDS[kind].name
    np.testing.assert_array_equal(turned, cells)
    np.testing.assert_array_equal(arrays.cell_sets["part:1"], np.flatnonzero(tags))
    for named, nodes in zip(arrays.facet_sets["part:7"], facets.values(), strict=True):
        np.testing.assert_array_equal(named, nodes)
    (note,) = arrays.notes
    number = len(range(len(cells))[chosen])
    assert (note.code, note.where, note.value) == ("turned-cells", "bodies.0.mesh.file", number)
    assert f"{number} of {len(cells)} cells ({name} " in note.message
    assert "are numbered the other way round and were turned" in note.message


def test_upright_cells_have_no_note(tmp_path):
    points, cells, _ = block("quad8")
    assert read(tmp_path, points, [("quad8", cells)], space=2).notes == []


@pytest.mark.parametrize("kind", ["triangle", "quad", "tetra", "hexahedron"])
def test_a_node_pushed_through_a_side_is_refused_not_turned(tmp_path, kind):
    """Turned, the cell would have a positive volume, on top of its neighbours."""
    points, cells, _ = block(kind)
    space = KINDS[kind].dimension
    corner = int(np.flatnonzero(np.all(points == 0.0, axis=1))[0])
    if kind in ("triangle", "tetra"):
        points[corner] = 1.3  # beyond the side that faces it
    else:  # all corners of a cell change their sides: it is folded onto its neighbour
        (nodes,) = cells[np.any(cells == corner, axis=1)]
        points[nodes, 0] = 2.0 - points[nodes, 0]
    with pytest.raises(MeshError, match=r"cells \(.* are inverted or flat"):
        read(tmp_path, points, [(kind, cells)], space=space)


def test_a_folded_cell_among_cells_of_both_senses_is_refused(tmp_path):
    points, cells, _ = block("triangle")
    given = cells.copy()
    given[5:] = cells[5:][:, KINDS["triangle"].mirror]
    corner = int(np.flatnonzero(np.all(points == [3.0, 2.0], axis=1))[0])
    points[corner] = [1.7, 0.7]
    with pytest.raises(MeshError, match="inverted or flat"):
        read(tmp_path, points, [("triangle", given)], space=2)


def test_triangles_and_quadrilaterals_of_one_mesh_are_turned_together(tmp_path):
    points = np.array([[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]], dtype=float)
    blocks = [("quad", [[0, 3, 4, 1]]), ("triangle", [[1, 2, 4], [2, 4, 5]])]
    arrays = read(tmp_path, points, blocks, space=2)
    assert [nodes.tolist() for _, nodes in arrays.blocks] == [
        [[0, 1, 4, 3]],
        [[1, 2, 4], [2, 5, 4]],
    ]
    (note,) = arrays.notes
    assert "2 of 3 cells (quad4 0; tri3 1 from 0" in note.message


def test_a_flat_cell_is_refused_whichever_way_it_is_numbered(tmp_path):
    points = np.array([[0, 0], [1, 0], [2, 0], [0, 1]], dtype=float)
    for flat in ([0, 1, 2], [2, 1, 0]):
        blocks = [("triangle", [[0, 2, 3], flat])]
        with pytest.raises(MeshError, match=r"1 of 2 cells \(tri3 1 from 0.*inverted or flat"):
            read(tmp_path, points, blocks, space=2)


def test_med_numbers_every_cell_against_the_sense_of_vtk_which_needs_no_note(tmp_path):
    points, cells, _ = block("tetra")
    pytest.importorskip("h5py")
    given = cells[:, KINDS["tetra"].mirror]
    meshio.write(tmp_path / "part.med", meshio.Mesh(points, [("tetra", given)]))
    options = {"body": None, "scale": 1.0, "space": 3, "key": "bodies.0.mesh"}
    arrays = read_body_mesh(tmp_path / "part.med", **options)
    np.testing.assert_array_equal(arrays.blocks[0][1], cells)
    assert arrays.notes == []
    given[0] = cells[0]
    meshio.write(tmp_path / "part.med", meshio.Mesh(points, [("tetra", given)]))
    assert len(read_body_mesh(tmp_path / "part.med", **options).notes) == 1
