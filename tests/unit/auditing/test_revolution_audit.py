"""Bodies of revolution are audited: rings, their hoops, and the axis that stays where it is."""

import h5py
import pytest
from refuting import refuted_after

import carom
from tampered import in_case, in_h5, little_more


def ring_on_plate(condition, scheme):
    """A ring of triangles that falls on a round plate, both with damping, under a pressure."""
    return carom.Scenario.from_dict(
        {
            "analysis": {
                "end_time": 0.02,
                "time_step": 1e-3,
                "gravity": [0.0, -9.81],
                "scheme": {"kind": scheme},
            },
            "output": {"audit": True, "history_every": 1e-3, "fields_every": 2e-3},
            "materials": {
                "m": {
                    "kind": "neo-hookean",
                    "young": 1e5,
                    "poisson": 0.3,
                    "density": 1e3,
                    "damping": {"mass": 0.5, "stiffness": 1e-4},
                }
            },
            "bodies": [
                {
                    "name": name,
                    "material": "m",
                    "hypothesis": "axisymmetric",
                    "mesh": {"kind": "rectangle", **mesh},
                    "velocity": [0.0, speed],
                }
                for name, mesh, speed in (
                    ("plate", {"corner": [0, 0], "size": [0.5, 0.25], "divisions": [5, 4]}, 0.0),
                    (
                        "ring",
                        {
                            "corner": [0.1, 0.26],
                            "size": [0.2, 0.3],
                            "divisions": [2, 4],
                            "cell": "tri3",
                        },
                        -1.0,
                    ),
                )
            ],
            "obstacles": [{"kind": "plane", "name": "floor", "point": [0, 0], "normal": [0, 1]}],
            "loads": [
                {
                    "kind": "pressure",
                    "body": "ring",
                    "on": "right",
                    "pressure": "200*sin(100*t)",
                    "follower": True,
                }
            ],
            "contact": {"friction": 0.3, "condition": condition, "sources": "second"},
        }
    )


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("ring")
    carom.run(ring_on_plate("massless", "conserving"), out=out)
    return out


def test_bodies_of_revolution_are_confirmed(run):
    audit = carom.audit(run)
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    # Forces are up to 5 kN, energies up to 50 J.
    assert checks["equation of motion"].figure < 2e-6
    assert checks["massless nodes"].figure < 2e-6
    assert checks["Coulomb: slip"].count > 20
    assert checks["energy of the step"].figure < 1e-9
    assert checks["strain energy"].figure < 1e-11


def test_rings_with_mass_where_they_touch_are_confirmed(tmp_path):
    carom.run(ring_on_plate("gap", "theta"), out=tmp_path)
    audit = carom.audit(tmp_path)
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["equation of motion"].figure < 2e-6


def test_a_changed_ring_is_refuted(run, tmp_path):
    def off_the_axis(directory):
        with h5py.File(directory / "audit.h5", "r+") as file:
            file["steps/000003/end/displacement"][0, 0] = 1e-9

    found = refuted_after(run, tmp_path, off_the_axis)
    assert {"supports", "stored steps"} <= found


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("density = 1000.0", "density = 1001.0", "kinetic energy"),
        ("200*sin", "200.1*sin", "equation of motion"),
    ],
)
def test_rings_of_another_case_are_refuted(run, tmp_path, old, new, found):
    assert found in refuted_after(run, tmp_path, in_case(old, new))


def test_a_changed_hoop_is_refuted(run, tmp_path):
    tamper = in_h5("audit.h5:steps/000005/end/displacement", little_more)
    assert "equation of motion" in refuted_after(run, tmp_path, tamper)
