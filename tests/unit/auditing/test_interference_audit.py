"""Pairs whose surfaces are pushed apart are audited."""

import pytest
from refuting import refuted_after
from two_discs import scenario

import carom
from tampered import in_h5, with_another_case

METHODS = [
    ("gap", "theta"),
    ("midpoint", "conserving"),
    ("endpoint", "theta"),
    ("massless", "theta"),
    ("massless", "conserving"),
]
STATIC = {"kind": "static", "end_time": 1.0, "time_step": 0.25}


def fit(**changes):
    """A disc in a ring with a small hole, in half of a cross section of both."""
    steel = {"kind": "saint-venant-kirchhoff", "young": 1e4, "poisson": 0.3, "density": 1.0}
    disc = {"kind": "disc", "centre": [0.0, 0.0], "radius": 1.0, "divisions": 4}
    ring = {"kind": "ring", "centre": [0.0, 0.0], "inner_radius": 1.0, "outer_radius": 2.0}
    ring["divisions"] = [16, 3]
    case = {
        "analysis": STATIC,
        "materials": {"m": steel},
        "bodies": [
            {"name": "shaft", "material": "m", "mesh": disc},
            {"name": "hub", "material": "m", "mesh": ring},
        ],
        "motions": [{"kind": "fixed", "body": "hub", "on": "outer"}],
        "contact": {
            "friction": 0.1,
            "pairs": [{"between": ["shaft", "hub"], "interference": "0.01*min(2*t, 1)"}],
        },
        "output": {"audit": True, "fields_every": 0.25, "history_every": 0.25},
    }
    return carom.Scenario.from_dict({**case, **changes})


@pytest.mark.parametrize("method", METHODS)
def test_surfaces_that_are_pushed_apart_and_let_closer_are_confirmed(tmp_path, method):
    pairs = [
        {"between": ["a", "b"], "interference": "0.02*sin(40*t)"},
        {"between": ["a", "floor"], "interference": {"time": [0.0, 0.1], "value": [0.0, 0.03]}},
    ]
    changes = {"contact.pairs": pairs, "contact.penetration_tolerance": 0.5}
    result = carom.run(scenario(*method, **changes), out=tmp_path)
    audit = carom.audit(tmp_path)
    assert [(check.name, check.where, check.figure) for check in audit.refuted] == []
    checks = {check.name: check for check in audit.checks}
    assert checks["Coulomb: cone"].count > 5
    assert checks["contact gaps"].figure < 1e-6
    assert abs(result.summary["energy"]["prescribed"]) > 0.01


@pytest.mark.parametrize(
    "contact",
    [
        {},
        {"friction": 0.1, "pairs": [{"between": ["shaft", "hub"], "interference": 0.005}]},
        {
            "friction": 0.1,
            "pairs": [{"between": ["shaft", "hub"], "interference": "0.01*t + 0.001"}],
        },
    ],
)
def test_a_press_fit_is_confirmed(tmp_path, contact):
    result = carom.run(fit(**({"contact": contact} if contact else {})), out=tmp_path)
    assert result.history["normal_force"][-1] > 10.0
    audit = carom.audit(tmp_path)
    assert [(check.name, check.where, check.figure) for check in audit.refuted] == []


def test_overlaps_that_are_taken_up_are_confirmed(tmp_path):
    disc = {"kind": "disc", "centre": [0.0, 0.0], "radius": 1.01, "divisions": 4}
    ring = {"kind": "ring", "centre": [0.0, 0.0], "inner_radius": 1.0, "outer_radius": 2.0}
    bodies = [
        {"name": "shaft", "material": "m", "mesh": disc},
        {"name": "hub", "material": "m", "mesh": {**ring, "divisions": [16, 3]}},
    ]
    contact = {"friction": 0.1, "resolve_overlap": True, "overlap_resolved_at": 0.6}
    result = carom.run(fit(bodies=bodies, contact=contact), out=tmp_path / "run")
    assert result.history["normal_force"][-1] > 10.0
    audit = carom.audit(tmp_path / "run")
    assert [(check.name, check.where, check.figure) for check in audit.refuted] == []
    other = with_another_case(tmp_path / "run", tmp_path / "changed", "= 0.6", "= 0.6001")
    refuted = {check.name for check in carom.audit(other).refuted}
    assert {"contact gaps", "Signorini: complementarity"} <= refuted


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("fit")
    carom.run(fit(), out=out)
    return out


def test_an_interference_that_is_not_that_of_the_run_is_found(tmp_path, run):
    other = with_another_case(run, tmp_path / "changed", "0.01*min", "0.01001*min")
    refuted = {check.name for check in carom.audit(other).refuted}
    assert {"contact gaps", "ledger: prescribed"} <= refuted


def test_work_of_interference_that_was_changed_is_found(tmp_path, run):
    tamper = in_h5("audit.h5:steps/000001/ledger@prescribed", lambda work: 1.0001 * work)
    assert "ledger: prescribed" in refuted_after(run, tmp_path, tamper)
