"""Coarse round bodies of second order bounce as fine ones do: their sides are smooth."""

import pytest

import carom


@pytest.mark.parametrize("cell", ["quad8", "quad9", "tri6"])
@pytest.mark.parametrize("condition", ["massless", "midpoint", "gap"])
def test_a_coarse_disc_of_second_order_bounces(cell, condition, tmp_path):
    """Symptom guarded against: a disc of eight facets, which turn by 45° from one to the next and
    go over into one another, ended as inside the floor by the arcs between its nodes.
    """
    disc = {"kind": "disc", "centre": [0.0, 1.02], "radius": 1.0, "divisions": 2, "cell": cell}
    soft = {"kind": "saint-venant-kirchhoff", "young": 2700.0, "poisson": 0.33, "density": 1.0}
    case = {
        "dimension": 2,
        "analysis": {"end_time": 0.06, "time_step": 2e-3, "scheme": {"kind": "conserving"}},
        "materials": {"soft": soft},
        "bodies": [
            {"name": "disc", "material": "soft", "velocity": [1.0, -2.0], "spin": 0.7, "mesh": disc}
        ],
        "obstacles": [
            {"name": "floor", "kind": "plane", "point": [0.0, 0.0], "normal": [0.0, 1.0]}
        ],
        "contact": {"condition": condition, "friction": 0.2},
    }
    summary = carom.run(carom.Scenario.from_dict(case), out=tmp_path).summary
    assert summary["status"] == "completed" and summary["contacts"]
    worst = summary["penetration"]["worst"]
    # Halves of facets turn by 22.5° and are 0.39 m long: their arcs are 1.9 cm high.
    assert worst is None or 0.0 < worst["allowed"] - 0.01 * worst["cell"] < 0.03


@pytest.mark.parametrize("cell", ["hex20", "hex27", "wedge15"])
def test_a_coarse_cylinder_of_second_order_bounces(cell, tmp_path):
    """Symptom guarded against: where a round side ends, its edge was that of the flat one."""
    cylinder = {"kind": "cylinder", "base": [0.0, -0.5, 1.02], "axis": [0.0, 1.0, 0.0]}
    cylinder |= {"radius": 1.0, "height": 1.0, "divisions": 2, "rings": 1, "layers": 1}
    case = {
        "dimension": 3,
        "analysis": {"end_time": 0.06, "time_step": 2e-3},
        "materials": {
            "soft": {"kind": "neo-hookean", "young": 5000.0, "poisson": 0.3, "density": 1.0}
        },
        "bodies": [
            {
                "name": "cylinder",
                "material": "soft",
                "velocity": [1.0, 0.0, -2.0],
                "mesh": cylinder | {"cell": cell},
            }
        ],
        "obstacles": [{"name": "floor", "kind": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],
        "contact": {"friction": 0.3},
    }
    summary = carom.run(carom.Scenario.from_dict(case), out=tmp_path).summary
    assert summary["status"] == "completed" and summary["contacts"]


BOX = {"kind": "box", "corner": [-1.0, -0.74, -1.08], "size": [2.0, 1.6, 1.6]}
BALL = {"kind": "ball", "centre": [2.15, 0.28, 0.01], "radius": 1.0, "divisions": 2}
CYLINDER = {"kind": "cylinder", "base": [0.0, 0.02, -0.83], "axis": [0.0, 0.0, 1.0]}
CYLINDER |= {"radius": 1.0, "height": 1.4, "divisions": 2, "rings": 1, "layers": 1}
BEYOND = {"kind": "box", "corner": [1.15, -0.69, -1.01], "size": [2.0, 1.6, 1.6]}


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (BOX | {"divisions": [2, 2, 2], "cell": "hex20"}, BEYOND | {"divisions": [2, 2, 2]}),
        (CYLINDER | {"cell": "hex8"}, BALL | {"cell": "hex27"}),
        (CYLINDER | {"cell": "hex20"}, BALL | {"cell": "hex20"}),
    ],
    ids=["hex20-hex8", "hex8-hex27", "hex20-hex20"],
)
def test_coarse_bodies_of_second_order_meet_between_their_nodes(first, second, tmp_path):
    """Symptom guarded against: edges went into curved sides, and curved edges into others, where
    neither had a node: by up to a tenth of a cell, and the run ended for it.
    """
    soft = {"kind": "neo-hookean", "young": 5000.0, "poisson": 0.3, "density": 1.0}
    case = {
        "dimension": 3,
        "analysis": {"end_time": 0.08, "time_step": 2e-3},
        "materials": {"soft": soft},
        "bodies": [
            {
                "name": "a",
                "material": "soft",
                "mesh": first,
                "velocity": [2.5, 0.0, 0.0],
                "spin": [0.5, -0.7, 0.3],
            },
            {"name": "b", "material": "soft", "mesh": second, "velocity": [-2.5, 0.0, 0.0]},
        ],
        "contact": {"friction": 0.0},
        "output": {"audit": True, "fields_every": 1.6e-2},
    }
    result = carom.run(carom.Scenario.from_dict(case), out=tmp_path)
    assert result.summary["status"] == "completed" and result.summary["contacts"]
    worst = result.summary["penetration"]["worst"]
    # By the arcs that facets stand for.
    assert worst is None or worst["depth"] < 0.05 * worst["cell"]
    history = result.history
    assert max(abs(history["defect"])) < 1e-11 * result.summary["energy"]["initial"]
    for axis in "xyz":
        turning = history[f"angular_momentum_{axis}"]
        assert max(abs(turning - turning[0])) < 1e-8
    assert carom.audit(tmp_path).confirmed
