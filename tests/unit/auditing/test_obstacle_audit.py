"""Discs and holes as obstacles are audited."""

import shutil

import pytest

import carom

SHAPES = {
    "disc": {"kind": "sphere", "centre": [0.2, -1.0], "radius": 1.0, "velocity": [0.2, 0.1]},
    "hole": {"kind": "sphere", "centre": [0.3, 2.5], "radius": 2.6, "cavity": True},
    "shaken": {
        "kind": "sphere",
        "centre": [0.0, -3.0],
        "radius": 3.0,
        "motion": {"x": "0.02*sin(30*t)", "y": "0.1*t^2"},
    },
}


def thrown(shape, condition="gap", scheme="theta"):
    """A block and a disc are thrown at an obstacle."""
    elastic = {"kind": "saint-venant-kirchhoff", "young": 1e4, "poisson": 0.3, "density": 10.0}
    block = {"kind": "rectangle", "corner": [0.0, 0.05], "size": [0.6, 0.4], "divisions": [6, 4]}
    disc = {"kind": "disc", "centre": [-0.4, 0.4], "radius": 0.25, "divisions": 4}
    return carom.Scenario.from_dict(
        {
            "analysis": {
                "end_time": 0.2,
                "time_step": 2e-3,
                "gravity": [0, -9.81],
                "scheme": {"kind": scheme},
            },
            "materials": {"m": elastic},
            "bodies": [
                {"name": "block", "material": "m", "mesh": block, "velocity": [-0.5, -1.0]},
                {"name": "disc", "material": "m", "mesh": disc, "velocity": [0.5, -1.0]},
            ],
            "obstacles": [{"name": "thing", **SHAPES[shape]}],
            "contact": {"condition": condition, "friction": 0.3, "penetration_tolerance": 2.0},
            "output": {"fields_every": 1e-2, "history_every": 2e-3, "audit": True},
        }
    )


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("method", [("gap", "theta"), ("massless", "conserving")])
def test_round_obstacles_are_confirmed(tmp_path, shape, method):
    carom.run(thrown(shape, *method), out=tmp_path)
    audit = carom.audit(tmp_path)
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["contact gaps"].count > 10
    assert checks["contact normals"].figure < 1e-7


def test_a_radius_that_is_not_that_of_the_run_is_found(tmp_path):
    carom.run(thrown("disc"), out=tmp_path / "run")
    shutil.copytree(tmp_path / "run", tmp_path / "changed")
    text = (tmp_path / "changed" / "case.toml").read_text()
    (tmp_path / "changed" / "case.toml").write_text(
        text.replace("radius = 1.0", "radius = 1.00001")
    )
    refuted = {check.name for check in carom.audit(tmp_path / "changed").refuted}
    assert {"contact gaps", "Signorini: complementarity"} <= refuted
