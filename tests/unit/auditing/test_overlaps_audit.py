"""Overlaps that are taken up in space are audited: at nodes, edges, corners, before the round."""

import numpy as np
import pytest
from refuting import confirmed, refuted_after

import carom
from tampered import in_case, in_h5

RUBBER = {"kind": "saint-venant-kirchhoff", "young": 1e4, "poisson": 0.3, "density": 1.0}


def box(corner, size, *divisions):
    return {"kind": "box", "corner": corner, "size": size, "divisions": divisions or [1, 1, 1]}


def overlapping(meshes, held, obstacles=(), **contact):
    """Bodies that are held away from where they overlap one another, or obstacles."""
    return carom.Scenario.from_dict(
        {
            "dimension": 3,
            "analysis": {"kind": "static", "end_time": 1.0, "time_step": 0.25},
            "materials": {"m": RUBBER},
            "bodies": [
                {"name": name, "material": "m", "mesh": mesh}
                for name, mesh in zip("ab", meshes, strict=False)
            ],
            "motions": [
                {"kind": "fixed", "body": name, "on": on}
                for name, on in zip("ab", held, strict=False)
            ],
            "obstacles": list(obstacles),
            "contact": {
                "friction": 0.1,
                "resolve_overlap": True,
                "overlap_resolved_at": 0.6,
                "penetration_tolerance": 0.5,
                **contact,
            },
            "output": {"audit": True, "fields_every": 0.25, "history_every": 0.25},
        }
    )


CUBE = box([0, 0, 0], [1, 1, 1])
OBSTACLES = {
    "tilted plane": {"kind": "plane", "point": [0, 0, 0.02], "normal": [0, 0.1, 1]},
    "ball before a facet": {"kind": "sphere", "centre": [0.3, 0.4, -0.28], "radius": 0.3},
    "cylinder before edges": {
        "kind": "cylinder",
        "axis": [1, 0.2, 0],
        "point": [0.3, 0.4, -0.28],
        "radius": 0.3,
    },
    "corners and edges of a box": {
        "kind": "box",
        "corner": [0.3, 0.2, -0.5],
        "size": [0.4, 0.9, 0.51],
    },
}


def run_confirmed(case, directory):
    result = carom.run(case, out=directory)
    assert result.history["normal_force"].max() > 10.0
    checks = confirmed(directory)
    assert checks["contact gaps"].figure < 1e-9
    return checks


@pytest.mark.parametrize("what", OBSTACLES)
def test_a_block_in_an_obstacle_is_confirmed(tmp_path, what):
    obstacle = {"name": "floor", **OBSTACLES[what]}
    run_confirmed(overlapping([CUBE], ["top"], [obstacle]), tmp_path)


def test_flat_sides_with_edges_across_one_another_are_confirmed(tmp_path):
    bars = [box([-1, -0.1, 0], [2, 0.2, 0.3]), box([-0.1, -1, 0.29], [0.2, 2, 0.3])]
    run_confirmed(overlapping(bars, ["bottom", "top"]), tmp_path)
    # What presses in one load step has a part in the next, and gives no impulse.
    summary = carom.Result.open(tmp_path).summary
    assert [event["impact"] for event in summary["contacts"]] == [None, None]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A block whose corner is in the side of another."""
    out = tmp_path_factory.mktemp("boxes")
    boxes = [box([0, 0, 0], [1, 1, 1], 2, 2, 2), box([0.2, 0.3, 0.98], [0.7, 0.7, 0.5])]
    run_confirmed(overlapping(boxes, ["bottom", "top"]), out)
    return out


def test_another_time_to_take_overlaps_up_is_found(run, tmp_path):
    refuted = refuted_after(run, tmp_path, in_case("= 0.6", "= 0.6001"))
    assert {"contact gaps", "Signorini: complementarity"} <= refuted


def test_work_of_overlaps_that_was_changed_is_found(run, tmp_path):
    tamper = in_h5("audit.h5:steps/000001/ledger@prescribed", lambda work: 1.0001 * work)
    assert "ledger: prescribed" in refuted_after(run, tmp_path, tamper)


def test_a_shaft_in_a_hub_is_confirmed(tmp_path):
    """With nodes of the hub before the smooth shaft, and edges along and around both."""
    shaft = {"kind": "cylinder", "base": [0, 0, -0.2], "axis": [0, 0, 1], "radius": 1.005}
    hub = {"kind": "tube", "base": [0, 0, 0], "axis": [0, 0, 1], "inner_radius": 1.0}
    shaft |= {"height": 0.9, "layers": 3, "divisions": 2, "rings": 1}
    hub |= {"outer_radius": 1.6, "height": 0.5, "divisions": [16, 1, 2]}
    case = overlapping([shaft, hub], ["", "outer"], sources="second")
    case = case.model_dump(mode="json", exclude_none=True)
    del case["motions"][0]
    case["output"] |= {"fields_every": 0.5, "history_every": 0.5}
    checks = run_confirmed(carom.Scenario.from_dict(case), tmp_path)
    assert checks["contact normals"].count > 50
    assert np.isfinite(checks["contact normals"].figure)
