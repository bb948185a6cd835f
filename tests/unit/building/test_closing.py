"""Overlaps that the numbers of a mesh file cannot tell from touching are closed, others refused."""

import meshio
import numpy as np
import pytest

import carom
from carom.building.build import build
from carom.errors import InputError
from carom.mesh_file.precision import precision


def block(corner, size, divisions, *, turn=0.0):
    """Points and cells of an upright block of quadrilaterals or hexahedra."""
    space = len(corner)
    axes = [np.linspace(c, c + s, d + 1) for c, s, d in zip(corner, size, divisions, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, space)
    number = np.arange(len(points)).reshape([d + 1 for d in divisions])
    offsets = [(0, 0), (1, 0), (1, 1), (0, 1)]
    if space == 3:
        offsets = [(*o, k) for k in (0, 1) for o in offsets]
    parts = [
        number[tuple(slice(o, o + d) for o, d in zip(offset, divisions, strict=True))].ravel()
        for offset in offsets
    ]
    rotation = np.eye(space)
    rotation[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    return points @ rotation.T, np.stack(parts, axis=1)


def write(file, points, cells, form):
    """An Abaqus file with numbers of this form."""
    kind = "CPE4" if points.shape[1] == 2 else "C3D8"
    lines = ["*NODE"]
    lines += [", ".join([str(k + 1), *(form % c for c in x)]) for k, x in enumerate(points)]
    lines += [f"*ELEMENT, TYPE={kind}"]
    lines += [", ".join(map(str, [k + 1, *(c + 1)])) for k, c in enumerate(cells)]
    file.write_text("\n".join(lines) + "\n")
    return {"file": str(file)}


def scenario(space, meshes, *, obstacles=(), **analysis):
    return carom.Scenario.from_dict(
        {
            "dimension": space,
            "analysis": {"end_time": 2e-3, "time_step": 1e-3, **analysis},
            "materials": {
                "m": {"kind": "neo-hookean", "young": 2e9, "poisson": 0.3, "density": 2000.0}
            },
            "bodies": [{"name": n, "material": "m", "mesh": m} for n, m in meshes.items()],
            "obstacles": list(obstacles),
            "contact": {"condition": "gap"},
        }
    )


@pytest.mark.parametrize("space", [2, 3])
def test_an_overlap_of_a_micrometre_in_20_m_is_closed_with_a_note(tmp_path, space):
    """Symptom guarded against: a mesh of seven digits was refused for what its digits did."""
    points, cells = block([19.1] * (space - 1) + [9.0], [0.7] * space, [3] * space)
    points[:, -1] -= 1e-6
    below = block([19.0] * (space - 1) + [8.0], [1.0] * space, [2] * space)
    meshes = {
        "below": write(tmp_path / "below.inp", *below, "%.7g"),
        "above": write(tmp_path / "above.inp", points, cells, "%.7g"),
    }
    case = scenario(space, meshes)
    notes = []
    native = build(case, notes)
    (note,) = notes
    assert (note.code, note.where) == ("closed-overlap", "bodies.1.mesh.file")
    assert note.value == pytest.approx(1e-6, rel=1e-3)
    assert "nodes of above were moved out of below by 1e-06 m or less" in note.message
    (pair,) = native.describe()["pairs"]
    assert abs(pair["initial_gap"]) < 1e-12


def test_two_bodies_that_are_closed_stay_at_rest(tmp_path):
    points, cells = block([19.1, 9.0], [0.7, 0.7], [3, 3])
    points[:, 1] -= 1e-6
    below = block([19.0, 8.0], [1.0, 1.0], [2, 2])
    case = scenario(
        2,
        {
            "below": write(tmp_path / "below.inp", *below, "%.7g"),
            "above": write(tmp_path / "above.inp", points, cells, "%.7g"),
        },
    )
    with pytest.warns(UserWarning, match="4 nodes of above were moved out of below by 1e-06 m"):
        result = carom.run(case, out=tmp_path / "run")
    energy = result.history["total"]
    assert np.max(np.abs(energy)) < 1e-18  # of 2e9 Pa · (1e-6)² m³: 2e-3 J came out of the overlap


OBSTACLES = {
    "plane": {"kind": "plane", "point": [0.0, 9.0], "normal": [0.0, 1.0]},
    "box": {"kind": "box", "corner": [0.0, 1.0], "size": [40.0, 8.0]},
    "sphere": {"kind": "sphere", "centre": [19.1, 4.0], "radius": 5.0},
    "cavity": {"kind": "sphere", "centre": [19.45, 1e6 + 9.0], "radius": 1e6, "cavity": True},
}


@pytest.mark.parametrize("kind", OBSTACLES)
def test_a_body_is_moved_out_of_an_obstacle(tmp_path, kind):
    points, cells = block([19.1, 9.0], [0.7, 0.7], [3, 3])
    points[:, 1] -= 1e-6
    mesh = write(tmp_path / "part.inp", points, cells, "%.7g")
    notes = []
    case = scenario(2, {"part": mesh}, obstacles=[{"name": "floor", **OBSTACLES[kind]}])
    native = build(case, notes)
    (note,) = notes
    assert "nodes of part were moved out of floor by " in note.message
    (pair,) = native.describe()["pairs"]
    assert abs(pair["initial_gap"]) < 2e-10


def test_a_body_is_moved_out_of_a_surface_of_triangles(tmp_path):
    """Symptom guarded against: what a file's digits did was refused in front of such obstacles."""
    corners, quads = block([19.0, 19.0, 8.0], [1.0] * 3, [1] * 3)
    sides = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    triangles = [quads[0][list(t)] for a, b, c, d in sides for t in ((a, b, c), (a, c, d))]
    meshio.write(tmp_path / "floor.stl", meshio.Mesh(corners, [("triangle", np.array(triangles))]))
    points, cells = block([19.1, 19.1, 9.0], [0.7] * 3, [3] * 3)
    points[:, 2] -= 1e-6
    mesh = write(tmp_path / "part.inp", points, cells, "%.7g")
    floor = {"name": "floor", "kind": "surface", "file": str(tmp_path / "floor.stl")}
    notes = []
    native = build(scenario(3, {"part": mesh}, obstacles=[floor]), notes)
    (note,) = notes
    assert "16 nodes of part were moved out of floor by 1e-06 m" in note.message
    (pair,) = native.describe()["pairs"]
    assert abs(pair["initial_gap"]) < 1e-12


def test_a_generated_body_makes_the_sides_of_a_file_give_way(tmp_path):
    below = block([19.0, 8.0], [1.0, 1.0], [1, 1])
    below[0][:, 1] += 1e-6
    box = {"kind": "rectangle", "corner": [19.4, 9.0], "size": [0.2, 0.2], "divisions": [2, 2]}
    mesh = write(tmp_path / "below.inp", *below, "%.7g")
    notes = []
    native = build(scenario(2, {"below": mesh, "above": box}), notes)
    assert [note.where for note in notes] == ["bodies.0.mesh.file"]
    assert native.mesh()["points"][-9:, 1].min() == 9.0, "what is generated stays where it is"


@pytest.mark.parametrize(
    ("overlap", "form"),
    [
        (1e-4, "%.7g"),  # deeper than seven digits tell
        (1e-6, "%.17g"),  # told by every digit
    ],
)
def test_an_overlap_that_the_numbers_mean_is_refused(tmp_path, overlap, form):
    rng = np.random.default_rng(1)
    noise = 1e-3 * rng.random(16) if form == "%.17g" else np.zeros(16)
    points, cells = block([19.1, 9.0 - overlap], [0.7, 0.7], [3, 3])
    points[:, 0] += noise
    below, cells_below = block([19.0, 8.0], [1.0, 1.0], [2, 2])
    below[:, 0] += noise[:9]
    meshes = {
        "below": write(tmp_path / "below.inp", below, cells_below, form),
        "above": write(tmp_path / "above.inp", points, cells, form),
    }
    notes = []
    with pytest.raises(InputError, match="overlap at the start") as caught:
        build(scenario(2, meshes), notes)
    assert caught.value.key in {"bodies.0.mesh", "bodies.1.mesh"}
    assert notes == []


def test_precision_is_that_of_the_last_digit():
    rng = np.random.default_rng(0)
    exact = 20.0 * rng.random((50, 3))
    written = {n: np.array([[float(f"{c:.{n}g}") for c in x] for x in exact]) for n in range(7, 13)}
    for digits, points in written.items():
        assert precision(points) == pytest.approx(0.5 * 10.0 ** (2 - digits))
    assert precision(exact) == 0.0
    assert precision(np.zeros((2, 2))) == 0.0
    # Symptom guarded against: a warning of an overflow beside the message on a mesh of no size.
    assert precision(np.array([[0.0, 2e-322], [1e-300, 4e-323]])) == 0.0
    single = exact.astype(np.float32)
    last_bit = 0.5 * 2.0**-19  # of numbers between 16 and 32
    assert precision(single.astype(float)) == pytest.approx(last_bit)
    nine = np.array([[float(f"{c:.9g}") for c in x] for x in single])
    assert precision(nine) == pytest.approx(last_bit)


def test_precision_is_in_metres(tmp_path):
    points, cells = block([19.1, 9.0], [0.7, 0.7], [3, 3])
    meshio.write(tmp_path / "part.vtu", meshio.Mesh(points.astype(np.float32), [("quad", cells)]))
    arrays = carom.mesh_file.read_body_mesh(
        tmp_path / "part.vtu", body=None, scale=1e-3, space=2, key="k"
    )
    assert 1e-10 < arrays.precision < 1e-8
