"""Boxes, polygons and closed surfaces are audited: nodes, corners, and edges that cross."""

import pytest
from refuting import refuted_after

import carom
from tampered import in_case, in_h5

RUBBER = {"kind": "neo-hookean", "young": 1e5, "poisson": 0.3, "density": 1e3}


def dropped(dimension, obstacles, mesh, *, method, end_time):
    """A block that is thrown on obstacles with corners."""
    condition, scheme = method
    down = [0.0] * (dimension - 1)
    return carom.Scenario.from_dict(
        {
            "dimension": dimension,
            "analysis": {
                "end_time": end_time,
                "time_step": 2e-3,
                "gravity": [*down, -9.81],
                "scheme": {"kind": scheme},
            },
            "output": {"audit": True, "history_every": 2e-3, "fields_every": 4e-3},
            "materials": {"rubber": RUBBER},
            "bodies": [
                {
                    "name": "block",
                    "material": "rubber",
                    "mesh": mesh,
                    "velocity": [0.3, *down[1:], -1.0],
                }
            ],
            "obstacles": obstacles,
            "contact": {"friction": 0.3, "condition": condition},
        }
    )


STEP = {"kind": "box", "name": "step", "corner": [-0.5, 0.0], "size": [0.7, 0.3]}
WEDGE = {
    "kind": "polygon",
    "name": "wedge",
    "points": [[0.55, 0.0], [0.65, 0.25], [1.5, 0.0]],
    "velocity": [0.0, 1.0],
}


def in_the_plane(condition, scheme):
    """A block on the corner of a step, and with the tip of a wedge between its nodes."""
    mesh = {"kind": "rectangle", "corner": [0, 0.31], "size": [1.0, 0.3], "divisions": [7, 3]}
    return dropped(2, [STEP, WEDGE], mesh, method=(condition, scheme), end_time=0.048)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("wedge")
    carom.run(in_the_plane("gap", "theta"), out=out)
    return out


def test_corners_between_nodes_are_confirmed(run):
    assert all(pair["has_touched"] for pair in carom.Result.open(run).summary["pairs"])
    audit = carom.audit(run)
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["contact gaps"].figure < 1e-12
    assert checks["contact normals"].figure < 1e-8
    assert checks["nodal reactions"].figure < 1e-5  # of up to 2 kN
    assert checks["equation of motion"].figure < 1e-6


def test_corners_without_mass_at_nodes_are_confirmed(tmp_path):
    carom.run(in_the_plane("massless", "conserving"), out=tmp_path)
    assert carom.audit(tmp_path).refuted == ()


def test_corners_and_edges_of_a_beam_in_space_are_confirmed(tmp_path):
    beam = {"kind": "box", "name": "beam", "corner": [-0.5, 0.13, 0.0], "size": [0.73, 0.12, 0.3]}
    mesh = {"kind": "box", "corner": [0, 0, 0.31], "size": [0.6, 0.4, 0.3], "divisions": [3, 2, 2]}
    case = dropped(3, [beam], mesh, method=("midpoint", "conserving"), end_time=0.024)
    carom.run(case, out=tmp_path)
    audit = carom.audit(tmp_path)
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["contact gaps"].count >= 3
    assert checks["contact gaps"].figure < 1e-12


def test_another_wedge_is_refuted(run, tmp_path):
    found = refuted_after(run, tmp_path, in_case("0.65, 0.25", "0.6500001, 0.25"))
    assert {"contact gaps", "contact normals"} & found
    assert "nodal reactions" in found


def test_a_changed_reaction_at_a_corner_is_refuted(run, tmp_path):
    tamper = in_h5("audit.h5:steps/000011/end/contact_reaction", lambda value: 1.001 * value)
    assert {"nodal reactions", "normal force"} <= refuted_after(run, tmp_path, tamper)
