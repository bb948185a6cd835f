"""Load steps that are stabilised are audited: bodies go on with inertia to another balance."""

import h5py
import pytest
from refuting import refuted_after

import carom
from tampered import in_csv, in_h5

STEP = 0.1
SLID = 5
"""Number of the step in which the block loses its hold."""


def pushed(wall=0.4):
    """A block that friction holds until it is pushed too hard: it slides until a wall holds it."""
    return carom.Scenario.from_dict(
        {
            "analysis": {
                "kind": "static",
                "end_time": 0.8,
                "time_step": STEP,
                "stabilisation": "dynamic",
                "max_halvings": 0,
            },
            "materials": {
                "m": {"kind": "neo-hookean", "young": 3e6, "poisson": 0.3, "density": 1e3}
            },
            "bodies": [
                {
                    "name": "block",
                    "material": "m",
                    "mesh": {"kind": "rectangle", "corner": [0, 0], "size": [0.1, 0.1]}
                    | {"divisions": [2, 2]},
                }
            ],
            "loads": [
                {"kind": "pressure", "body": "block", "on": "top", "pressure": 1e4},
                {"kind": "traction", "body": "block", "on": "left", "traction": ["6e3*t", 0.0]},
            ],
            "obstacles": [
                {"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]},
                {"name": "wall", "kind": "plane", "point": [wall, 0], "normal": [-1, 0]},
            ],
            "contact": {"condition": "gap", "friction": 0.3},
            "output": {
                "audit": True,
                "history_every": STEP,
                "fields_every": STEP,
                "track": [{"name": "top", "body": "block", "point": [0.1, 0.1]}],
            },
        }
    )


def column():
    """A column between plates that buckles under its shortening, with a push."""
    plates = [
        {"name": "below", "kind": "plane", "point": [0, 0], "normal": [0, 1]},
        {"name": "above", "kind": "plane", "point": [0, 1], "normal": [0, -1]}
        | {"motion": {"y": "-0.1*t"}},
    ]
    return carom.Scenario.from_dict(
        {
            "analysis": {
                "kind": "static",
                "end_time": 2.0,
                "time_step": 0.5,
                "stabilisation": "dynamic",
                "max_halvings": 1,
            },
            "materials": {
                "m": {"kind": "neo-hookean", "young": 1e6, "poisson": 0.3, "density": 1e3}
            },
            "bodies": [
                {
                    "name": "column",
                    "material": "m",
                    "mesh": {"kind": "rectangle", "corner": [0, 0], "size": [0.2, 1]}
                    | {"divisions": [1, 4], "cell": "quad9"},
                }
            ],
            "obstacles": plates,
            "contact": {"condition": "gap", "friction": 0.8, "penetration_tolerance": 0.5},
            "output": {"audit": True, "history_every": 0.5, "fields_every": 0.5},
        }
    )


def confirmed(directory):
    audit = carom.audit(directory)
    assert [(check.name, check.where, check.figure) for check in audit.refuted] == []
    return audit


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("pushed")
    carom.run(pushed(), out=out)
    audit = confirmed(out)
    assert any("steps with inertia" in left.what for left in audit.unchecked)
    return out


def test_a_step_that_ends_what_went_on_with_inertia_is_stored(run):
    with h5py.File(run / "audit.h5") as file:
        step = file[f"steps/{SLID:06d}"]
        assert step["start"].attrs["time"] == step["end"].attrs["time"]
        assert abs(step["start/velocity"][:]).max() > 0.0
        assert not step["end/velocity"][:].any()


def test_a_push_out_of_an_unstable_state_is_confirmed(tmp_path):
    result = carom.run(column(), out=tmp_path)
    confirmed(tmp_path)
    history = result.history
    # No load does work, and a push is all that is external.
    assert 0.0 < history["external"][-1] <= 1e-8 * history["strain"].max()


def test_more_than_a_push_is_found(tmp_path):
    result = carom.run(column(), out=tmp_path / "run")
    history = result.history
    pushes = float(3e-8 * history["retried_steps"].sum() * history["strain"].max())
    tamper = in_csv("history.csv", "external", lambda work: work + pushes, row=-1)
    assert "row: external" in refuted_after(tmp_path / "run", tmp_path, tamper)


def test_a_run_that_fails_on_its_way_is_confirmed(tmp_path):
    case = pushed().model_copy(update={"obstacles": pushed().obstacles[:1]})
    with pytest.raises(carom.ConvergenceError, match="not held"):
        carom.run(case, out=tmp_path)
    assert carom.Result.open(tmp_path).history["kinetic"][-1] > 0.0
    confirmed(tmp_path)


@pytest.mark.parametrize(
    ("name", "check"),
    [
        ("start/velocity", "ledger: kinetic"),
        ("end/velocity", "velocity update"),
        ("end/contact_force", "equation of motion"),
        ("end/contact_reaction", "nodal reactions"),
        ("end/displacement", "ledger: strain"),
        ("ledger@scheme", "ledger: scheme"),
        ("ledger@kinetic", "ledger: kinetic"),
    ],
)
def test_a_changed_step_that_comes_to_rest_is_found(run, tmp_path, name, check):
    tamper = in_h5(f"audit.h5:steps/{SLID:06d}/{name}", lambda value: 1.01 * value + 1e-3)
    assert check in refuted_after(run, tmp_path, tamper)


def test_a_row_with_another_energy_is_found(run, tmp_path):
    for number, column_of in enumerate(("scheme", "external", "friction")):
        tamper = in_csv("history.csv", column_of, row=SLID + 2)
        refuted = refuted_after(run, tmp_path / str(number), tamper)
        assert {"row: defect", "ledger in history"} & refuted
