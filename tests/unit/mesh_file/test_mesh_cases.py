"""Cases with meshes from files: found beside the case, runnable again, refused before a run."""

import meshio
import numpy as np
import pytest
from typer.testing import CliRunner

import carom
from carom.cli import app

CASE = """dimension = 3
title = "brick"
[analysis]
end_time = 2e-3
time_step = 1e-3
scheme = { kind = "theta" }
[materials.rubber]
kind = "neo-hookean"
young = 1e6
poisson = 0.3
density = 1e3
[[bodies]]
name = "brick"
material = "rubber"
mesh = { file = "brick.vtu", scale = 1e-3 }
velocity = [0.0, 0.0, -1.0]
[[obstacles]]
name = "floor"
kind = "plane"
point = [0.0, 0.0, -0.001]
normal = [0.0, 0.0, 1.0]
"""


@pytest.fixture
def case(tmp_path):
    points = np.array([[x, y, z] for z in (0, 50) for y in (0, 50) for x in (0, 50)], dtype=float)
    cells = [("hexahedron", [[0, 1, 3, 2, 4, 5, 7, 6]]), ("quad", [[0, 2, 3, 1]])]
    data = {"part": [np.array([1]), np.array([2])]}
    meshio.write(tmp_path / "brick.vtu", meshio.Mesh(points, cells, cell_data=data))
    file = tmp_path / "brick.toml"
    file.write_text(CASE)
    return file


def command(*arguments):
    return CliRunner().invoke(app, [str(a) for a in arguments])


def test_a_mesh_is_found_beside_its_case_from_anywhere(case, tmp_path, monkeypatch):
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    answer = command("run", case, "--out", "first")
    assert answer.exit_code == 0, answer.output
    summary = carom.Result.open("first").summary
    assert summary["dofs"] == 24

    again = command("run", elsewhere / "first" / "case.toml", "--out", "second")
    assert again.exit_code == 0, again.output
    first, second = (carom.Result.open(d).history["kinetic"] for d in ("first", "second"))
    np.testing.assert_array_equal(first, second)


def test_sets_of_the_file_are_sets_of_the_body(case):
    case.write_text(CASE.replace("velocity", 'contact_sets = ["part:2"]\nvelocity'))
    assert command("check", case).exit_code == 0


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("brick.vtu", "block.vtu", 'block.vtu": no such file; paths in a case file are relative'),
        ("brick.vtu", "brick.toml", "Could not deduce file format"),
        ("scale = 1e-3", 'body = "part"', 'bodies.0.mesh.body = "part": no such set of cells; did'),
        ("scale = 1e-3", 'body = "part:2"', "this set has no volume cells; "),
        ("scale = 1e-3", "scale = 0", "bodies.0.mesh.scale = 0: must be greater than 0"),
        ("scale = 1e-3", "size = 1", "bodies.0.mesh.size: unknown key"),
        ("velocity", 'contact_sets = ["lid"]\nvelocity', "known"),
        ("dimension = 3", "dimension = 2", "bodies.0."),
    ],
)
def test_what_cannot_be_run_is_said_in_one_line_before_anything_is_written(
    case, tmp_path, old, new, message
):
    case.write_text(CASE.replace(old, new, 1))
    answer = command("run", case, "--out", tmp_path / "out")
    assert answer.exit_code == 2
    assert message in answer.output
    assert answer.output.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_file_in_millimetres_is_suspected(case):
    case.write_text(CASE.replace(", scale = 1e-3", "").replace("-0.001", "-1.0"))
    assert "warning" not in command("check", case).output
    big = CASE.replace("scale = 1e-3", "scale = 2").replace("-0.001", "-1.0")
    case.write_text(big)
    for answer in (command("check", case), command("run", case, "--out", case.parent / "out")):
        assert (
            "warning: body brick is 173.2 m large; if its file is in millimetres, set scale = 0.002"
            in answer.output
        )


@pytest.mark.parametrize(("young", "speed"), [("210.0", "0.532"), ("2.1e17", "1.68e+07")])
def test_moduli_in_other_units_are_suspected(case, young, speed):
    case.write_text(CASE.replace("young = 1e6", f"young = {young}"))
    output = command("check", case).output
    assert f"warning: body brick: waves run at {speed} m/s in materials.rubber" in output
    assert "give moduli in Pa and density (1000) in kg/m³" in output


def test_a_brick_falls_on_a_surface_out_of_a_file(case):
    """A flat tetrahedron with its face at z = −0.001 m is the floor, whose thickness is plenty."""
    points = np.array([[-500, -500, -1], [900, -500, -1], [-500, 900, -1], [0, 0, -900]], float)
    sides = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [0, 2, 3]]
    meshio.write(case.parent / "floor.stl", meshio.Mesh(points, [("triangle", sides)]), binary=True)
    plane = 'kind = "plane"\npoint = [0.0, 0.0, -0.001]\nnormal = [0.0, 0.0, 1.0]\n'
    assert plane in CASE
    energies = []
    for floor in (plane, 'kind = "surface"\nfile = "floor.stl"\nscale = 1e-3\n'):
        case.write_text(CASE.replace(plane, floor).replace("end_time = 2e-3", "end_time = 5e-3"))
        answer = command("run", case, "--force", "--out", case.parent / "out")
        assert answer.exit_code == 0, answer.output
        energies.append(carom.Result.open(case.parent / "out").history["kinetic"])
    np.testing.assert_allclose(energies[0], energies[1], rtol=1e-9)
    assert energies[0].min() < 0.99 * energies[0][0], "it has hit the floor"


def test_an_open_surface_is_no_obstacle(case):
    mesh = meshio.Mesh(np.eye(3), [("triangle", [[0, 1, 2]])])
    meshio.write(case.parent / "floor.stl", mesh, binary=True)
    start = CASE.index("[[obstacles]]")
    surface = '[[obstacles]]\nname = "floor"\nkind = "surface"\nfile = "floor.stl"\n'
    case.write_text(CASE[:start] + surface)
    answer = command("check", case)
    assert answer.exit_code == 2
    assert "obstacles.0.file = " in answer.output
    assert "has 3 edges on one triangle only" in answer.output


def test_what_was_done_to_a_mesh_is_told_by_every_way_to_run_it(case, tmp_path):
    """One line on the terminal, and a warning in Python."""
    mesh = meshio.read(tmp_path / "brick.vtu")
    nodes = [f"{k + 1}, {x}, {y}, {z}" for k, (x, y, z) in enumerate(mesh.points)]
    (hexahedron,) = mesh.cells_dict["hexahedron"] + 1
    other = [4, 3, 2, 1, 8, 7, 6, 5]  # the same cell, numbered the other way round
    turned = hexahedron[np.array(other) - 1]
    deck = ["*NODE", *nodes, "*ELEMENT, TYPE=C3D8", ", ".join(map(str, [1, *turned]))]
    deck += ["*ELEMENT, TYPE=SPRINGA", "2, 1, 2", "3, 2, 3"]
    (tmp_path / "brick.inp").write_text("\n".join(deck))
    case.write_text(CASE.replace("brick.vtu", "brick.inp"))
    told = [
        "left out 2 SPRINGA elements, which fill no",
        "1 of 1 cell (hex8 0 from 0 in their order",
    ]
    for how in ("run", "check"):
        answer = command(how, case, *(["--out", tmp_path / how] if how == "run" else []))
        assert answer.exit_code == 0, answer.output
        said = [line for line in answer.output.splitlines() if line.startswith("warning: ")]
        for text in told:
            assert sum(text in line for line in said) == 1
    with pytest.warns(UserWarning, match="brick.inp") as heard:
        carom.run(carom.Scenario.from_toml(case), out=tmp_path / "python")
    for text in told:
        assert sum(text in str(warning.message) for warning in heard) == 1
