"""Steps of reduced bodies are audited: momenta, and amplitudes in shapes that are found again."""

import numpy as np
import pytest
from refuting import refuted_after

import carom
from carom.auditing.bodies import vibrations
from tampered import in_case, in_h5

STEPS = 10
END = f"audit.h5:steps/{STEPS - 1:06d}/end"


def dropped(method=("gap", "theta"), dimension=2, **changes):
    """A reduced body that falls on a floor and turns, and a second one that is thrown on it."""
    condition, scheme = method
    kind, corners = "rectangle", ([0, 0.005], [0.3, 0.415])
    sizes, divisions = ([1, 0.4], [0.5, 0.3]), ([4, 2], [2, 2])
    if dimension == 3:
        kind, corners = "box", ([0, 0, 0.005], [0.3, 0.1, 0.415])
        sizes, divisions = ([1, 0.6, 0.4], [0.5, 0.4, 0.3]), ([2, 2, 2], [2, 2, 2])
    up = np.eye(dimension)[-1]
    meshes = [
        {"kind": kind, "corner": corner, "size": size, "divisions": cells}
        for corner, size, cells in zip(corners, sizes, divisions, strict=True)
    ]
    first = {"kind": "reduced", "material": "m", "modes": 3, "mesh": meshes[0]}
    second = {"kind": "reduced", "material": "m", "modes": 2, "mesh": meshes[1]}
    case = {
        "dimension": dimension,
        "analysis": {
            "end_time": STEPS * 1e-3,
            "time_step": 1e-3,
            "scheme": {"kind": scheme},
            "gravity": list(-10.0 * up),
        },
        "materials": {
            "m": {"kind": "linear-elastic", "young": 1e6, "poisson": 0.3, "density": 1000.0}
            | {"damping": {"stiffness": 1e-4}}
        },
        "bodies": [
            {"name": "a", "velocity": list(0.3 * np.eye(dimension)[0] - up)} | first,
            {"name": "b", "velocity": list(-6.0 * up)} | second,
        ],
        "obstacles": [
            {"name": "floor", "kind": "plane", "point": list(0 * up), "normal": list(up)}
        ],
        "contact": {"condition": condition, "friction": 0.3, "penetration_tolerance": 0.5},
        "output": {"audit": True, "history_every": 1e-3, "fields_every": 1e-3},
    }
    case["bodies"][0]["spin"] = 0.5 if dimension == 2 else [0.2, 0.3, 0.5]
    return {**case, **changes}


def confirmed(case, directory):
    carom.run(carom.Scenario.from_dict(case), out=directory)
    audit = carom.audit(directory)
    assert [(check.name, check.where, check.figure) for check in audit.refuted] == []
    checks = {check.name: check for check in audit.checks}
    assert checks["contact gaps"].count > 3
    assert checks["reduced shapes"].figure > 0.0
    return audit


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("dropped")
    confirmed(dropped(), out)
    return out


@pytest.mark.parametrize("method", [("midpoint", "conserving"), ("endpoint", "theta")])
def test_steps_in_the_plane_are_confirmed(tmp_path, method):
    confirmed(dropped(method), tmp_path)


def test_steps_of_a_scheme_that_takes_energy_are_confirmed(tmp_path):
    case = dropped()
    case["analysis"]["scheme"] |= {"theta": 0.7, "xi": 0.8}
    confirmed(case, tmp_path)


def test_steps_in_space_are_confirmed(tmp_path):
    case = dropped(("midpoint", "conserving"), 3)
    case["analysis"]["end_time"] = 8e-3
    confirmed(case, tmp_path)


def test_a_reduced_body_before_nodes_without_mass_is_confirmed(tmp_path):
    case = dropped(("massless", "theta"))
    case["materials"]["m"]["kind"] = "saint-venant-kirchhoff"
    other = case["bodies"][1]
    del other["kind"], other["modes"]
    other["mesh"]["divisions"] = [6, 6]
    confirmed(case, tmp_path)


def test_modes_that_end_between_equal_frequencies_are_left(tmp_path):
    case = dropped(dimension=3)
    # Across its square section it has the same frequency twice.
    case["bodies"][1]["mesh"]["size"] = [0.5, 0.3, 0.3]
    audit = confirmed(case, tmp_path)
    left = [one.what for one in audit.unchecked if "vibrations of" in one.what]
    assert left == ["vibrations of 'b': its modes end between equal frequencies"]


def test_bodies_that_are_too_large_are_audited_without_their_shapes(run, monkeypatch):
    monkeypatch.setattr("carom.auditing.bodies.body.MOST_UNKNOWNS", 20)
    audit = carom.audit(run)
    assert audit.confirmed
    left = [one.what for one in audit.unchecked if "vibrations of" in one.what]
    assert left[0].startswith("vibrations of 'a': it has more than ")


@pytest.mark.parametrize(
    ("name", "change", "check"),
    [
        ("end/velocity", lambda v: v + 1e-5, "velocity update"),
        ("end/displacement", lambda u: u + 1e-7, "equation of motion"),
        ("end/contact_force", lambda f: 1.001 * f + 0.1, "equation of motion"),
        ("start/velocity", lambda v: v + 1e-4, "equation of motion"),
        ("ledger@viscous", lambda work: 1.001 * work + 1e-6, "ledger: viscous"),
        ("ledger@strain", lambda energy: 1.001 * energy + 1e-6, "ledger: strain"),
    ],
)
def test_a_changed_step_is_found(run, tmp_path, name, change, check):
    tamper = in_h5(END.replace("end", name), change)
    assert check in refuted_after(run, tmp_path, tamper)


def test_other_modes_or_another_damping_are_found(run, tmp_path):
    fewer = in_case("modes = 3", "modes = 1")
    assert "reduced shapes" in refuted_after(run, tmp_path / "a", fewer)
    damped = in_case("stiffness = 0.0001", "stiffness = 0.00011")
    assert {"equation of motion", "ledger: viscous"} <= refuted_after(run, tmp_path / "b", damped)


def test_shapes_have_a_mass_of_one_and_no_momenta():
    """Of a chain of three masses on a line with springs of one between them, the ends kept."""
    mass, k = np.diag([1.0, 0.0, 2.0, 0.0, 1.0, 0.0]) + 1e-3 * np.eye(6), np.eye(6)
    for a, b in ((0, 2), (2, 4)):
        k[np.ix_([a, b], [a, b])] += np.array([[1.0, -1.0], [-1.0, 1.0]])
    arms = np.array([[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0]])
    found = vibrations.Vibrations.of(mass, k, arms, np.array([0, 2]), 2)
    shapes, loads = (part.reshape(6, -1) for part in (found.shapes, found.loads))
    assert shapes.T @ loads == pytest.approx(np.eye(3), abs=1e-12)
    assert found.loads.sum(axis=0) == pytest.approx(np.zeros((2, 3)), abs=1e-12)
    assert found.doubt == ""


def test_a_stiff_rod_that_bounces_is_confirmed(tmp_path):
    """Its energies are known to some 1e-11, as its amplitudes are read from nodes in every step.

    Symptoms guarded against: books refuted for 4e-10 of 31 J, and, in the row after a release,
    "without an event", for a settling impulse that did 1e-25 J.
    """
    steel = {"kind": "linear-elastic", "young": 210e9, "poisson": 0.3, "density": 7800.0}
    mesh = {"kind": "rectangle", "corner": [0, 0.001], "size": [0.02, 0.4], "divisions": [4, 80]}
    rod = {"name": "rod", "kind": "reduced", "material": "steel", "modes": 20, "mesh": mesh}
    case = {
        "analysis": {"end_time": 4e-3, "time_step": 2e-6, "gravity": [0, -2000.0]},
        "materials": {"steel": steel},
        "bodies": [rod | {"contact_sets": ["bottom"], "velocity": [0, -1.0], "spin": 0.2}],
        "obstacles": [{"kind": "plane", "name": "floor", "point": [0, 0], "normal": [0, 1]}],
        "contact": {"condition": "midpoint", "friction": 0.1},
        "output": {"history_every": 2e-5, "fields_every": 2e-5},
    }
    result = carom.run(carom.Scenario.from_dict(case), out=tmp_path)
    assert len(result.summary["contacts"]) == 2
    assert [(check.name, check.where) for check in carom.audit(tmp_path).refuted] == []
