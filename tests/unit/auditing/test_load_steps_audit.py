"""Load steps are audited: the balance of forces, the path that their books are of, and contact."""

import pytest
from refuting import refuted_after

import carom
from tampered import in_case, in_csv, in_h5, little_more


def pressed():
    """A block that is pulled along another, which a spring and a pressure that follows hold."""
    return carom.Scenario.from_dict(
        {
            "analysis": {"kind": "static", "end_time": 0.6, "time_step": 0.1, "gravity": [0, -2]},
            "output": {"audit": True, "history_every": 0.1, "fields_every": 0.1},
            "materials": {
                "m": {"kind": "neo-hookean", "young": 1e5, "poisson": 0.3, "density": 1e3}
            },
            "bodies": [
                {
                    "name": "low",
                    "material": "m",
                    "mesh": {
                        "kind": "rectangle",
                        "corner": [0, 0],
                        "size": [2.0, 0.5],
                        "divisions": [8, 2],
                    },
                },
                {
                    "name": "top",
                    "material": "m",
                    "mesh": {
                        "kind": "rectangle",
                        "corner": [0.7, 0.5],
                        "size": [0.61, 0.3],
                        "divisions": [3, 2],
                    },
                },
            ],
            "obstacles": [{"kind": "plane", "name": "floor", "point": [0, 0], "normal": [0, 1]}],
            "motions": [
                {"kind": "fixed", "body": "low", "on": "left"},
                {
                    "kind": "prescribed",
                    "body": "top",
                    "on": "top",
                    "x": "0.02*t*t",
                    "y": "-0.03*t",
                },
            ],
            "springs": [
                {
                    "name": "stay",
                    "between": [{"body": "low", "on": "right"}, {"point": [2.6, 0.2]}],
                    "stiffness": 2e3,
                    "free_length": 0.5,
                }
            ],
            "loads": [
                {
                    "kind": "pressure",
                    "body": "low",
                    "on": "right",
                    "pressure": "500*t",
                    "follower": True,
                }
            ],
            "contact": {"friction": 0.3},
        }
    )


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("pressed")
    carom.run(pressed(), out=out)
    return out


def test_load_steps_are_confirmed(run):
    audit = carom.audit(run)
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    # Forces are up to 1 kN, energies up to 66 J.
    assert checks["equation of motion"].figure < 4e-8
    assert checks["Signorini: complementarity"].figure < 6e-9
    assert checks["Coulomb: slip"].figure < 2e-9
    assert checks["Coulomb: slip"].count > 50
    assert checks["support forces"].figure < 1e-10
    assert checks["ledger: scheme"].figure < 1e-10
    assert checks["ledger: prescribed"].figure < 1e-10
    assert checks["books: steps"].figure < 2e-10


CHANGED = [
    ("audit.h5:steps/000002/end/displacement", "equation of motion"),
    ("audit.h5:steps/000003/end/velocity", "velocity update"),
    ("audit.h5:steps/000004/end/contact_reaction", "nodal reactions"),
    ("audit.h5:steps/000004/ledger@friction", "ledger: friction"),
    ("audit.h5:steps/000004/ledger@scheme", "ledger: scheme"),
    ("top.top.force_x", "support forces"),
    ("normal_contact", "ledger in history"),
    ("angular_momentum", "row: angular"),
]


def much_more(value):
    """Return a number that is 1 % larger: reactions are known no better than their places."""
    return 1.01 * value


def test_changed_numbers_of_load_steps_are_found(run, tmp_path):
    def tamper(directory):
        for name, _ in CHANGED:
            stored = name.startswith("audit.h5")
            amount = much_more if "friction" in name else little_more
            change = in_h5(name, amount) if stored else in_csv("history.csv", name)
            change(directory)

    assert {found for _, found in CHANGED} <= refuted_after(run, tmp_path, tamper)


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("0.02*t*t", "0.02000001*t*t", "supports"),
        ("500*t", "500.01*t", "equation of motion"),
        ("friction = 0.3", "friction = 0.29", "Coulomb: cone"),
    ],
)
def test_load_steps_of_another_case_are_refuted(run, tmp_path, old, new, found):
    assert found in refuted_after(run, tmp_path, in_case(old, new))
