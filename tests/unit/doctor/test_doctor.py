"""``carom doctor``: every finding has a case that provokes it, and healthy cases have none."""

import copy
import importlib
import json
from pathlib import Path

import meshio
import numpy as np
import pytest

import carom
from carom import cli
from carom.building.build import build
from carom.building.simplices import Boundary
from carom.doctor import contact_setup, cost, examine, meeting, mesh_quality, time_step, units
from carom.doctor.flight import Flight, obstacle_gap
from carom.doctor.mesh_quality import quality
from carom.doctor.patient import Grid, Patient
from carom.doctor.touch import first_touch

STEEL = {"kind": "linear-elastic", "young": 210e9, "poisson": 0.3, "density": 7850.0}
CASE = {
    "title": "Block on a floor",
    "analysis": {"end_time": 2e-3, "time_step": 1e-5, "gravity": [0.0, -9.81]},
    "materials": {"steel": STEEL},
    "bodies": [
        {
            "name": "block",
            "material": "steel",
            "mesh": {
                "kind": "rectangle",
                "corner": [0.0, 1e-3],
                "size": [1.0, 1.0],
                "divisions": [4, 4],
            },
            "velocity": [0.0, -1.0],
        }
    ],
    "obstacles": [{"name": "floor", "kind": "plane", "point": [0.0, 0.0], "normal": [0.0, 1.0]}],
    "contact": {"friction": 0.3},
}


@pytest.fixture
def case():
    """A healthy case as plain data that a test may spoil."""
    return copy.deepcopy(CASE)


def patient(case):
    scenario = carom.Scenario.from_dict(case)
    return Patient(scenario, build(scenario))


def grave(check, case):
    """Return what a check finds that is not ok, by key."""
    return {f.key: f for f in check(patient(case)) if f.level != "ok"}


def fact(check, case, key):
    """Return what a check says of a key."""
    return next(f.what for f in check(patient(case)) if f.key == key)


@pytest.mark.parametrize("check", [units, mesh_quality, meeting, contact_setup, time_step, cost])
def test_a_healthy_case_has_nothing_grave(check, case):
    assert grave(check, case) == {}


def test_wave_speeds_are_those_of_the_material(case):
    young, poisson, density = 210e9, 0.3, 7850.0
    pressure = np.sqrt(young * (1 - poisson) / (1 + poisson) / (1 - 2 * poisson) / density)
    shear = np.sqrt(0.5 * young / (1 + poisson) / density)
    said = fact(units, case, "materials.steel")
    assert f"{pressure:.4g} m/s" in said
    assert f"{shear:.4g} m/s" in said


@pytest.mark.parametrize(
    ("young", "density", "mix"),
    [
        (210e3, 7.85e-9, "mm, N, tonne"),
        (210e3, 7850.0, "moduli in MPa"),
        (210.0, 7850.0, "moduli in GPa"),
        (210e9, 7.85, "densities in g/cm³"),
        (210.0, 7.85, "moduli in GPa and densities in g/cm³"),
    ],
)
def test_units_that_are_not_si_are_recognised(case, young, density, mix):
    case["materials"]["steel"] |= {"young": young, "density": density}
    case["bodies"][0]["velocity"] = None
    finding = grave(units, case)["materials.steel"]
    assert finding.level == "warning"
    _, _, likely = finding.remedy.partition("these look like ")
    assert mix in likely


def test_moduli_of_rubber_laws_give_their_waves(case):
    case["materials"]["steel"] = {
        "kind": "mooney-rivlin",
        "c10": 4e5,
        "c01": 1e5,
        "bulk": 1e9,
        "density": 1000.0,
    }
    assert f"{np.sqrt(1e6 / 1000.0):.4g} m/s in steel" in fact(units, case, "materials.steel")


def test_a_velocity_near_that_of_waves(case):
    case["bodies"][0]["velocity"] = [0.0, -1000.0]
    finding = grave(units, case)["bodies.0.velocity"]
    assert finding.level == "warning"


def test_gravity_in_millimetres(case):
    case["analysis"]["gravity"] = [0.0, -9810.0]
    assert grave(units, case)["analysis.gravity"].level == "warning"


def test_a_part_in_millimetres(case, tmp_path):
    points = 200.0 * np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) + [0.0, 1.0]
    meshio.write(tmp_path / "p.vtu", meshio.Mesh(points, [("quad", [[0, 1, 2, 3]])]))
    case["bodies"][0]["mesh"] = {"file": str(tmp_path / "p.vtu")}
    finding = grave(units, case)["bodies.0.mesh.scale"]
    assert finding.remedy.endswith("set scale = 0.001")


@pytest.mark.parametrize(("height", "level"), [(0.02, "advice"), (0.002, "warning")])
def test_slender_cells(case, height, level):
    case["bodies"][0]["mesh"] |= {"size": [4.0, height], "divisions": [8, 1]}
    finding = grave(mesh_quality, case)["bodies.0.mesh"]
    assert finding.level == level
    assert f"ratio of {0.5 / height:.3g}" in finding.what


@pytest.mark.parametrize(("lean", "level"), [(0.2, "advice"), (0.05, "warning")])
def test_distorted_cells(case, tmp_path, lean, level):
    x = np.sqrt(1.0 - lean**2)  # a rhombus whose corners have this scaled Jacobian
    points = np.array([[0, 0.01], [1, 0.01], [1 + x, 0.01 + lean], [x, 0.01 + lean]])
    meshio.write(tmp_path / "p.vtu", meshio.Mesh(points, [("quad", [[0, 1, 2, 3]])]))
    case["bodies"][0]["mesh"] = {"file": str(tmp_path / "p.vtu")}
    finding = grave(mesh_quality, case)["bodies.0.mesh"]
    assert finding.level == level
    assert f"scaled Jacobian of {lean:.2g}" in finding.what


def test_regular_cells_of_all_shapes_are_best():
    triangle = np.array([[0, 0], [1, 0], [0.5, np.sqrt(0.75)]])
    tetrahedron = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1.0]])
    if np.linalg.det(tetrahedron[1:] - tetrahedron[0]) < 0:
        tetrahedron = tetrahedron[[0, 2, 1, 3]]
    cube = np.array(
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
    )
    wedge = np.array([[*corner, z] for z in (0, 1) for corner in triangle])
    for vtk, points in ((5, triangle), (10, tetrahedron), (12, cube), (13, wedge)):
        grid = Grid(np.asarray(points, dtype=float), {vtk: np.arange(len(points))[None]})
        aspect, jacobian = quality(grid)
        assert aspect == pytest.approx([1.0])
        assert jacobian == pytest.approx([1.0])


def test_overlapping_bodies_are_an_error_with_their_place(case):
    case["bodies"][0]["mesh"]["corner"] = [0.0, -0.1]
    diagnosis = examine(carom.Scenario.from_dict(case))
    assert diagnosis.worst == "error"
    (finding,) = diagnosis.findings
    assert finding.key == "bodies.0.mesh"
    assert finding.what.startswith('body "block" overlaps obstacle "floor"')


def test_overlaps_that_are_taken_up_are_told(case):
    case["analysis"] = {"kind": "static", "end_time": 1.0, "time_step": 0.5}
    case["bodies"][0]["mesh"]["corner"] = [0.0, -1e-3]
    del case["bodies"][0]["velocity"]
    case["contact"]["resolve_overlap"] = True
    said = "block and floor overlap at the start by 0.001 m at ("
    assert said in fact(meeting, case, "bodies")
    own = {"between": ["floor", "block"], "resolve_overlap": True}
    case["contact"] = {"pairs": [own]}
    assert said in fact(meeting, case, "bodies")


def test_nothing_to_touch(case):
    case["obstacles"] = []
    assert grave(meeting, case)["contact"].level == "warning"


def test_the_first_touch_is_that_of_the_fall(case):
    # 1 mm at 1 m/s and 9.81 m/s²
    time = (np.sqrt(1.0 + 2 * 9.81 * 1e-3) - 1.0) / 9.81
    said = fact(meeting, case, "analysis.end_time")
    assert said == f"the first to touch are block and floor, at about {time:.3g} s of 0.002 s"


def test_bodies_that_never_meet(case):
    case["bodies"][0]["velocity"] = [0.0, 1.0]
    case["analysis"]["gravity"] = None
    finding = grave(meeting, case)["analysis.end_time"]
    assert finding.level == "warning"
    assert "0.001 m apart at the least" in finding.what


@pytest.mark.parametrize(
    "moving",
    [{"velocity": [0.0, 2.0]}, {"motion": {"y": {"time": [0.0, 1.0], "value": [0.0, 2.0]}}}],
)
def test_an_obstacle_that_moves_is_met_where_it_is(case, moving):
    case["bodies"][0]["velocity"] = [0.0, 1.0]
    case["analysis"]["gravity"] = None
    case["obstacles"][0] |= moving  # 1 mm at 2 − 1 m/s
    said = fact(meeting, case, "analysis.end_time")
    assert said == "the first to touch are block and floor, at about 0.001 s of 0.002 s"


def test_a_spinning_body_turns_about_its_centre_of_mass(case, tmp_path):
    """Symptom guarded against: it was turned about the mean of its nodes, wherever these are."""
    points = [[x, y] for y in (0.0, 1.0) for x in (0.0, 0.1, 0.2, 1.0)]
    quads = [[k, k + 1, k + 5, k + 4] for k in range(3)]
    meshio.write(tmp_path / "p.vtu", meshio.Mesh(np.array(points), [("quad", quads)]))
    case["bodies"][0] |= {"mesh": {"file": str(tmp_path / "p.vtu")}, "velocity": None, "spin": 10.0}
    case["analysis"] |= {"gravity": None, "end_time": 0.1}
    case["obstacles"][0]["point"] = [0.0, -0.2]
    # A corner, which is √½ from the centre and starts at 45°, is 0.7 below it.
    time = (np.arcsin(0.7 / np.sqrt(0.5)) - np.pi / 4) / 10.0
    said = fact(meeting, case, "analysis.end_time")
    assert said == f"the first to touch are block and floor, at about {time:.3g} s of 0.1 s"


@pytest.mark.parametrize("x", [None, "0"])
def test_a_body_that_supports_lead_arrives_with_them(case, x):
    """Symptom guarded against: what supports drive was not foreseen, and free flight went on."""
    push = {"kind": "prescribed", "body": "block", "on": "top", "y": "-2*t"} | {"x": x}
    case["motions"] = [push, {"kind": "fixed", "body": "block", "on": "left", "components": ["x"]}]
    if x is None:
        del push["x"]
    else:
        case["motions"].pop()
    case["bodies"][0] |= {"velocity": [0.0, 1.0], "spin": 1.0}
    said = fact(meeting, case, "analysis.end_time")
    assert said == "the first to touch are block and floor, at about 0.0005 s of 0.002 s"


@pytest.mark.parametrize(
    "driving",
    [
        {"loads": [{"kind": "force", "body": "block", "on": "top", "force": [0.0, -1.0]}]},
        {
            "motions": [
                {"kind": "prescribed", "body": "block", "on": "top", "y": "-t"},
                {"kind": "fixed", "body": "block", "on": "bottom"},
            ]
        },
    ],
)
def test_what_loads_drive_or_supports_deform_is_not_foreseen(case, driving):
    case |= driving
    assert grave(meeting, case) == {}
    assert "analysis.end_time" not in {f.key for f in meeting(patient(case))}
    mesh = case["bodies"][0]["mesh"] | {"corner": [3.0, 1e-3]}
    case["bodies"].append(case["bodies"][0] | {"name": "other", "mesh": mesh, "velocity": [0, 1]})
    case["analysis"]["gravity"] = None
    assert fact(meeting, case, "analysis.end_time") == (
        "nothing that is foreseen meets; what loads drive, or supports that move apart, is not "
        "foreseen"
    )


def test_two_discs_meet_when_their_boundaries_do(case):
    disc = {"kind": "disc", "radius": 0.1, "divisions": 8}
    case["obstacles"] = []
    case["analysis"] |= {"gravity": None, "end_time": 0.2}
    case["bodies"] = [
        {"name": n, "material": "steel", "mesh": disc | {"centre": [x, 0.0]}, "velocity": [v, 0.0]}
        for n, x, v in (("a", -0.2, 1.0), ("b", 0.2, -1.0))
    ]
    said = fact(meeting, case, "analysis.end_time")
    assert float(said.split("about ")[1].split(" s ")[0]) == pytest.approx(0.1, rel=1e-3)


@pytest.mark.parametrize(
    ("shipped", "time"),
    [("examples/two_bars.toml", 0.01), ("python/carom/new/templates/two-bodies.toml", 1.28e-3)],
)
def test_bodies_of_shipped_cases_touch_when_they_do(shipped, time):
    """Symptom guarded against: "about 0 s", as half an edge of a cell counted as touching."""
    scenario = carom.Scenario.from_toml(Path(__file__).parents[3] / shipped)
    said = [f.what for f in meeting(Patient(scenario, build(scenario)))]
    (told,) = [what for what in said if what.startswith("the first to touch are left and right")]
    assert float(told.split("about ")[1].split(" s ")[0]) == pytest.approx(time, rel=1e-2)


@pytest.mark.parametrize("post", ["obstacle", "body"])
def test_a_coarse_plate_over_a_post_is_as_far_as_its_side(case, post):
    """Symptom guarded against: 0.0224 m, from a node of the plate beside the post."""
    plate = {"kind": "rectangle", "corner": [-1.0, 0.31], "size": [2.0, 0.1], "divisions": [5, 1]}
    case["bodies"][0] |= {"mesh": plate}
    narrow = {"corner": [-0.13, 0.0], "size": [0.02, 0.3]}
    if post == "body":
        mesh = {"kind": "rectangle", "divisions": [1, 3], **narrow}
        case["bodies"].append({"name": "post", "material": "steel", "mesh": mesh})
        case["analysis"]["gravity"] = None
    case["obstacles"] = [{"name": "post", "kind": "box", **narrow}] if post == "obstacle" else []
    case["analysis"] |= {"end_time": 0.02, "gravity": None}
    assert "the nearest are block and post, 0.01 m apart at (" in fact(meeting, case, "bodies")
    said = fact(meeting, case, "analysis.end_time")
    assert said == "the first to touch are block and post, at about 0.01 s of 0.02 s"


def test_a_thin_wall_is_not_passed_between_two_looks():
    """A wall of 1 µm, met at half a step of the samples, by a point that is through by the next."""

    def gap(time):
        return max(abs(time - 0.50123) - 1e-6, 0.0)

    time, least = first_touch(gap, lambda start, end: end - start, 1.0, tolerance=1e-12)
    assert time == pytest.approx(0.50123 - 1e-6, abs=1e-8)
    assert least == 0.0


def test_what_passes_by_does_not_touch():
    def gap(time):
        return np.hypot(time - 0.5, 0.01)

    time, least = first_touch(gap, lambda start, end: end - start, 1.0, tolerance=1e-12)
    assert time is None
    assert least == pytest.approx(0.01, rel=1e-9)


def test_gaps_of_obstacles():
    points = np.array([[3.0, 4.0, 0.0], [6.0, 8.0, 5.0]])
    gaps = {
        carom.Plane(name="p", point=[0, 0, -1], normal=[0, 0, 2]): 1.0,
        carom.RigidSphere(name="s", centre=[0, 0, 0], radius=2.0): 3.0,
        carom.RigidSphere(name="c", centre=[0, 0, 0], radius=20.0, cavity=True): 20 - np.sqrt(125),
        carom.RigidCylinder(name="z", point=[0, 0, 9], axis=[0, 0, 1], radius=1.0): 4.0,
        carom.RigidBox(name="b", corner=[-2, 0, -1], size=[2, 1, 2]): np.sqrt(18.0),
    }
    block = carom.Box(corner=[5, 6, 3], size=[1, 1, 1], divisions=[1, 1, 1], cell="hex8")
    scenario = carom.Scenario(
        dimension=3,
        analysis=carom.Dynamic(end_time=1.0, time_step=1.0),
        materials={"m": carom.LinearElastic(young=1.0, poisson=0.3, density=1.0)},
        bodies=[carom.Body(name="block", material="m", mesh=block)],
        obstacles=list(gaps),
    )
    native = build(scenario)
    boundary = Boundary(points, np.array([[0, 1, 1]]))
    for index, (shape, gap) in enumerate(gaps.items()):
        found = obstacle_gap(shape, boundary, lambda x, k=index: native.obstacle_gaps(k, x)[0])
        assert found == pytest.approx(gap)


def test_a_polygon_is_as_far_away_as_its_nearest_corner_or_side():
    """A bracket with a dent, over which the side of a body passes."""
    bracket = [[0, 0], [3, 0], [3, 2], [2, 2], [2, 1], [1, 1], [1, 2], [0, 2]]
    shape = carom.RigidPolygon(name="bracket", points=bracket)
    mesh = carom.Rectangle(corner=[0.5, 2.5], size=[2, 1], divisions=[1, 1])
    scenario = carom.Scenario(
        analysis=carom.Dynamic(end_time=1.0, time_step=1.0),
        materials={"m": carom.LinearElastic(young=1.0, poisson=0.3, density=1.0)},
        bodies=[carom.Body(name="block", material="m", mesh=mesh)],
        obstacles=[shape],
    )
    native = build(scenario)
    for points, gap in ([[1.2, 2.5], [1.8, 2.5]], 0.5), ([[1.5, 1.2], [1.5, 1.4]], 0.2):
        side = Boundary(np.array(points), np.array([[0, 1]]))
        found = obstacle_gap(shape, side, lambda x: native.obstacle_gaps(0, x)[0])
        assert found == pytest.approx(gap if gap < 0.5 else np.hypot(0.2, 0.5))


def test_a_thrown_body_falls_and_turns():
    flight = Flight(
        Boundary(np.array([[1.0, 0.0, 0.0]]), np.array([[0, 0, 0]])),
        centre=np.zeros(3),
        velocity=np.array([0.0, 0.0, 2.0]),
        gravity=np.array([0.0, 0.0, -4.0]),
        spin=np.array([0.0, 0.0, np.pi / 2]),
    )
    assert flight.at(1.0).points == pytest.approx(np.array([[0.0, 1.0, 0.0]]), abs=1e-15)
    plane = Flight(
        Boundary(np.array([[1.0, 0.0]]), np.array([[0, 0]])),
        *(np.array(x) for x in ([0.0, 0.0], [0, 1], [0, 0], np.pi)),
    )
    assert plane.at(1.0).points == pytest.approx(np.array([[-1.0, 1.0]]))


def test_a_body_whose_pairs_are_disabled(case):
    second = copy.deepcopy(case["bodies"][0]) | {"name": "loose"}
    second["mesh"]["corner"] = [5.0, 1.0]
    case["bodies"].append(second)
    case["contact"]["pairs"] = [
        {"between": ["loose", other], "enabled": False} for other in ("block", "floor")
    ]
    assert set(grave(contact_setup, case)) == {"bodies.1"}


def test_no_friction(case):
    del case["contact"]
    assert grave(contact_setup, case)["contact.friction"].level == "advice"


@pytest.mark.parametrize(
    ("condition", "key", "level"),
    [("massless", "contact.condition", "warning"), ("midpoint", "analysis.scheme", "advice")],
)
def test_theta_with_a_condition_that_keeps_energy(case, condition, key, level):
    case["analysis"]["scheme"] = {"kind": "theta"}
    case["contact"]["condition"] = condition
    assert grave(contact_setup, case)[key].level == level


def test_a_body_whose_mass_is_on_its_sides(case):
    # Of four cells each way, half of one is along every side: 1 − (3/4)².
    said = [f.what for f in contact_setup(patient(case)) if "moves inside" in f.what]
    assert "44 % of block" in said[0]
    case["bodies"][0]["contact_sets"] = ["bottom"]
    assert not [f for f in contact_setup(patient(case)) if "moves inside" in f.what]


def test_nothing_moves(case):
    case["bodies"][0]["velocity"] = case["analysis"]["gravity"] = None
    assert grave(contact_setup, case)["bodies"].level == "warning"


def test_a_step_too_long_for_waves_and_impacts(case):
    case["analysis"] |= {"time_step": 4e-4}
    findings = [f for f in time_step(patient(case)) if f.level == "warning"]
    assert [f.key for f in findings] == ["analysis.time_step"] * 2
    assert "waves are not resolved" in findings[0].what
    assert "the impact of block takes" in findings[1].what


def test_a_step_shorter_than_anything_needs(case):
    case["analysis"] |= {"time_step": 1e-6}
    assert grave(time_step, case)["analysis.time_step"].level == "advice"


def test_a_last_step_that_is_shorter(case):
    case["analysis"]["time_step"] = 1.5e-5
    finding = grave(time_step, case)["analysis.end_time"]
    assert finding.remedy == "take end_time = 0.001995"


def test_a_history_too_coarse_for_an_impact(case):
    case["output"] = {"history_every": 1e-3}
    assert grave(time_step, case)["output.history_every"].level == "advice"


def test_a_run_that_takes_long(case):
    case["analysis"] |= {"end_time": 1e5}
    case["output"] = {"fields_every": 1e5}
    finding = grave(cost, case)["analysis"]
    assert finding.level == "advice"
    assert " h here" in finding.what


def test_frames_that_fill_the_disk(case):
    case["analysis"] |= {"end_time": 100.0}
    case["output"] = {"fields_every": 1e-5}
    assert grave(cost, case)["output.fields_every"].level == "warning"


def test_a_run_that_needs_most_of_the_memory(case, monkeypatch):
    module = importlib.import_module("carom.doctor.cost")
    monkeypatch.setattr(module, "_machine_memory", lambda: 1e8)
    monkeypatch.setattr(module, "_peak_memory", lambda: 9e7)
    assert grave(cost, case)["bodies"].level == "warning"


def test_a_trial_step_that_fails(case):
    case["analysis"] |= {"newton": {"max_iterations": 1}, "max_halvings": 0}
    case["bodies"][0]["spin"] = 300.0
    finding = grave(cost, case)["analysis.time_step"]
    assert finding.level == "error"
    assert finding.what.startswith("the trial failed at step 1: ")


def test_a_static_trial_that_fails_is_not_told_to_check_velocities(case):
    """Symptom guarded against: "check materials and velocities" of a case that has none."""
    case["analysis"] = {
        "kind": "static",
        "end_time": 1.0,
        "time_step": 1.0,
        "newton": {"max_iterations": 1},
        "max_halvings": 0,
    }
    case["bodies"][0]["velocity"] = None
    case["materials"]["steel"] = {**STEEL, "kind": "saint-venant-kirchhoff"}
    hold = {"kind": "fixed", "body": "block", "on": "bottom"}
    push = {"kind": "prescribed", "body": "block", "on": "top", "x": "0.2*t", "y": 0.0}
    case["motions"] = [hold, push]
    finding = grave(cost, case)["analysis.time_step"]
    assert finding.level == "error"
    assert (
        finding.remedy == "take a shorter step, or check materials and how loads and supports grow"
    )


@pytest.mark.parametrize(
    ("density", "level"), [(1.0, "ok"), (1.05, "warning"), (1000.0, "warning")]
)
def test_a_case_without_units_is_not_measured_by_solids(case, density, level):
    """Symptom guarded against: "no solid between foam and diamond" of examples/oblique_layer."""
    case["materials"]["steel"] |= {"young": 8 / 3, "density": density}
    (finding,) = [f for f in units(patient(case)) if f.key == "materials.steel"]
    assert finding.level == level
    assert ("a density of 1 is that of a case without units" in finding.what) == (density == 1.0)


def test_what_was_done_to_a_mesh_is_told(case, tmp_path):
    points = np.array([[0, 1], [1, 1], [0, 2], [1, 2.0]])
    cells = [("triangle", [[0, 1, 2], [1, 2, 3]])]
    meshio.write(tmp_path / "p.vtu", meshio.Mesh(points, cells))
    case["bodies"][0]["mesh"] = {"file": str(tmp_path / "p.vtu")}
    first, *_ = examine(carom.Scenario.from_dict(case)).findings
    assert (first.level, first.key) == ("advice", "bodies.0.mesh.file")
    assert "1 of 2 cells (tri3 1 from 0 in their order in the file) are numbered" in first.what
    assert first.remedy == "look whether the program that wrote the file meant these cells"


@pytest.fixture
def command(capsys):
    def run(*arguments):
        with pytest.raises(SystemExit) as caught:
            cli.app(["doctor", *map(str, arguments)], prog_name="carom")
        captured = capsys.readouterr()
        return caught.value.code or 0, captured.out, captured.err

    return run


def test_the_command_prints_findings_and_their_remedies(command, tmp_path, case):
    del case["contact"]
    file = tmp_path / "case.toml"
    file.write_text(carom.Scenario.from_dict(case).to_toml(), encoding="utf-8")
    status, out, err = command(file)
    assert (status, err) == (0, "")
    assert "there is no friction" in out
    assert "→ set contact.friction" in out
    status, out, _ = command(file, "--json")
    found = json.loads(out)
    assert (status, found["worst"]) == (0, "advice")
    assert {"level", "key", "what", "remedy"} == set(found["findings"][0])


def test_a_case_that_cannot_run_is_status_2(command, tmp_path, case):
    case["bodies"][0]["mesh"]["corner"] = [0.0, -0.1]
    file = tmp_path / "case.toml"
    file.write_text(carom.Scenario.from_dict(case).to_toml(), encoding="utf-8")
    status, out, _ = command(file)
    assert status == 2
    assert "overlaps obstacle" in " ".join(out.replace("│", " ").split())
    file.write_text("bodies = 1")
    status, out, err = command(file)
    assert (status, out) == (2, "")
    assert err.count("\n") == 1
