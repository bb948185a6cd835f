"""Friction that depends on the direction is audited."""

import numpy as np
import pytest
from refuting import confirmed, refuted_after

import carom
from carom.auditing.steps.ellipse import Ellipse
from tampered import in_case, in_h5

DT = 4e-3


def sliding(friction, method=("gap", "theta"), **rider):
    """A plate that slides on a floor that is drawn on, with a block that turns on it."""
    condition, scheme = method
    return carom.Scenario.from_dict(
        {
            "dimension": 3,
            "analysis": {
                "end_time": 5 * DT,
                "time_step": DT,
                "gravity": [0, 0, -9.81],
                "scheme": {"kind": scheme},
            },
            "materials": {
                "m": {"kind": "neo-hookean", "young": 2e4, "poisson": 0.3, "density": 20.0}
            },
            "bodies": [
                {
                    "name": "plate",
                    "material": "m",
                    "mesh": {
                        "kind": "box",
                        "corner": [0, 0, 0],
                        "size": [1, 0.8, 0.3],
                        "divisions": [3, 3, 3] if condition == "massless" else [2, 2, 1],
                    },
                    "velocity": [0.4, 0.3, -0.1],
                },
                {
                    "name": "block",
                    "material": "m",
                    "mesh": {
                        "kind": "box",
                        "corner": [0.33, 0.21, 0.3],
                        "size": [0.4, 0.4, 0.2],
                        "divisions": [1, 1, 1],
                    },
                    "velocity": [-0.2, 0.1, -0.1],
                    "spin": [0, 0, 2.0],
                    **rider,
                },
            ],
            "obstacles": [
                {"kind": "plane", "name": "floor", "point": [0, 0, 0], "normal": [0, 0, 1]}
            ],
            "contact": {
                "condition": condition,
                "penetration_tolerance": 0.5,
                "pairs": [
                    {
                        "between": ["plate", "floor"],
                        "friction": {
                            "along": 0.1,
                            "across": 0.4,
                            "direction": [1, 0.5, 0.2],
                            "of": "floor",
                        },
                    },
                    {"between": ["plate", "block"], "friction": friction},
                ],
            },
            "output": {"audit": True, "history_every": DT, "fields_every": DT},
        }
    )


OF_PLATE = {"along": 0.3, "across": 0.1, "direction": [1, 1, 0.1], "of": "plate"}
OF_BLOCK = {**OF_PLATE, "of": "block", "direction": [1, 0.2, 0]}
BY_SPEED = {"static": 0.4, "kinetic": 0.2, "speed": 0.3}
LAWS = {**OF_PLATE, "along": BY_SPEED, "across": {"formula": "0.1 + min(s, 0.1)"}}


def run_confirmed(case, directory):
    carom.run(case, out=directory)
    checks = confirmed(directory)
    assert checks["Coulomb: slip"].count > 30
    assert checks["Coulomb: slip"].figure < 1e-8
    assert checks["ledger: friction"].figure < 1e-8
    return checks


@pytest.mark.parametrize(
    ("friction", "method"),
    [
        (OF_BLOCK, ("midpoint", "conserving")),
        (OF_PLATE, ("massless", "conserving")),
        (LAWS, ("gap", "theta")),
    ],
)
def test_friction_that_depends_on_the_direction_is_confirmed(tmp_path, friction, method):
    run_confirmed(sliding(friction, method), tmp_path)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("grain")
    run_confirmed(sliding(OF_PLATE), out)
    return out


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("along = 0.1,", "along = 0.1001,"),
        ("across = 0.4", "across = 0.4004"),
        ("[1.0, 0.5, 0.2]", "[1.0, 0.501, 0.2]"),
        ("[1.0, 1.0, 0.1]", "[1.0, 1.002, 0.1]"),
        ('of = "plate"', 'of = "block"'),
    ],
)
def test_another_ellipse_is_found(run, tmp_path, old, new):
    assert {"Coulomb: slip", "Coulomb: cone"} & refuted_after(run, tmp_path, in_case(old, new))


def test_a_changed_reaction_is_found(run, tmp_path):
    tamper = in_h5("audit.h5:steps/000003/end/contact_reaction", lambda value: 1.001 * value)
    assert "Coulomb: slip" in refuted_after(run, tmp_path, tamper)


def test_what_slides_goes_along_the_normal_of_the_ellipse():
    """So that no other reaction of the cone would take more: r·w is least there."""
    grain, normal = np.array([[0.6, 0.8, 0.0]]), np.array([[0.0, 0.0, 1.0]])
    ellipse = Ellipse(grain, normal, np.array([[0.1, 0.4]]))
    w, second = np.array([[0.3, -0.5, 0.0]]), np.array([[-0.8, 0.6, 0.0]])
    turns = np.linspace(0.0, 2 * np.pi, 4001)[:, None]
    reactions = 0.1 * np.cos(turns) * grain + 0.4 * np.sin(turns) * second
    many = Ellipse(*(np.repeat(a, 4001, axis=0) for a in (grain, normal, ellipse.coefficients)))
    np.testing.assert_allclose(many.force(reactions), 0.4, rtol=1e-14)
    most = -(reactions @ w[0]).min()
    assert ellipse.largest * ellipse.slip(w) == pytest.approx(most, rel=1e-6)
