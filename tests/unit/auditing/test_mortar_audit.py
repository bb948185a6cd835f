"""Mortar contact is audited: rows are integrated again, by code of the auditor's own."""

import numpy as np
import pytest
from refuting import confirmed, refuted_after

import carom
from carom.auditing.targets.covering import Covering
from carom.auditing.targets.curve import Curve
from carom.auditing.targets.mortar import Rows
from carom.auditing.targets.sheet import FlatPatches, Sheet
from grazing_discs import discs
from tampered import in_case, in_h5

END = "audit.h5:steps/000001/end"
SOFT = {"kind": "neo-hookean", "young": 1e4, "poisson": 0.3, "density": 10.0}
FLAT = {"kind": "rectangle", "corner": [0, 0], "size": [1, 0.5], "divisions": [3, 2]}
BLOCK = {"kind": "rectangle", "corner": [0.13, 0.501], "size": [0.6, 0.4], "divisions": [4, 2]}
DISC = {"kind": "disc", "centre": [0, 0], "radius": 1, "divisions": 4}
OTHER = {"kind": "disc", "centre": [0.1, 1.5], "radius": 0.5, "divisions": 4}
BOX = {"kind": "box", "corner": [0, 0, 0], "size": [1, 1, 0.5], "divisions": [2, 2, 1]}
CUBE = {"kind": "box", "corner": [0.13, 0.2, 0.501], "size": [0.6, 0.5, 0.4]}
CUBE |= {"divisions": [2, 1, 1]}
ROLLERS = [
    {"kind": "cylinder", "base": [0, -0.5, -1], "axis": [0, 1, 0], "radius": 1}
    | {"height": 1, "divisions": 2, "rings": 1, "layers": 1},
    {"kind": "cylinder", "base": [0.1, -0.4, 0.5], "axis": [0, 1, 0], "radius": 0.5}
    | {"height": 0.6, "divisions": 2, "rings": 1, "layers": 1},
]


def dropped(meshes=(FLAT, BLOCK), method=("gap", "theta"), **changes):
    """A body that falls obliquely on another, in eight steps."""
    condition, scheme = method
    dimension = 3 if meshes[0]["kind"] in ("box", "cylinder") else 2
    velocity = [0.5, *[0.0] * (dimension - 2), -1.0]
    case = {
        "dimension": dimension,
        "analysis": {"end_time": 8e-3, "time_step": 1e-3, "scheme": {"kind": scheme}},
        "materials": {"m": SOFT},
        "bodies": [
            {"name": "a", "material": "m", "mesh": meshes[0]},
            {"name": "b", "material": "m", "mesh": meshes[1], "velocity": velocity},
        ],
        "contact": {"condition": condition, "friction": 0.3, "discretisation": "mortar"},
        "output": {"audit": True, "history_every": 1e-3, "fields_every": 1e-3},
    }
    case["contact"]["penetration_tolerance"] = 0.5
    return {**case, **changes}


def pressed(**changes):
    """A block that is pressed on another and pulled along it in load steps."""
    top = {"kind": "prescribed", "body": "b", "on": "top", "x": "0.01*t", "y": "-0.02*t"}
    case = dropped(analysis={"kind": "static", "end_time": 1.0, "time_step": 0.5})
    del case["bodies"][1]["velocity"]
    case["motions"] = [{"kind": "fixed", "body": "a", "on": "bottom"}, top]
    case["output"] |= {"history_every": 0.5, "fields_every": 0.5}
    return {**case, **changes}


def run_confirmed(case, directory):
    carom.run(carom.Scenario.from_dict(case), out=directory)
    checks = confirmed(directory)
    assert checks["contact gaps"].count > 1
    assert checks["contact gaps"].figure < 1e-10
    assert checks["contact normals"].figure < 1e-9
    return checks


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("dropped")
    run_confirmed(dropped(), out)
    return out


def with_cells(cells, meshes):
    return [mesh | {"cell": cell} for mesh, cell in zip(meshes, cells, strict=True)]


@pytest.mark.parametrize("method", [("midpoint", "conserving"), ("endpoint", "theta")])
def test_smooth_sides_of_the_plane_are_confirmed(tmp_path, method):
    case = dropped((DISC, OTHER), method)
    case["bodies"][1]["velocity"] = [0.5, -10.0]
    run_confirmed(case, tmp_path)


@pytest.mark.parametrize(
    ("meshes", "cells"),
    [((FLAT, BLOCK), ("quad8", "quad9")), ((BOX, CUBE), ("hex8", "tet4"))],
)
def test_all_kinds_of_facets_are_confirmed(tmp_path, meshes, cells):
    run_confirmed(dropped(with_cells(cells, meshes)), tmp_path)


def test_facets_of_second_order_in_space_are_confirmed(tmp_path):
    analysis = {"end_time": 3e-3, "time_step": 1e-3, "scheme": {"kind": "theta"}}
    case = dropped(with_cells(("hex20", "tet10"), (BOX, CUBE)), analysis=analysis)
    run_confirmed(case, tmp_path)


def test_smooth_sides_in_space_are_confirmed(tmp_path):
    """Rollers, whose facets are so wide that they have to come far before means are closed."""
    analysis = {"end_time": 8e-3, "time_step": 4e-3, "scheme": {"kind": "theta"}}
    case = dropped(ROLLERS, analysis=analysis)
    case["bodies"][1]["velocity"] = [0.5, 0.0, -20.0]
    case["output"] |= {"history_every": 4e-3, "fields_every": 4e-3}
    run_confirmed(case, tmp_path)


def test_facets_that_turn_past_one_another_are_confirmed(tmp_path):
    """Facets crossed the angle from which they face one another: the audit found gaps open."""
    case = discs(70, discretisation="mortar")
    case = case.with_overrides(["output.audit = true", "output.fields_every = 1e-3"])
    carom.run(case, out=tmp_path)
    assert confirmed(tmp_path)["contact gaps"].figure < 1e-13


def test_bodies_of_revolution_are_confirmed(tmp_path):
    case = dropped(method=("midpoint", "conserving"))
    for body in case["bodies"]:
        body["hypothesis"] = "axisymmetric"
    case["bodies"][1]["velocity"] = [0.0, -1.0]
    run_confirmed(case, tmp_path)


def test_load_steps_are_confirmed(tmp_path):
    run_confirmed(pressed(), tmp_path)


def test_pairs_of_either_kind_and_friction_by_pressure_are_confirmed(tmp_path):
    """A block between two others: node by node on one, with multipliers on the other."""
    case = dropped(method=("midpoint", "conserving"))
    lid = {"kind": "rectangle", "corner": [0.2, 0.902], "size": [0.5, 0.2], "divisions": [2, 1]}
    case["bodies"].append({"name": "c", "material": "m", "mesh": lid, "velocity": [0.0, -2.0]})
    case["contact"] |= {
        "friction": {"formula": "min(0.4, 0.1 + p/1e4)"},
        "pairs": [{"between": ["b", "c"], "discretisation": "node-to-segment"}],
    }
    run_confirmed(case, tmp_path)


def test_another_discretisation_source_or_target_is_found(run, tmp_path):
    for number, (old, new) in enumerate(
        [
            ('discretisation = "mortar"', 'discretisation = "node-to-segment"'),
            ('discretisation = "mortar"', 'discretisation = "mortar"\nsources = "first"'),
        ]
    ):
        refuted = refuted_after(run, tmp_path / str(number), in_case(old, new))
        assert refuted & {"contact gaps", "nodal reactions", "pairs"}


def test_a_changed_gap_normal_or_force_is_found(run, tmp_path):
    for number, (name, change, check) in enumerate(
        [
            ("contact_gap", lambda gap: gap + 1e-8, "contact gaps"),
            ("contact_normal", lambda normal: normal - 1e-6, "contact normals"),
            ("contact_force", lambda force: 1.0001 * force, "nodal reactions"),
            ("contact_reaction", lambda force: 1.0001 * force, "nodal reactions"),
        ]
    ):
        tamper = in_h5(f"{END}/{name}", change)
        assert check in refuted_after(run, tmp_path / str(number), tamper)


def sides(dimension):
    """Two meshes of the same square or segment that do not match, one beside the other's rim."""
    if dimension == 2:
        points = [np.array([[x, 0.0] for x in xs]) for xs in ([0.0, 0.3, 1.0], [1.2, 0.55, 0.1])]
        facets = [np.array([[1, 0], [2, 1]]), np.array([[1, 0], [2, 1]])]
        targets = [Curve(f, p, smooth=False) for f, p in zip(facets, points, strict=True)]
    else:
        square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
        points = [square, square + np.array([0.2, 0.1, 0.0])]
        facets = [np.array([[0, 1, 2], [0, 2, 3]]), np.array([[3, 2, 1, 0]])]
        targets = [Sheet(FlatPatches(f)) for f in facets]
    coverings = [
        Covering(f, p, t, revolution=False) for f, p, t in zip(facets, points, targets, strict=True)
    ]
    return coverings, points


@pytest.mark.parametrize(("dimension", "covered"), [(2, 0.9), (3, 0.8 * 0.9)])
def test_rows_cover_what_both_sides_have_in_common(dimension, covered):
    """Multipliers are 1 together, and places of both sides are those of their common middle."""
    (source, target), positions = sides(dimension)
    rows = list(Rows(source, target, tuple(positions)).of.values())
    assert sum(row.area for row in rows) == pytest.approx(covered, abs=1e-14)
    middles = [
        sum(share * position[node] for row in rows for node, share in shares(row).items())
        for position, shares in zip(
            positions, (lambda row: row.sources, lambda row: row.targets), strict=True
        )
    ]
    assert middles[0] == pytest.approx(middles[1], abs=1e-14)
    for row in rows:
        assert sum(row.sources.values()) == pytest.approx(row.area, abs=1e-14)
        assert sum(row.targets.values()) == pytest.approx(row.area, abs=1e-14)
