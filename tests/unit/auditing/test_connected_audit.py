"""Springs, dampers and masses at points are audited, and what is changed is found."""

import pytest
from connected import SQUARE, connected

import carom
from tampered import with_another_case, with_another_number

UNEVEN = {"kind": "theta", "theta": 0.7, "xi": 0.6}


def by_name(audit):
    return {check.name: check for check in audit.checks}


@pytest.mark.parametrize(
    "method", [("midpoint", "conserving"), ("gap", UNEVEN), ("endpoint", "theta")]
)
def test_springs_dampers_and_masses_are_confirmed(tmp_path, method):
    result = carom.run(connected(*method), out=tmp_path)
    assert result.summary["energy"]["dampers"] > 0.01
    assert result.summary["energy"]["springs"] > 0.1
    audit = carom.audit(tmp_path)
    assert audit.refuted == ()
    checks = by_name(audit)
    assert checks["spring forces"].count == 44  # four springs at eleven times
    assert checks["spring forces"].figure < 1e-12
    assert checks["ledger: springs"].figure < 1e-13
    assert checks["ledger: prescribed"].figure < 1e-9


def inside():
    """A block with cells inside, which a spring holds by its middle as it falls on the floor."""
    middle = {"body": "soft", "point": [0.4, 0.5]}
    mesh = {**SQUARE, "corner": [0.0, 0.01], "divisions": [5, 6]}
    stay = {"name": "stay", "between": [middle, {"point": [1.5, 0.8]}], "stiffness": 30.0}
    return connected(
        "massless",
        "conserving",
        bodies=[{"name": "soft", "material": "soft", "mesh": mesh}],
        masses=[{**middle, "mass": 0.2}],
        springs=[{**stay, "damping": 0.1}],
    )


def test_a_spring_inside_a_body_without_mass_at_its_surface_is_confirmed(tmp_path):
    carom.run(inside(), out=tmp_path)
    audit = carom.audit(tmp_path)
    assert audit.refuted == ()
    checks = by_name(audit)
    assert checks["massless nodes"].count > 100
    assert checks["blend"].count > 10
    assert checks["books: steps"].figure < 1e-12


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("connected")
    carom.run(connected("midpoint", "conserving"), out=out)
    return out


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("stiffness = 20.0", "stiffness = 20.0002", {"spring forces", "ledger: springs"}),
        ("damping = 0.2", "damping = 0.200002", {"ledger: dampers", "equation of motion"}),
        ("damping = 0.3", "damping = 0.300003", {"ledger: dampers", "ledger: prescribed"}),
        ("free_length = 1.2", "free_length = 1.200012", {"spring forces", "equation of motion"}),
        ("80.0", "80.0008", {"spring forces", "ledger: springs"}),
        ("mass = 0.2\n", "mass = 0.200002\n", {"momentum", "angular impulse"}),
        ("1.9, 1.2", "1.90001, 1.2", {"centres", "angular momentum"}),
    ],
)
def test_a_part_that_is_not_that_of_the_run_is_found(tmp_path, run, old, new, found):
    directory = with_another_case(run, tmp_path / "changed", old, new)
    assert found <= {check.name for check in carom.audit(directory).refuted}


@pytest.mark.parametrize("column", ["rope.length", "strut.force", "springs", "dampers"])
def test_a_number_of_the_history_that_was_changed_is_found(tmp_path, run, column):
    directory = with_another_number(run, tmp_path / "changed", column, 1 + 1e-6)
    assert {check.name for check in carom.audit(directory).refuted} - {"files"}
