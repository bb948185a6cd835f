"""Surfaces that hold together are audited: by how much, which, and how they let go."""

import h5py
import numpy as np
import pytest
from refuting import confirmed, refuted_after

import carom
from tampered import in_case, in_csv, in_h5

SOFT = {"kind": "saint-venant-kirchhoff", "young": 1e5, "poisson": 0.3, "density": 1e3}
LASTING = {"stress": 3e3, "lasting": True}

END = "audit.h5:steps/000001/end"


def blocks(method=("gap", "theta"), cohesion=None, *, lift=0.0, **contact):
    """A block on another, on which it holds, that is thrown up, or on which it falls."""
    condition, scheme = method
    return carom.Scenario.from_dict(
        {
            "analysis": {"end_time": 0.016, "time_step": 2e-3, "scheme": {"kind": scheme}},
            "materials": {"m": SOFT},
            "bodies": [
                {
                    "name": "lower",
                    "material": "m",
                    "mesh": {"kind": "rectangle", "corner": [0, 0], "size": [1, 0.3]}
                    | {"divisions": [3, 2]},
                },
                {
                    "name": "upper",
                    "material": "m",
                    "mesh": {"kind": "rectangle", "corner": [0.1, 0.3 + lift], "size": [0.7, 0.3]}
                    | {"divisions": [4, 1]},
                    "velocity": [0.1, -0.6 if lift else 0.1],
                },
            ],
            "contact": {
                "condition": condition,
                "friction": 0.3,
                "cohesion": cohesion or {"stress": 3e3},
                "penetration_tolerance": 0.5,
                **contact,
            },
            "output": {"audit": True, "history_every": 2e-3, "fields_every": 2e-3},
        }
    )


def pulled_off():
    """A block whose top is pulled from the floor in load steps: it holds, then lets go."""
    top = {"time": [0.0, 1.0, 2.0], "value": [0.0, 0.9e-3, 1.1e-3]}
    return carom.Scenario.from_dict(
        {
            "analysis": {"kind": "static", "end_time": 2.0, "time_step": 1.0},
            "materials": {
                "m": {"kind": "linear-elastic", "young": 1e6, "poisson": 0.0, "density": 1e3}
            },
            "bodies": [
                {
                    "name": "block",
                    "material": "m",
                    "mesh": {"kind": "rectangle", "corner": [0, 0], "size": [1, 0.5]}
                    | {"divisions": [3, 2]},
                }
            ],
            "obstacles": [{"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}],
            "motions": [{"kind": "prescribed", "body": "block", "on": "top", "x": 0.0, "y": top}],
            "contact": {"condition": "gap", "cohesion": 2e3},
            "output": {"audit": True, "history_every": 1.0, "fields_every": 1.0},
        }
    )


def run_confirmed(case, directory):
    carom.run(case, out=directory)
    return confirmed(directory)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("held")
    checks = run_confirmed(blocks(), out)
    assert checks["adhesion"].count > 5
    assert checks["adhesion: opening"].count > 0
    return out


@pytest.mark.parametrize("condition", ["midpoint", "massless"])
def test_what_holds_and_lets_go_is_confirmed(tmp_path, condition):
    checks = run_confirmed(blocks((condition, "conserving")), tmp_path)
    assert checks["adhesion"].count > 5
    assert checks["adhesion: opening"].count > 0


@pytest.fixture(scope="module")
def lasting(tmp_path_factory):
    """A run in which contacts hold once they have closed."""
    out = tmp_path_factory.mktemp("lasting")
    checks = run_confirmed(blocks(("endpoint", "conserving"), LASTING, lift=1e-3), out)
    assert checks["adhesion"].count > 20
    return out


def test_what_holds_although_nothing_lasts_is_found(lasting, tmp_path):
    other = in_case("lasting = true", "lasting = false")
    assert {"adhesion: history", "holding"} <= refuted_after(lasting, tmp_path, other)


def test_a_force_of_every_contact_is_confirmed(tmp_path):
    checks = run_confirmed(blocks(cohesion={"force": 350.0}), tmp_path)
    assert checks["adhesion"].count > 5


@pytest.mark.parametrize("discretisation", ["node-to-segment", "mortar"])
def test_bonds_that_nothing_breaks_are_confirmed(tmp_path, discretisation):
    method, bond = ("midpoint", "conserving"), {"unbreakable": True}
    checks = run_confirmed(blocks(method, bond, discretisation=discretisation), tmp_path)
    assert checks["contact gaps"].count > 30
    assert "adhesion: opening" not in checks


def test_load_steps_that_tear_a_block_off_are_confirmed(tmp_path):
    checks = run_confirmed(pulled_off(), tmp_path)
    assert checks["adhesion"].count == 4
    assert checks["adhesion: opening"].count == 4


def test_more_adhesion_than_the_case_says_is_found(run, tmp_path):
    more = in_h5(f"{END}/contact_adhesion", lambda a: 1.000001 * a)
    assert {"adhesion", "adhesion: history"} <= refuted_after(run, tmp_path / "a", more)
    other = in_case("stress = 3000.0", "stress = 3001.0")
    assert "adhesion" in refuted_after(run, tmp_path / "b", other)


def test_what_holds_no_more_without_having_opened_is_found(run, tmp_path):
    def without(directory):
        in_h5(f"{END}/contact_adhesion", lambda _: 0.0)(directory)

    refuted = refuted_after(run, tmp_path, without)
    assert {"adhesion: history", "holding"} <= refuted
    assert refuted & {"Signorini: compression", "Coulomb: cone", "certificate"}


def test_a_pull_beyond_the_adhesion_is_found(run, tmp_path):
    def stronger(directory):
        with h5py.File(directory / "audit.h5", "r+") as file:
            for step in file["steps"].values():
                end = step["end"]
                end["contact_adhesion"][...] = 0.5 * end["contact_adhesion"][:]

    refuted = refuted_after(run, tmp_path, stronger)
    assert {"adhesion", "Signorini: compression"} <= refuted


def test_another_number_of_contacts_that_hold_is_found(run, tmp_path):
    more = in_csv("history.csv", "holding", lambda count: count + 1, row=2)
    assert "holding" in refuted_after(run, tmp_path, more)


def test_what_holds_is_in_the_stored_steps(run):
    with h5py.File(run / "audit.h5") as file:
        adhesion = file["steps/000000/start/contact_adhesion"][:]
    # c times the area around every node of the finer side.
    assert np.sort(adhesion) == pytest.approx(3e3 * 0.7 / 4 * np.array([0.5, 0.5, 1, 1, 1]))
