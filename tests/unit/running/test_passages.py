"""What goes through something is told, in the words of the run."""

import pytest

import carom
from carom.results.result import Result

MATERIAL = {"kind": "saint-venant-kirchhoff", "young": 1e6, "poisson": 0.3, "density": 1000.0}


def case(body, obstacle, **analysis):
    mesh = {"kind": "rectangle", **body["mesh"]}
    return carom.Scenario.from_dict(
        {
            "analysis": {"kind": "dynamic", **analysis},
            "materials": {"m": MATERIAL},
            "bodies": [{"material": "m", **body, "mesh": mesh}],
            "obstacles": [{"kind": "box", **obstacle}],
            "contact": {"condition": "gap"},
        }
    )


PLATE = {"name": "plate", "mesh": {"corner": [-0.5, 0.31], "size": [1.0, 0.2], "divisions": [5, 2]}}
POST = {"name": "post", "corner": [-0.08, 0.0], "size": [0.16, 0.3]}


def test_a_plate_comes_to_rest_on_a_post_between_its_nodes(tmp_path):
    damping = {"mass": 20.0, "stiffness": 1e-3}
    scenario = case(PLATE, POST, end_time=1.0, time_step=2e-3, gravity=[0.0, -9.81])
    scenario = scenario.with_overrides([f"materials.m.damping.{k}={v}" for k, v in damping.items()])
    summary = carom.run(scenario, out=tmp_path).summary
    history = Result.open(tmp_path).history
    assert summary["penetration"]["max_depth"] < 1e-14
    weight = 1.0 * 0.2 * 1000.0 * 9.81
    assert history["normal_force"][-1] == pytest.approx(weight, rel=1e-3)
    assert history["kinetic"][-1] < 1e-6


def test_a_post_inside_a_plate_at_the_start_is_refused():
    post = {"name": "post", "corner": [0.02, 0.0], "size": [0.04, 0.35]}
    words = 'obstacle "post" overlaps body "plate" at the start: near .* it is 0.02.* m inside'
    with pytest.raises(carom.InputError, match=words):
        carom.Simulation(case(PLATE, post, end_time=1.0, time_step=1e-3))


def test_a_plate_whose_sole_touches_nothing_does_not_complete(tmp_path):
    plate = {**PLATE, "velocity": [0.0, -1.0], "contact_sets": ["top"]}
    scenario = case(plate, POST, end_time=0.05, time_step=1e-3)
    words = "plate and post were up to .* m inside one another at t = .*penetration_tolerance"
    with (
        pytest.warns(carom.CaromWarning, match="inside one another"),
        pytest.raises(carom.PenetrationError, match=words),
    ):
        carom.run(scenario, out=tmp_path)
    result = Result.open(tmp_path)
    worst = result.summary["penetration"]["worst"]
    assert result.summary["status"] == "intersecting"
    assert worst["depth"] == pytest.approx(result.history["penetration"].max())
    assert [one.where for one in result.warnings] == ["penetration.worst"]


def test_a_step_that_leads_through_a_wall_says_so(tmp_path):
    block = {
        "name": "block",
        "mesh": {"corner": [-0.1, 0.2], "size": [0.2, 0.2], "divisions": [1, 1]},
    }
    wall = {"name": "wall", "corner": [-1.0, -0.02], "size": [2.0, 0.04]}
    fast = {"end_time": 0.005, "time_step": 1e-3, "max_halvings": 0}
    scenario = case({**block, "velocity": [0.0, -500.0]}, wall, **fast)
    with pytest.raises(carom.ConvergenceError, match='"block" and "wall" go through one another'):
        carom.run(scenario, out=tmp_path)
