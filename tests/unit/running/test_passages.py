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


def test_a_plate_impaled_on_a_post_does_not_complete(tmp_path):
    scenario = case({**PLATE, "velocity": [0.0, -1.0]}, POST, end_time=0.05, time_step=1e-3)
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
        "mesh": {"corner": [-0.1, 0.2], "size": [0.2, 0.2], "divisions": [4, 4]},
    }
    wall = {"name": "wall", "corner": [-1.0, -0.02], "size": [2.0, 0.04]}
    fast = {"end_time": 0.005, "time_step": 1e-3, "max_halvings": 0}
    scenario = case({**block, "velocity": [0.0, -500.0]}, wall, **fast)
    with pytest.raises(carom.ConvergenceError, match='"block" and "wall" go through one another'):
        carom.run(scenario, out=tmp_path)
