"""Metal that flows is audited step by step, from what every point remembers, with its viscosity."""

import pytest
from refuting import refuted_after

import carom
from tampered import in_case, in_csv, in_h5, in_summary, little_more


def bar(**output):
    """A short copper bar of revolution that hits a wall at 150 m/s: 16 steps."""
    return carom.Scenario.from_dict(
        {
            "analysis": {"end_time": 3.2e-6, "time_step": 2e-7},
            "output": {"audit": True, "history_every": 2e-7, "fields_every": 2e-7, **output},
            "materials": {
                "copper": {
                    "kind": "j2-plasticity",
                    "young": 117e9,
                    "poisson": 0.35,
                    "density": 8930.0,
                    "yield_stress": 400e6,
                    "hardening": 100e6,
                    "saturation_stress": 450e6,
                    "saturation_rate": 20.0,
                    "viscosity": {"shear": 2e3, "bulk": 1e3},
                }
            },
            "bodies": [
                {
                    "name": "bar",
                    "material": "copper",
                    "hypothesis": "axisymmetric",
                    "formulation": "mean-dilatation",
                    "mesh": {
                        "kind": "rectangle",
                        "corner": [0.0, 0.0],
                        "size": [3.2e-3, 6.4e-3],
                        "divisions": [3, 5],
                    },
                    "velocity": [0.0, -150.0],
                }
            ],
            "obstacles": [{"kind": "plane", "name": "wall", "point": [0, 0], "normal": [0, 1]}],
            "contact": {"condition": "gap", "friction": 0.1},
        }
    )


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("bar")
    carom.run(bar(), out=out)
    return out


def test_flow_is_confirmed(run):
    audit = carom.audit(run)
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    # Of 21 J some 8 J are plastic work; points have flowed by up to 0.3.
    assert checks["plastic strain"].figure < 1e-14
    assert checks["ledger: plastic"].figure < 1e-13
    assert checks["ledger: viscous"].figure < 1e-13
    assert checks["equation of motion"].figure < 1e-5  # of some 5 kN
    assert checks["energy of the step"].figure < 2e-10
    assert max(carom.Result.open(run).fields["plastic_strain"][-1]) > 0.05


CHANGED = [
    (in_h5("audit.h5:steps/000004/ledger@plastic", little_more), "ledger: plastic"),
    (in_h5("audit.h5:steps/000006/ledger@viscous", little_more), "ledger: viscous"),
    (in_h5("fields.vtkhdf:VTKHDF/CellData/plastic_strain", little_more), "plastic strain"),
    (in_csv("history.csv", "plastic"), "row: defect"),
    (in_summary("energy", "plastic"), "summary: energies"),
]


def test_changed_numbers_of_flow_are_found(run, tmp_path):
    def tamper(directory):
        for change, _ in CHANGED:
            change(directory)

    assert {found for _, found in CHANGED} <= refuted_after(run, tmp_path, tamper)


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("saturation_rate = 20.0", "saturation_rate = 20.001", "plastic strain"),
        ("shear = 2000.0", "shear = 2000.1", "equation of motion"),
    ],
)
def test_another_metal_is_refuted(run, tmp_path, old, new, found):
    assert found in refuted_after(run, tmp_path, in_case(old, new))


def test_what_flowed_between_stored_steps_is_left_unchecked_with_what_to_store(tmp_path):
    carom.run(bar(fields_every=8e-7), out=tmp_path)
    audit = carom.audit(tmp_path)
    assert audit.refuted == ()
    (left,) = (left for left in audit.unchecked if "flowed" in left.what)
    assert left.store.startswith("output.fields_every = the time step")
