"""Loads, and obstacles that move by functions of time, are audited."""

import pytest
from two_discs import FLOOR, scenario

import carom
from tampered import with_another_case

SHAKEN = {
    **{key: value for key, value in FLOOR.items() if key != "velocity"},
    "motion": {
        "x": "0.02*sin(40*t) + 0.01*(abs(t - 0.1) - 0.1)",
        "y": {"time": [0.0, 0.05, 0.2], "value": [0.0, 0.01, -0.02]},
    },
}
LOADS = [
    {"kind": "pressure", "body": "a", "on": "surface", "pressure": "300*min(t/0.05, 1)"},
    {
        "kind": "pressure",
        "body": "b",
        "on": "surface",
        "pressure": {"time": [0.0, 0.1], "value": [0.0, 200.0]},
        "follower": True,
    },
    {"kind": "traction", "body": "b", "on": "all", "traction": ["10*exp(-t/0.1)", -5.0]},
    {"kind": "force", "body": "a", "on": "all", "force": [0.0, "0.05*cos(30*t)^2"]},
]


GENTLE = {"analysis.gravity": [0, -5.0], "analysis.end_time": 0.1, "analysis.time_step": 1e-3}
"""So that no corner folds where nodes have no mass."""


def driven(condition, scheme, **changes):
    given = {"obstacles": [SHAKEN], "loads": LOADS, "output.fields_every": 0.02}
    return scenario(condition, scheme, **{**given, "analysis.gravity": [0, -20.0], **changes})


@pytest.mark.parametrize(
    ("method", "changes"),
    [
        (("gap", "theta"), {}),
        (("midpoint", "conserving"), {"contact.friction": 0.0}),
        (("endpoint", "theta"), {}),
        (("massless", "theta"), GENTLE),
        (("massless", "conserving"), GENTLE),
    ],
)
def test_loads_and_moving_obstacles_are_confirmed(tmp_path, method, changes):
    result = carom.run(driven(*method, **changes), out=tmp_path)
    assert abs(result.summary["energy"]["external"]) > 0.1
    assert abs(result.summary["energy"]["prescribed"]) > 0.01
    audit = carom.audit(tmp_path)
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["ledger: external"].figure < 1e-11
    assert checks["equation of motion"].figure < 1e-5


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("driven")
    carom.run(driven("gap", "theta"), out=out)
    return out


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("300*min", "300.0003*min", {"ledger: external", "equation of motion"}),
        ("200.0", "200.0002", {"ledger: external", "equation of motion"}),
        ("10*exp", "10.00001*exp", {"ledger: external", "impulse"}),
        ("0.05*cos", "0.0500001*cos", {"ledger: external", "books: steps"}),
        ("0.02*sin", "0.02001*sin", {"ledger: prescribed", "Coulomb: slip"}),
        ("-0.02]", "-0.02001]", {"contact gaps", "ledger: prescribed"}),
    ],
)
def test_a_drive_that_is_not_that_of_the_run_is_found(tmp_path, run, old, new, found):
    directory = with_another_case(run, tmp_path / "changed", old, new)
    assert found <= {check.name for check in carom.audit(directory).refuted}
