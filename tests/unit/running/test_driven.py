"""Loads, motions and static analyses as case files describe them, and what is refused."""

import itertools

import numpy as np
import pytest

import carom
from carom import (
    Contact,
    Fixed,
    Force,
    InputError,
    Pressure,
    Scenario,
    Static,
    Table,
    Traction,
    check,
    run,
)
from carom.doctor import examine

BLOCK = {
    "name": "block",
    "material": "rubber",
    "mesh": {"kind": "rectangle", "corner": [0, 0], "size": [2, 1], "divisions": [4, 2]},
}
CASE = {
    "title": "press",
    "analysis": {"kind": "static", "end_time": 1, "time_step": 0.5},
    "materials": {"rubber": {"kind": "neo-hookean", "young": 100, "poisson": 0.3, "density": 1}},
    "bodies": [BLOCK],
    "loads": [
        {
            "kind": "pressure",
            "body": "block",
            "on": "top",
            "pressure": {"time": [0, 1], "value": [0, 1]},
            "follower": True,
        },
        {"kind": "force", "body": "block", "on": "right", "force": [0, "0.1*sin(3*t)"]},
    ],
    "motions": [
        {"kind": "fixed", "body": "block", "on": "bottom", "components": ["y"]},
        {"kind": "prescribed", "body": "block", "on": "left", "x": "0.01*t"},
    ],
    "obstacles": [
        {
            "kind": "plane",
            "name": "wall",
            "point": [3, 0],
            "normal": [-1, 0],
            "motion": {"x": "-0.1*t"},
        }
    ],
}


def with_value(path: str, value: object) -> dict:
    """Return the case with one value replaced; what is None is removed."""
    *parents, last = [int(p) if p.isdigit() else p for p in path.split(".")]
    case = copy = {key: _copied(entry) for key, entry in CASE.items()}
    for key in parents:
        copy = copy[key]
    if value is None:
        del copy[last]
    else:
        copy[last] = value
    return case


def _copied(value):
    if isinstance(value, dict):
        return {key: _copied(entry) for key, entry in value.items()}
    return [_copied(entry) for entry in value] if isinstance(value, list) else value


def test_case_file_of_a_driven_case_reads_back(tmp_path):
    scenario = Scenario.from_dict(CASE)
    assert scenario.loads[0] == Pressure(
        body="block", on="top", pressure=Table(time=(0, 1), value=(0, 1)), follower=True
    )
    assert scenario.loads[1] == Force(body="block", on="right", force=(0, "0.1*sin(3*t)"))
    assert scenario.motions[0] == Fixed(body="block", on="bottom", components=("y",))
    for complete in (False, True):
        file = tmp_path / "case.toml"
        file.write_text(scenario.to_toml(complete=complete), encoding="utf-8")
        assert Scenario.from_toml(file) == scenario


def test_condition_of_load_steps_is_the_gap_unless_it_is_given():
    assert Scenario.from_dict(CASE).contact.condition == "gap"
    assert Scenario(**{**CASE, "contact": Contact(friction=0.2)}).contact.condition == "gap"
    given = Scenario.from_dict({**CASE, "contact": {"condition": "midpoint"}})
    assert given.contact.condition == "midpoint"
    with pytest.raises(InputError, match=r"contact.condition: a static analysis rules the gap"):
        check(given)
    dynamic = Scenario.from_dict(with_value("analysis.kind", "dynamic"))
    assert dynamic.contact.condition == "massless"


def test_static_run_keeps_forces_of_supports(tmp_path):
    result = run(Scenario.from_dict(CASE), out=tmp_path / "results")
    history = result.history
    assert result.summary["energy"]["kinetic"] == 0.0
    assert history["block.bottom.force_y"][-1] > 1.5, "2 m under 1 Pa, less what pulls up"
    assert isinstance(Scenario.from_dict(CASE).analysis, Static)


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("loads.0.body", "lid", r'loads.0.body = "lid": no such body'),
        ("loads.0.pressure", True, r"loads.0.pressure = true: must be a number"),
        ("loads.0.pressure.time", [1, 0], r"loads.0.pressure.time = \[1.0, 0.0\]: must ascend"),
        ("loads.0.pressure.value", [1], r"loads.0.pressure.value = \[1.0\]: must have as many"),
        ("loads.1.force", [0, 0, 0], r"loads.1.force = .*: must have 2 components, not 3"),
        ("motions.1.x", None, r"motions.1: give one of x, y, z at least"),
        ("motions.0.components", ["w"], r"motions.0.components.0 = \"w\": must be 'x', 'y' or 'z'"),
        ("obstacles.0.velocity", [1, 0], r"obstacles.0.motion: give velocity or motion, not both"),
    ],
)
def test_what_drives_nothing_is_named(path, value, message):
    with pytest.raises(InputError, match=message):
        Scenario.from_dict(with_value(path, value))


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("loads.0.on", "lid", r'loads.0.on: "lid": body "block" has no such set of facets'),
        ("loads.1.force", [0, "sin(t"], r'loads.1.force.1: expected "\)" at column 6'),
        ("loads.1.force", [0, "sinn(t)"], r'unknown function "sinn"'),
        ("loads.1.force", [0, "1/t"], r"loads.1.force.1: its value at t = 0 s is inf"),
        ("motions.1.x", 0.1, r"motions.1.x: the displacement at t = 0 is 0.1 m"),
        ("obstacles.0.motion", {"x": "1 +"}, r"obstacles.0.motion.x: expected a value at column 4"),
    ],
)
def test_what_only_the_core_can_tell_is_named(path, value, message):
    with pytest.raises(InputError, match=message):
        check(Scenario.from_dict(with_value(path, value)))


TABLE = {"time": [0, 1], "value": [0, 0.5]}

FORMS = (TABLE, 0.0, "0.1*t")


# Symptom guarded against: AttributeError: type object 'float' has no attribute 'model_fields'.
@pytest.mark.parametrize("vector", list(itertools.product(FORMS, repeat=2)))
@pytest.mark.parametrize("kind", ["force", "traction"])
def test_a_vector_mixes_tables_numbers_and_formulas(tmp_path, kind, vector):
    load = {"kind": kind, "body": "block", "on": "right", kind: list(vector)}
    scenario = Scenario.from_dict(with_value("loads.1", load))
    for complete in (False, True):
        (tmp_path / "case.toml").write_text(scenario.to_toml(complete=complete))
        assert Scenario.from_toml(tmp_path / "case.toml") == scenario


def test_a_traction_with_a_table_beside_a_number_runs_and_is_examined(tmp_path):
    traction = Traction(body="block", on="right", traction=[TABLE, 0.0])
    assert traction.traction == (Table(**TABLE), 0.0)
    case = with_value("loads.1", traction)
    scenario = Scenario.from_dict(case)
    assert examine(scenario).worst != "error"
    result = run(scenario, out=tmp_path / "out")
    assert result.scenario == scenario


def test_a_vector_with_tables_of_the_wrong_length_is_shown_in_a_line():
    for mixed, said in (([TABLE, 0, "t"], '[{…}, 0.0, "t"]'), ([Table(**TABLE)], "[{…}]")):
        case = with_value("loads.1", Force(body="block", on="right", force=mixed))
        with pytest.raises(InputError) as caught:
            Scenario.from_dict(case)
        expected = f"loads.1.force = {said}: must have 2 components, not {len(mixed)}"
        assert str(caught.value) == expected


def test_an_obstacle_meets_a_body_at_rest_at_the_very_end_of_a_step():
    """Symptom guarded against: round-off of the first touch was a step without balance."""
    mesh = carom.Rectangle(corner=(0, 0), size=(0.5, 1.0), divisions=(4, 8))
    wall = carom.Plane(name="wall", point=(-0.1, 0), normal=(1, 0), velocity=(1.0, 0.0))
    scenario = carom.Scenario(
        analysis=carom.Dynamic(end_time=0.2, time_step=1e-3),
        materials={"m": carom.SaintVenantKirchhoff(young=1e6, poisson=0.3, density=1000.0)},
        bodies=[carom.Body(name="block", material="m", mesh=mesh)],
        obstacles=[wall],
    )
    simulation = carom.Simulation(scenario)
    while not simulation.has_ended:
        simulation.step()
    # A block of 500 kg that leaves faster than the wall, by what waves in it take.
    assert simulation.ledger.prescribed > 500.0
    assert np.abs(simulation.history["defect"]).max() < 1e-12 * simulation.ledger.prescribed
