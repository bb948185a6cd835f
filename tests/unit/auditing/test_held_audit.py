"""Supports are audited: where they hold, with which force, and what they do."""

import shutil

import pytest
from held import SQUARE, held

import carom
from tampered import with_another_case, with_another_number

UNEVEN = {"kind": "theta", "theta": 0.7, "xi": 0.6}


@pytest.mark.parametrize(
    "method", [("gap", "theta"), ("midpoint", "conserving"), ("endpoint", UNEVEN)]
)
def test_supports_are_confirmed(tmp_path, method):
    result = carom.run(held(*method), out=tmp_path)
    assert abs(result.summary["energy"]["prescribed"]) > 0.01
    audit = carom.audit(tmp_path)
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["support forces"].count == 60  # two supports, two axes, fifteen steps
    assert checks["supports"].figure < 1e-15
    assert checks["ledger: prescribed"].figure < 1e-11


def test_a_body_without_mass_on_the_sides_that_nothing_holds_is_confirmed(tmp_path):
    mesh = {**SQUARE, "corner": [0.0, 0.0], "divisions": [6, 6]}
    beam = {"name": "beam", "material": "m", "mesh": mesh, "contact_sets": ["top"]}
    falls = {"name": "ball", "kind": "rigid", "density": 20.0, "velocity": [0.3, -1.0]}
    disc = {"kind": "disc", "centre": [0.6, 0.72], "radius": 0.2, "divisions": 4}
    motions = [{"kind": "prescribed", "body": "beam", "on": "bottom", "x": "0.01*sin(9*t)", "y": 0}]
    changes = {"bodies": [beam, {**falls, "mesh": disc}], "motions": motions, "springs": []}
    carom.run(held("massless", "conserving", **changes), out=tmp_path)
    audit = carom.audit(tmp_path)
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["blend"].count > 20
    assert checks["support forces"].count == 30


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("held")
    carom.run(held("midpoint", "conserving"), out=out)
    return out


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("0.02*sin", "0.02000001*sin", {"supports"}),
        ("[0.0, 0.03, -0.03]", "[0.0, 0.03000001, -0.03]", {"supports"}),
        ('on = "right"', 'on = "top"', {"supports", "equation of motion"}),
    ],
)
def test_a_support_that_is_not_that_of_the_run_is_found(tmp_path, run, old, new, found):
    directory = with_another_case(run, tmp_path / "changed", old, new)
    history = directory / "history.csv"
    history.write_text(history.read_text().replace("beam.right.", "beam.top."))
    if "top" not in new:
        shutil.copy(run / "history.csv", history)
    assert found <= {check.name for check in carom.audit(directory).refuted}


@pytest.mark.parametrize("column", ["beam.left.force_x", "beam.right.force_y", "prescribed"])
def test_a_force_or_work_that_was_changed_is_found(tmp_path, run, column):
    directory = with_another_number(run, tmp_path / "changed", column, 1 + 1e-5)
    assert {check.name for check in carom.audit(directory).refuted} - {"files"}


@pytest.mark.parametrize("scheme", ["theta", "conserving"])
def test_supports_at_nodes_without_mass_are_confirmed(tmp_path, scheme):
    mesh = {**SQUARE, "corner": [0.0, 0.0], "divisions": [6, 6]}
    disc = {"kind": "disc", "centre": [0.7, 0.72], "radius": 0.2, "divisions": 6}
    ball = {"name": "ball", "material": "m", "mesh": disc, "velocity": [0.3, -1.0]}
    floor = {"kind": "plane", "name": "floor", "point": [0, 0], "normal": [0, 1]}
    changes = {
        "bodies": [{"name": "beam", "material": "m", "mesh": mesh}, ball],
        "springs": [],
        "obstacles": [floor],
    }
    analysis = {
        "end_time": 0.06,
        "time_step": 2e-3,
        "gravity": [0, -9.81],
        "scheme": {"kind": scheme},
    }
    carom.run(held("massless", scheme, analysis=analysis, **changes), out=tmp_path / "run")
    audit = carom.audit(tmp_path / "run")
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["massless nodes"].figure < 1e-8
    assert checks["support forces"].figure < 1e-8
    assert checks["ledger: prescribed"].figure < 1e-10
    changed = with_another_number(
        tmp_path / "run", tmp_path / "changed", "beam.left.force_x", 1 + 1e-5, row=21
    )
    assert "support forces" in {check.name for check in carom.audit(changed).refuted}


RIGID = {
    "name": "ball",
    "kind": "rigid",
    "density": 10.0,
    "mesh": {"kind": "disc", "centre": [0.0, 2.0], "radius": 0.2, "divisions": 2},
}


def test_forces_and_moments_on_rigid_bodies_are_confirmed(tmp_path):
    pushed = {
        "kind": "resultant",
        "body": "ball",
        "force": ["2*sin(30*t)", 1.0],
        "moment": "0.3*cos(20*t)",
        "point": [0.1, 2.05],
    }
    floor = {"kind": "plane", "name": "floor", "point": [0, 1.78], "normal": [0, 1]}
    changes = {
        "bodies": [RIGID],
        "motions": [],
        "springs": [],
        "loads": [pushed],
        "obstacles": [floor],
    }
    carom.run(held("midpoint", UNEVEN, **changes), out=tmp_path / "run")
    audit = carom.audit(tmp_path / "run")
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["angular impulse"].figure < 1e-13
    assert checks["ledger: external"].figure < 1e-13
    for old, new in (("0.3*cos", "0.3001*cos"), ("0.1, 2.05", "0.101, 2.05")):
        changed = with_another_case(tmp_path / "run", tmp_path / new, old, new)
        assert "angular impulse" in {check.name for check in carom.audit(changed).refuted}
