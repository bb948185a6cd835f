"""``carom new``: every template is a case that runs, and no file is lost to it."""

import math
import re
import subprocess
import sys
from pathlib import Path

import jsonschema
import meshio
import numpy as np
import pytest

import carom
from carom import cli
from carom.case import case_file
from carom.case.schema import case_file_schema
from carom.new.mesh_case import MATERIALS, UNITS
from carom.new.template import MESH_FILE, SCRIPTS, TEMPLATES, template


@pytest.fixture
def command(capsys, monkeypatch, tmp_path):
    """Run ``carom new`` in an empty directory; return exit status, stdout and stderr."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        with pytest.raises(SystemExit) as caught:
            cli.app(["new", *map(str, arguments)], prog_name="carom")
        captured = capsys.readouterr()
        return caught.value.code or 0, captured.out, captured.err

    return run


@pytest.fixture
def ran(command, tmp_path):
    """Write a template and run it."""

    def run(name, *options):
        assert command(name, *options)[0] == 0
        return carom.run(carom.Scenario.from_toml(f"{name}.toml"), out=tmp_path / "out")

    return run


def block(sides):
    """Return a mesh of 2 cells along each side, with a set of cells."""
    axes = [np.linspace(0.0, side, 3) for side in sides]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(27, 3)
    n = np.arange(27).reshape(3, 3, 3)
    a, b = slice(0, 2), slice(1, 3)
    corners = [(a, a, a), (b, a, a), (b, b, a), (a, b, a), (a, a, b), (b, a, b), (b, b, b)]
    cells = np.stack([n[c] for c in [*corners, (a, b, b)]], axis=-1).reshape(-1, 8)
    top = n[:, :, 2]
    lid = np.stack([top[a, a], top[b, a], top[b, b], top[a, b]], axis=-1).reshape(-1, 4)
    return meshio.Mesh(
        points,
        [("hexahedron", cells), ("quad", lid)],
        cell_data={"lid": [np.zeros(8, dtype=int), np.ones(4, dtype=int)]},
    )


def test_without_a_name_the_templates_are_listed(command, tmp_path):
    status, out, _ = command()
    assert status == 0
    assert all(name in out for name in TEMPLATES)
    assert list(tmp_path.iterdir()) == []


def test_the_drop_test_bounces(ran):
    summary = ran("drop-test").summary
    assert summary["status"] == "completed"
    (contact,) = summary["contacts"]
    fall = (0.0062 - 0.005583) / 4.43  # the floor is that far below the edge
    assert contact["onset"] == pytest.approx(fall, abs=8e-6)
    assert contact["release"] < 1e-3


def test_two_bodies_spin_away_and_keep_their_momentum(ran):
    result = ran("two-bodies")
    history = result.history
    (contact,) = result.summary["contacts"]
    assert contact["release"] is not None
    # Images of each other under half a turn, but for whose nodes are checked: much the same spin.
    assert history["left.spin"][-1] == pytest.approx(history["right.spin"][-1], rel=0.1)
    assert abs(history["left.spin"][-1]) > 1.0
    for axis in "xy":
        assert abs(history[f"momentum_{axis}"]).max() < 1e-8


def test_the_wall_bounce_loses_what_friction_takes(ran):
    energy = ran("wall-bounce").summary["energy"]
    assert energy["initial"] - energy["final"] == pytest.approx(energy["friction"], rel=1e-9)
    assert energy["friction"] > 0.05 * energy["initial"]


def test_static_hertz_is_near_hertz(ran):
    history = ran("static-hertz").history
    material = case_file.read(Path("static-hertz.toml"))["materials"]["epoxy"]
    modulus = material["young"] / (1.0 - material["poisson"] ** 2)
    hertz = 4.0 / 3.0 * modulus * math.sqrt(1.0) * (80e-6 * history["time"]) ** 1.5
    assert history["normal_force"][-1] == pytest.approx(1.08 * hertz[-1], rel=0.01)


def test_the_press_fit_presses_as_lame_says(ran):
    """Lamé's pressure of long parts of one steel, E δ (c² − b²) / [2 b c² (1 − ν²)]."""
    history = ran("press-fit").history
    inner, outer = 0.02, 0.04
    part = (outer**2 - inner**2) / (2 * inner * outer**2)
    lame = 210e9 * 20e-6 * part / (1 - 0.3**2)
    assert history["normal_force"][-1] == pytest.approx(2 * math.pi * inner * lame, rel=2e-3)


def test_the_seal_presses_as_a_roller_between_plates(ran):
    """Johnson, Contact mechanics (1985), eq. 5.57: δ = 2 P / (π E*) (2 ln(4 R / b) − 1).

    Of small strains; here the cord gives way by a fifth of its height.
    """
    history = ran("seal").history
    plate, radius = 3e6 / (1 - 0.5**2), 0.0025
    force = history["normal_force"][-1] / 2  # both plates press
    half = math.sqrt(4 * force * radius / (math.pi * plate))
    given = 2 * force / (math.pi * plate) * (2 * math.log(4 * radius / half) - 1)
    assert given == pytest.approx(1e-3, rel=0.1)


def test_the_pile_settles_and_its_books_close(ran):
    result = ran("pile")
    history = result.history
    fallen = history["external"][-1]
    assert len(result.scenario.bodies) == 20
    assert history["kinetic"].max() > 0.2 * fallen
    assert history["kinetic"][-1] < 0.1 * fallen
    assert history["friction"][-1] > 0.1 * fallen
    assert result.summary["energy"]["max_defect"] < 1e-9 * fallen


def test_the_rigid_block_is_thrown_back_and_stays_rigid(ran):
    result = ran("rigid")
    (contact,) = result.summary["contacts"]
    assert contact["pair"] == ["block", "pad"]
    assert contact["release"] is not None
    assert not result.ledger["block"]["strain"].any()
    energy = result.summary["energy"]
    assert 0.01 * energy["initial"] < energy["friction"] < 0.1 * energy["initial"]
    assert energy["max_defect"] < 1e-9 * energy["initial"]


@pytest.mark.parametrize(("unit", "material"), [("mm", "epoxy"), ("in", "steel")])
def test_a_part_from_a_file_bounces(ran, tmp_path, unit, material):
    meshio.write(tmp_path / "part.vtu", block([20.0, 10.0, 40.0]))
    options = ["--mesh", tmp_path / "part.vtu", "--unit", unit, "--material", material]
    result = ran(MESH_FILE, *options)
    assert result.summary["status"] == "completed"
    (contact,) = result.summary["contacts"]
    assert contact["release"] is not None
    volume = 20 * 10 * 40 * UNITS[unit] ** 3
    described = carom.check(result.scenario).description["bodies"][0]
    assert described["mass"] == pytest.approx(MATERIALS[material].density * volume)
    text = (tmp_path / f"{MESH_FILE}.toml").read_text(encoding="utf-8")
    assert 'file = "part.vtu"' in text  # relative to the case
    assert '# "lid:1"' in text


def test_a_plane_part_makes_a_plane_case(command, tmp_path):
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    meshio.write(tmp_path / "plate.vtu", meshio.Mesh(points, [("quad", [[0, 1, 2, 3]])]))
    assert command(MESH_FILE, "plate.toml", "--mesh", "plate.vtu")[0] == 0
    scenario = carom.Scenario.from_toml("plate.toml")
    assert scenario.dimension == 2
    assert scenario.obstacles[0].normal == (0.0, 1.0)
    carom.check(scenario)


def test_the_planted_script_lands_its_block_and_its_books_close(command, tmp_path):
    status, out, _ = command("planted")
    assert status == 0
    assert "run it: python planted.py" in out
    ran = subprocess.run([sys.executable, "planted.py"], capture_output=True, text=True, check=True)
    taken, initial = map(float, re.search(r"took ([\d.]+) J of ([\d.]+) J", ran.stdout).groups())
    assert initial == pytest.approx(0.5 * 0.24 * 0.12 * 1000.0 * 2.0)
    # While all of it slides, friction slows it by μ of what turns it round.
    assert 0.1 * initial < taken < 0.5 * initial
    assert float(re.search(r"not explained: (\S+) of", ran.stdout).group(1)) < 2e-12
    certificate, gap = re.search(r"certificate (\S+) J, least gap (\S+) m", ran.stdout).groups()
    assert float(certificate) < 3e-11
    assert float(gap) > -1e-14


@pytest.mark.parametrize("name", [n for n in TEMPLATES if n != MESH_FILE and n not in SCRIPTS])
def test_templates_fit_the_schema_and_draw_no_warning(name, tmp_path):
    (tmp_path / "case.toml").write_text(template(name), encoding="utf-8")
    jsonschema.Draft7Validator(case_file_schema()).validate(case_file.read(tmp_path / "case.toml"))
    assert carom.check(carom.Scenario.from_toml(tmp_path / "case.toml")).warnings == ()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["drop"], "error: no template 'drop'; did you mean \"drop-test\"?"),
        ([MESH_FILE], "error: the template mesh-file needs a mesh; give --mesh FILE"),
        (["drop-test", "--unit", "mm"], "error: --mesh, --unit and --material are of the template"),
        ([MESH_FILE, "--mesh", "absent.msh"], "error: --mesh absent.msh: no such file"),
        ([MESH_FILE, "--mesh", "part.vtu"], "error: bodies.0.mesh.file = "),
        ([MESH_FILE, "--mesh", "x", "--unit", "km"], "error: --unit km: did you mean"),
        (
            [MESH_FILE, "--mesh", "x", "--material", "jelly"],
            "error: --material jelly: known: steel",
        ),
        (["drop-test", "absent/case.toml"], "error: absent/case.toml: there is no directory"),
        (["drop-test", "."], "error: .: is a directory"),
    ],
)
def test_what_cannot_be_written_is_one_line_and_status_2(command, tmp_path, arguments, message):
    (tmp_path / "part.vtu").write_text("?")
    status, out, err = command(*arguments)
    assert (status, out) == (2, "")
    assert err.startswith(message)
    assert err.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["part.vtu"]


def test_a_file_is_replaced_by_force_only(command, tmp_path):
    file = tmp_path / "case.toml"
    file.write_text("mine")
    status, _, err = command("wall-bounce", file)
    assert (status, err.count("\n")) == (2, 1)
    assert "is there already; give --force" in err
    assert file.read_text() == "mine"
    assert command("wall-bounce", file, "--force")[0] == 0
    assert file.read_text(encoding="utf-8") == template("wall-bounce")
