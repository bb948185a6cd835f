"""The examples run, assert their numbers, and say the same as their case files."""

import importlib.util
from pathlib import Path

import meshio
import numpy as np
import pytest

import carom
from carom import Scenario


@pytest.fixture
def example(examples):
    def load(name):
        spec = importlib.util.spec_from_file_location(name, examples / f"{name}.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module

    return load


def test_python_describes_what_the_case_files_describe(example, examples):
    cylinders = example("two_cylinders").scenario
    for python, case in (
        (example("two_bars").scenario(), "two_bars.toml"),
        (cylinders(friction=0.2), "two_cylinders.toml"),
        (cylinders(friction=0.0), "two_cylinders_frictionless.toml"),
        (example("oblique_layer").scenario(), "oblique_layer.toml"),
    ):
        assert python == Scenario.from_toml(examples / case)


@pytest.mark.parametrize("name", ["two_bars", "two_cylinders"])
def test_example_asserts_its_numbers(example, tmp_path, name):
    example(name).main(tmp_path)


def test_a_layer_sticks_or_slips_as_is_known_exactly(example, tmp_path):
    with pytest.warns(carom.CaromWarning, match="waves run at 2 m/s"):  # it has no units
        example("oblique_layer").main(tmp_path)


def test_a_thin_masonry_arch_falls_and_a_thick_one_does_not(example, tmp_path):
    with pytest.warns(carom.CaromWarning, match="waves will not be resolved"):
        example("masonry_arch").main(tmp_path, end_time=0.1)


def test_a_shaft_presses_on_its_hub_as_lame_says(examples, tmp_path):
    """Lamé's pressure of long parts, E δ (c² − b²) / [2 b c² (1 − ν²)], over 1 m of depth."""
    result = carom.run(Scenario.from_toml(examples / "press_fit.toml"), out=tmp_path / "fit")
    inner, outer, interference = 0.02, 0.04, 20e-6
    pressure = 210e9 * interference * (outer**2 - inner**2) / (2 * inner * outer**2 * (1 - 0.3**2))
    measured = result.history["normal_force"][-1] / (2 * np.pi * inner)
    assert measured == pytest.approx(pressure, rel=1e-3)


# Steps of the pile are long for its waves: it is about grains that come to rest.
@pytest.mark.filterwarnings("ignore:.*waves will not be resolved")
@pytest.mark.parametrize("name", ["thrown_ring", "pile"])
def test_cases_of_the_readme_run(examples, tmp_path, name):
    case = Scenario.from_toml(examples / f"{name}.toml")
    short = case.with_overrides([f"analysis.end_time={30 * case.analysis.time_step}"])
    result = carom.run(short, out=tmp_path / "run")
    assert result.summary["status"] == "completed"
    # The pile starts from rest: its energy is what gravity has done.
    scale = result.history["total"].max()
    assert result.summary["energy"]["max_defect"] < 1e-9 * scale


def test_a_part_that_gmsh_meshes_falls_on_the_floor(example, examples, tmp_path):
    """The first steps on a coarse mesh; in full the example takes minutes."""
    pytest.importorskip("gmsh", exc_type=(ImportError, OSError))
    geometry = tmp_path / "bracket.geo"
    text = (examples / "bracket.geo").read_text(encoding="utf-8")
    geometry.write_text(text.replace("h = 1.6;", "h = 9;"), encoding="utf-8")
    scenario = example("gmsh_part").scenario(geometry, end_time=4e-5)
    result = carom.run(scenario, out=tmp_path / "out")
    energy = result.summary["energy"]
    assert result.summary["contacts"][0]["pair"] == ["bracket", "floor"]
    assert 0.9 * energy["initial"] < energy["final"] < 1.001 * energy["initial"]


def test_a_side_that_leaves_a_tangent_plane_at_right_angles_is_drawn(example, tmp_path):
    """Symptom guarded against: no number where the bracket of the gallery comes near itself."""
    mesh = Path(__file__).parents[1] / "docs" / "gallery" / "bracket.msh"
    scenario = example("gmsh_part").scenario(mesh, end_time=8e-6)
    result = carom.run(scenario, out=tmp_path)
    assert result.summary["status"] == "completed"
    # Measured: 8, of which the body needs all.
    assert result.summary["newton_iterations"] < 20


def test_discs_of_scikit_fem_collide_as_those_of_carom_do(example, tmp_path):
    """The first touch, on the same triangles and by the same scheme."""
    skfem_discs = pytest.importorskip("skfem") and example("scikit_fem_discs")
    discs = skfem_discs.Discs(refinements=2)
    points, triangles = discs.mesh.p.T, discs.mesh.t.T
    bodies = []
    for name, is_left, speed in (("left", True, 1.0), ("right", False, -1.0)):
        own = triangles[(triangles[:, 0] < discs.nodes) == is_left]
        first = own.min()
        file = tmp_path / f"{name}.vtu"
        places = np.column_stack([points[first : first + discs.nodes], np.zeros(discs.nodes)])
        meshio.Mesh(places, [("triangle", turned(places, own - first))]).write(file)
        mesh = carom.MeshFile(file=str(file))
        bodies.append(carom.Body(name=name, material="elastic", mesh=mesh, velocity=[speed, 0.0]))
    law = carom.SaintVenantKirchhoff(
        young=skfem_discs.YOUNG, poisson=skfem_discs.POISSON, density=skfem_discs.DENSITY
    )
    analysis = carom.Dynamic(
        end_time=0.2,
        time_step=skfem_discs.TIME_STEP,
        scheme=carom.Theta(),
        newton=carom.Newton(tolerance=1e-13),
    )
    case = carom.Scenario(
        analysis=analysis,
        output=carom.Output(history_every=skfem_discs.TIME_STEP),
        materials={"elastic": law},
        bodies=bodies,
        contact=carom.Contact(condition="gap", friction=skfem_discs.FRICTION),
    )
    history = carom.run(case, out=tmp_path / "run").history
    found = skfem_discs.collide(discs, 0.2)
    initial = history["total"][0]
    assert found.ledger.friction > 0.001 * initial
    for term in ("kinetic", "strain", "friction"):
        difference = np.abs(getattr(found, term) - history[term][1:])
        assert difference.max() < 4e-12 * initial, term


def test_a_block_of_felupe_bounces_and_the_books_close(example):
    """In space, on hexahedra, with felupe's own energy, force, stiffness and mass."""
    blocks = pytest.importorskip("felupe") and example("felupe_block")
    block = blocks.Block(cells=2)
    u = 1e-3 * np.random.default_rng(0).standard_normal(block.mesh.points.size)
    step = 1e-6 * np.ones_like(u) * np.sin(np.arange(u.size))
    gained = block.strain_energy(u + step) - block.strain_energy(u - step)
    assert gained == pytest.approx(2.0 * block.force(u) @ step, rel=1e-6)
    run = blocks.drop(block, 0.02)
    initial = 0.5 * float(block.mass.sum()) / 3 * (0.5**2 + 1.0**2)
    left = run.kinetic[-1] + run.strain[-1]
    assert run.ledger.friction > 0.1 * initial
    # Of the scheme; measured: 8e-6 of the energy.
    taken = run.ledger.friction + run.ledger.normal_contact
    assert abs(left + taken - initial) < 1e-4 * initial


def turned(points, triangles):
    """Triangles that go around counter-clockwise."""
    edges = points[triangles[:, 1:]] - points[triangles[:, :1]]
    clockwise = np.linalg.det(edges[:, :, :2]) < 0.0
    return np.where(clockwise[:, None], triangles[:, [0, 2, 1]], triangles)
