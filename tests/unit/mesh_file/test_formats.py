"""Meshes out of files of many formats: cells, sets and units arrive, whatever wrote them."""

import meshio
import numpy as np
import pytest
from meshio._mesh import topological_dimension

from carom.mesh_file import read_body_mesh
from carom.mesh_file.arrays import FileMesh
from carom.mesh_file.body import _body
from carom.mesh_file.cells import KINDS

topological_dimension.setdefault("wedge15", 3)  # which meshio does not know

CUBE = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1, 2)], dtype=float)
HEXES = np.array([[0, 1, 4, 3, 6, 7, 10, 9], [1, 2, 5, 4, 7, 8, 11, 10]])
LEFT = np.array([[0, 6, 9, 3]])
TOP = np.array([[6, 7, 10, 9], [7, 8, 11, 10]])


def two_cubes():
    """Two cubes side by side, of which the left side, the top and the right cube have names."""
    return meshio.Mesh(
        CUBE,
        [("quad", LEFT), ("quad", TOP), ("hexahedron", HEXES[:1]), ("hexahedron", HEXES[1:])],
        cell_data={
            "gmsh:physical": [np.full(n, tag) for n, tag in ((1, 1), (2, 2), (1, 3), (1, 4))],
            "gmsh:geometrical": [np.full(n, tag) for n, tag in ((1, 1), (2, 2), (1, 1), (1, 2))],
        },
        field_data={
            "left": np.array([1, 2]),
            "lid": np.array([2, 2]),
            "near": np.array([3, 3]),
            "far": np.array([4, 3]),
        },
    )


def read(file, **given):
    options = {"body": None, "scale": 1.0, "space": 3, "key": "bodies.0.mesh"} | given
    return read_body_mesh(file, **options)


def as_format_4(mesh, *, save_all=False):
    """Return the text of Gmsh's format 4.1, with an entity and a group for every block.

    With `Mesh.SaveAll` Gmsh writes entities of no group as well: here a point, a line and a side.
    There the far cube is in a second group.
    """
    groups = [(2, 1, "left"), (2, 2, "lid"), (3, 1, "near"), (3, 2, "far")]
    numbers = {"left": "1", "lid": "2", "near": "3", "far": "4"}
    names = [f'{dim} {numbers[name]} "{name}"' for dim, _, name in groups]
    if save_all:
        names.append('3 9 "twin"')
        numbers["far"] = "4 9"
    box = "0 0 0 2 1 1"
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
    lines += names
    lines += ["$EndPhysicalNames", "$Entities", "1 1 3 2" if save_all else "0 0 2 2"]
    if save_all:
        lines += ["1 0 0 0 0", f"1 {box} 0 0"]
    for _, tag, name in groups:
        if save_all and name == "near":
            lines.append(f"3 {box} 0 0")
        lines.append(f"{tag} {box} {len(numbers[name].split())} {numbers[name]} 0")
    lines += ["$EndEntities", "$Nodes", f"1 {len(mesh.points)} 1 {len(mesh.points)}"]
    lines += [f"3 1 0 {len(mesh.points)}", *(str(k + 1) for k in range(len(mesh.points)))]
    lines += [" ".join(map(str, x)) for x in mesh.points]
    loose = 3 if save_all else 0
    count = 5 + loose
    lines += ["$EndNodes", "$Elements", f"{len(mesh.cells) + loose} {count} 1 {count}"]
    number = loose
    if save_all:
        # Types 15, 1 and 3: a point, a line and a quadrilateral.
        lines += ["0 1 15 1", "1 1", "1 1 1 1", "2 1 2", "2 3 3 1", "3 1 2 8 7"]
    for (dim, tag, _), block in zip(groups, mesh.cells, strict=True):
        lines.append(f"{dim} {tag} {3 if dim == 2 else 5} {len(block)}")
        for cell in block.data:
            number += 1
            lines.append(" ".join(map(str, [number, *(cell + 1)])))
    return "\n".join([*lines, "$EndElements", ""])


@pytest.mark.parametrize("version", ["2.2 binary", "2.2", "4.1", "4.1 with all entities"])
def test_physical_groups_of_gmsh_become_sets(tmp_path, version):
    file = tmp_path / "cubes.msh"
    mesh = two_cubes()
    if version.startswith("4.1"):
        file.write_text(as_format_4(mesh, save_all=version.endswith("entities")))
    else:
        meshio.write(file, mesh, file_format="gmsh22", binary=version.endswith("binary"))
    arrays = read(file)
    assert {kind for kind, _ in arrays.blocks} == {"hex8"}
    np.testing.assert_array_equal(np.concatenate([c for _, c in arrays.blocks]), HEXES)
    np.testing.assert_array_equal(arrays.points, CUBE)
    np.testing.assert_array_equal(np.concatenate(arrays.facet_sets["lid"]), TOP)
    np.testing.assert_array_equal(np.concatenate(arrays.facet_sets["left"]), LEFT)
    np.testing.assert_array_equal(arrays.cell_sets["far"], [1])
    assert set(arrays.facet_sets) == {"left", "lid"}
    twin = {"twin"} if version.endswith("entities") else set()
    assert set(arrays.cell_sets) == {"near", "far"} | twin
    assert all(arrays.cell_sets[name].tolist() == [1] for name in twin)

    far = read(file, body="far", scale=1e-3)
    assert len(far.points) == 8
    np.testing.assert_allclose(far.points.min(axis=0), [1e-3, 0, 0])
    np.testing.assert_allclose(far.points.max(axis=0), [2e-3, 1e-3, 1e-3])
    assert "left" not in far.facet_sets
    assert len(np.concatenate(far.facet_sets["lid"])) == 1


def test_gmsh_writes_what_is_read(tmp_path):
    gmsh = pytest.importorskip("gmsh", exc_type=(ImportError, OSError))
    file = tmp_path / "ball.msh"
    for version in (2.2, 4.1):
        gmsh.initialize(readConfigFiles=False, interruptible=False)
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addSphere(0, 0, 0, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(3, [1], name="ball")
        gmsh.model.addPhysicalGroup(2, [1], name="skin")
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.ElementOrder", 2)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.6)
        gmsh.model.mesh.generate(3)
        gmsh.write(str(file))
        gmsh.finalize()
        arrays = read(file, body="ball")
        assert {kind for kind, _ in arrays.blocks} == {"tet10"}
        skin = np.unique(np.concatenate(arrays.facet_sets["skin"]))
        np.testing.assert_allclose(np.linalg.norm(arrays.points[skin], axis=1), 1.0, atol=1e-6)


ABAQUS = """*Heading
** two bricks
*Node, nset=everything
1, 0., 0., 0.
2, 1., 0., 0.
3, 2., 0., 0.
11, 0., 1., 0.
12, 1., 1., 0.
*Node
13, 2., 1., 0.
21, 0., 0., 1.
22, 1., 0., 1.
23, 2., 0., 1.
31, 0., 1., 1.
32, 1., 1., 1.
33, 2., 1., 1.
*Element, type=C3D8R, elset=Bricks
 5,  1, 2, 12, 11, 21, 22,
 32, 31
 7,  2, 3, 13, 12, 22, 23, 33, 32
*Nset, nset=edge, generate
1, 3, 1
*Elset, elset=last
 7,
*Surface, type=ELEMENT, name=Lid
Bricks, S2
*Surface, type=ELEMENT, name=End
last, S4
*Material, name=steel
*Density
 7800.,
"""


def test_sets_and_surfaces_of_abaqus_arrive(tmp_path):
    file = tmp_path / "bricks.inp"
    file.write_text(ABAQUS)
    arrays = read(file, body="bricks".capitalize())
    assert [(kind, cells.shape) for kind, cells in arrays.blocks] == [("hex8", (2, 8))]
    assert arrays.cell_sets["last"].tolist() == [1]
    assert arrays.node_sets["edge"].tolist() == [0, 1, 2]
    lid = arrays.points[np.unique(arrays.facet_sets["Lid"][0])]
    assert len(lid) == 6
    np.testing.assert_array_equal(lid[:, 2], 1.0)
    end = arrays.points[np.unique(arrays.facet_sets["End"][0])]
    np.testing.assert_array_equal(end[:, 0], 2.0)


FACES = {
    "C3D4": np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float),
    "C3D6": np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1.0]]),
    "C3D8": CUBE[[0, 1, 4, 3, 6, 7, 10, 9]],
}


@pytest.mark.parametrize("element", FACES)
def test_faces_of_abaqus_elements_lie_on_their_sides(tmp_path, element):
    corners = FACES[element]
    nodes = "".join(f"{k + 1}, {x}, {y}, {z}\n" for k, (x, y, z) in enumerate(corners))
    count = {"C3D4": 4, "C3D6": 5, "C3D8": 6}[element]
    text = f"*NODE\n{nodes}*ELEMENT, TYPE={element}\n1, "
    text += ", ".join(str(k + 1) for k in range(len(corners)))
    text += "".join(f"\n*SURFACE, NAME=S{k}\n1, S{k}" for k in range(1, count + 1))
    (tmp_path / "one.inp").write_text(text)
    arrays = read(tmp_path / "one.inp")
    seen = set()
    for k in range(1, count + 1):
        facet = arrays.points[arrays.facet_sets[f"S{k}"][0][0]]
        if element == "C3D6":
            assert len(facet) == (3 if k < 3 else 4), "ends first, then what is around"
        normal = np.cross(facet[1] - facet[0], facet[2] - facet[0])
        distance = (corners - facet[0]) @ normal
        assert np.all(distance <= 1e-12) or np.all(distance >= -1e-12), "a side of the convex cell"
        seen.add(tuple(sorted(arrays.facet_sets[f"S{k}"][0][0])))
    assert len(seen) == count


def test_the_middle_of_a_c3d27_comes_before_those_of_its_faces(tmp_path):
    """Symptom guarded against: such a cell was said to be inverted."""
    corners = np.array(
        [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2]]
    )
    edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
    edges += [(k, k + 4) for k in range(4)]
    faces = [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]
    groups = [*((k,) for k in range(8)), *edges, tuple(range(8)), *faces]
    nodes = [corners[list(group)].mean(axis=0) for group in groups]
    text = "*NODE\n" + "".join(f"{k}, {x}, {y}, {z}\n" for k, (x, y, z) in enumerate(nodes, 1))
    text += "*ELEMENT, TYPE=C3D27\n1, " + ", ".join(map(str, range(1, 28)))
    text += "".join(f"\n*SURFACE, NAME=S{k}\n1, S{k}" for k in range(1, 7))
    (tmp_path / "one.inp").write_text(text)
    arrays = read(tmp_path / "one.inp")
    ((kind, cells),) = arrays.blocks
    assert kind == "hex27"
    middles = [[0, 1, 1], [2, 1, 1], [1, 0, 1], [1, 2, 1], [1, 1, 0], [1, 1, 2], [1, 1, 1]]
    assert np.array_equal(arrays.points[cells[0][20:]], middles), "as VTK numbers them"
    for k, face in enumerate(faces, 1):
        side = corners[list(face)]
        across = int(np.flatnonzero(np.ptp(side, axis=0) == 0)[0])
        (facet,) = arrays.facet_sets[f"S{k}"]
        on = np.flatnonzero(arrays.points[:, across] == side[0, across])
        assert len(on) == 9
        assert sorted(facet[0]) == on.tolist()


def test_families_of_med_become_sets(tmp_path):
    mesh = two_cubes()
    mesh = meshio.Mesh(
        CUBE,
        [("quad", np.vstack([LEFT, TOP])), ("hexahedron", HEXES)],
        cell_data={"cell_tags": [np.array([-1, -2, -2]), np.array([-3, -4])]},
        point_data={"point_tags": np.array([1, *[0] * 11])},
    )
    mesh.cell_tags = {-1: ["left"], -2: ["lid"], -3: ["part"], -4: ["part", "far"]}
    mesh.point_tags = {1: ["origin"]}
    meshio.write(tmp_path / "cubes.med", mesh)
    arrays = read(tmp_path / "cubes.med", body="part")
    assert arrays.cell_sets["part"].tolist() == [0, 1]
    assert arrays.cell_sets["far"].tolist() == [1]
    assert len(arrays.facet_sets["lid"][0]) == 2
    assert arrays.node_sets["origin"].tolist() == [0]


def test_blocks_and_node_sets_of_exodus_arrive(tmp_path):
    """Names of blocks and side sets do not: meshio passes over them."""
    pytest.importorskip("netCDF4")
    blocks = [("hexahedron", HEXES[:1]), ("hexahedron", HEXES[1:])]
    file = tmp_path / "cubes.e"
    meshio.write(file, meshio.Mesh(CUBE, blocks, point_sets={"edge": np.array([0, 3])}))
    arrays = read(file, scale=1e-3)
    np.testing.assert_array_equal(np.concatenate([c for _, c in arrays.blocks]), HEXES)
    np.testing.assert_allclose(arrays.points, 1e-3 * CUBE)
    assert arrays.node_sets["edge"].tolist() == [0, 3]


@pytest.mark.parametrize("ending", ["vtk", "vtu"])
def test_integer_data_of_vtk_become_sets(tmp_path, ending):
    mesh = meshio.Mesh(CUBE, [("hexahedron", HEXES)], cell_data={"part": [np.array([7, 8])]})
    meshio.write(tmp_path / f"cubes.{ending}", mesh)
    arrays = read(tmp_path / f"cubes.{ending}", body="part:8")
    assert len(arrays.points) == 8
    assert arrays.cell_sets["part:8"].tolist() == [0]


def test_a_plane_mesh_loses_its_third_coordinate():
    points = np.array([[0, 0, 5], [1, 0, 5], [1, 1, 5], [0, 1, 5], [9, 9, 5]], dtype=float)
    cells = [("quad", [[0, 1, 2, 3]]), ("line", [[0, 1]]), ("vertex", [[2]])]
    cell_sets = {"floor": [[], [0], []], "tip": [[], [], [0]]}
    raw = FileMesh(
        points,
        [(kind, np.array(nodes)) for kind, nodes in cells],
        cell_sets={name: [np.array(c, dtype=int) for c in s] for name, s in cell_sets.items()},
    )
    arrays = _body(raw, None, 2.0, 2)
    np.testing.assert_array_equal(arrays.points, 2.0 * points[:4, :2])
    assert arrays.facet_sets["floor"][0].tolist() == [[0, 1]]
    assert arrays.node_sets["tip"].tolist() == [2]


@pytest.mark.parametrize(
    "kind", ["tetra", "tetra10", "hexahedron", "hexahedron20", "wedge", "wedge15"]
)
def test_cells_numbered_the_other_way_round_are_turned(tmp_path, kind):
    """MED counts the nodes of a cell against VTK's sense."""
    box = unit_cell(kind)
    mirrored = box.cells[0].data[:, KINDS[kind].mirror]
    meshio.write(tmp_path / "cell.vtu", meshio.Mesh(box.points, [(kind, mirrored)]))
    turned = read(tmp_path / "cell.vtu").blocks[0][1]
    meshio.write(tmp_path / "cell.vtu", box)
    np.testing.assert_array_equal(turned, read(tmp_path / "cell.vtu").blocks[0][1])


def unit_cell(kind):
    """One cell with every middle node where the mean of its neighbours is."""
    corners = {
        "tetra": FACES["C3D4"],
        "hexahedron": FACES["C3D8"],
        "wedge": FACES["C3D6"],
    }[kind.rstrip("0123456789")]
    edges = {
        "wedge15": [
            *[(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3)],
            *[(0, 3), (1, 4), (2, 5)],
        ],
        "tetra10": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
        "hexahedron20": [
            *[(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)],
            *[(0, 4), (1, 5), (2, 6), (3, 7)],
        ],
    }.get(kind, [])
    points = np.vstack([corners, *[(corners[a] + corners[b]) / 2 for a, b in edges]])
    return meshio.Mesh(points, [(kind, np.arange(len(points))[None])])


@pytest.mark.parametrize("kind", ["tetra10", "hexahedron20", "wedge15"])
def test_a_mirrored_cell_keeps_its_shape(kind):
    """Mirroring the numbers and the coordinates gives the same cell."""
    points = unit_cell(kind).points
    mirrored = points[list(KINDS[kind].mirror)]
    np.testing.assert_allclose(mirrored[:, [1, 0, 2]], points, atol=1e-15)
