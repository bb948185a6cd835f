"""Rigid bodies that are round whatever their mesh are audited."""

import pytest
from refuting import confirmed, refuted_after

import carom
from tampered import in_h5, with_another_case

METHODS = [
    ("gap", "theta"),
    ("midpoint", "conserving"),
    ("endpoint", "theta"),
    ("massless", "conserving"),
]


def marble(name, centre, radius=0.1, **more):
    kind = "disc" if len(centre) == 2 else "ball"
    mesh = {"kind": kind, "centre": centre, "radius": radius, "divisions": 2}
    return {"name": name, "kind": "rigid", "round": True, "density": 100.0, "mesh": mesh, **more}


def thrown(condition="midpoint", scheme="conserving", **changes):
    """Two marbles that meet, one of which rolls on a floor, and one that falls on a soft block."""
    soft = {"kind": "saint-venant-kirchhoff", "young": 2e4, "poisson": 0.3, "density": 10.0}
    block = {"kind": "rectangle", "corner": [0.8, 0.0], "size": [0.6, 0.3], "divisions": [4, 2]}
    case = {
        "analysis": {
            "end_time": 0.2,
            "time_step": 2e-3,
            "gravity": [0, -9.81],
            "scheme": {"kind": scheme},
        },
        "materials": {"m": soft},
        "bodies": [
            marble("a", [0.0, 0.1005], velocity=[2.0, 0.0], spin=3.0),
            marble("b", [0.3, 0.15], velocity=[-1.0, 0.0]),
            marble("c", [1.1, 0.402], velocity=[0.0, -1.0], spin=-4.0),
            {"name": "block", "material": "m", "mesh": block},
        ],
        "motions": [{"kind": "fixed", "body": "block", "on": "bottom"}],
        "obstacles": [
            {"kind": "plane", "name": "floor", "point": [0, 0], "normal": [0, 1]},
            {"kind": "sphere", "name": "post", "centre": [-0.4, 0.2], "radius": 0.2},
        ],
        "contact": {"condition": condition, "friction": 0.3, "penetration_tolerance": 0.5},
        "output": {"fields_every": 4e-3, "history_every": 2e-3, "audit": True},
    }
    if condition == "endpoint":
        case["contact"]["restitution"] = 0.5
    return carom.Scenario.from_dict({**case, **changes})


@pytest.mark.parametrize("method", METHODS)
def test_marbles_are_confirmed(tmp_path, method):
    result = carom.run(thrown(*method), out=tmp_path)
    touched = {tuple(event["pair"]) for event in result.summary["contacts"]}
    assert {("a", "floor"), ("a", "b"), ("c", "block")} <= touched
    checks = confirmed(tmp_path)
    assert checks["contact normals"].figure < 1e-6
    assert checks["nodal reactions"].count > 100


def test_balls_in_space_are_confirmed(tmp_path):
    bodies = [
        marble("a", [0.0, 0.0, 0.101], velocity=[2.0, 0.3, -0.3], spin=[0.0, 3.0, 1.0]),
        marble("b", [0.3, 0.05, 0.12], velocity=[-1.0, 0.0, 0.0]),
    ]
    floor = {"kind": "plane", "name": "floor", "point": [0, 0, 0], "normal": [0, 0, 1]}
    analysis = {"end_time": 0.1, "time_step": 2e-3, "gravity": [0, 0, -9.81]}
    changes = {"dimension": 3, "bodies": bodies, "obstacles": [floor], "motions": []}
    case = thrown(**changes, materials={}, analysis={**analysis, "scheme": {"kind": "conserving"}})
    result = carom.run(case, out=tmp_path)
    assert ["a", "b"] in [event["pair"] for event in result.summary["contacts"]]
    confirmed(tmp_path)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("round")
    carom.run(thrown(), out=out)
    return out


def test_a_radius_of_what_is_round_that_is_not_the_run_s_is_found(tmp_path, run):
    other = with_another_case(run, tmp_path / "changed", "radius = 0.1", "radius = 0.100001")
    refuted = {check.name for check in carom.audit(other).refuted}
    assert {"mesh", "contact gaps"} <= refuted


def test_a_body_that_is_not_round_in_the_run_is_found(tmp_path, run):
    other = with_another_case(run, tmp_path / "changed", "round = true", "round = false")
    refuted = {check.name for check in carom.audit(other).refuted}
    assert {"contact gaps", "nodal reactions"} <= refuted


def test_a_reaction_on_what_is_round_that_was_changed_is_found(tmp_path, run):
    tamper = in_h5("audit.h5:steps/000002/end/contact_force", lambda force: 1.001 * force)
    assert "nodal reactions" in refuted_after(run, tmp_path, tamper)
