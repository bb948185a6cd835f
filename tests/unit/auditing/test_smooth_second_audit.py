"""Smooth targets over facets of second order in space are audited."""

import numpy as np
import pytest
from refuting import confirmed, refuted_after
from test_audited_sheet import cube_sphere

import carom
from carom.auditing.targets.gregory import GregoryPatches
from carom.auditing.targets.sheet import Sheet
from tampered import in_case, in_h5

ROUND = {
    "tet10": {"kind": "ball", "centre": [0, 0, 1], "radius": 1, "divisions": 1, "rings": 1},
    "hex27": {"kind": "ball", "centre": [0, 0, 1], "radius": 1, "divisions": 1, "rings": 1},
    "wedge15": {
        "kind": "cylinder",
        "base": [0, -0.5, 1],
        "axis": [0, 1, 0],
        "radius": 1,
        "height": 1,
        "divisions": 2,
        "rings": 1,
        "layers": 1,
    },
}


def dropped(cell, method=("gap", "theta")):
    """A round body of cells of second order that falls on the nodes of a block, off its middle."""
    condition, scheme = method
    block = {"kind": "box", "corner": [-0.1, -0.2, -0.4], "size": [0.5, 0.3, 0.39]}
    return carom.Scenario.from_dict(
        {
            "dimension": 3,
            "analysis": {"end_time": 0.02, "time_step": 5e-3, "scheme": {"kind": scheme}},
            "materials": {
                "m": {"kind": "neo-hookean", "young": 3e3, "poisson": 0.3, "density": 1.0}
            },
            "bodies": [
                {
                    "name": "round",
                    "material": "m",
                    "mesh": {**ROUND[cell], "cell": cell},
                    "velocity": [0.3, 0.1, -3.0],
                },
                {"name": "block", "material": "m", "mesh": {**block, "divisions": [1, 1, 1]}},
            ],
            "contact": {
                "condition": condition,
                "friction": 0.3,
                "targets": "smooth",
                "penetration_tolerance": 0.5,
                "pairs": [{"between": ["round", "block"], "sources": "second"}],
            },
            "output": {"audit": True, "history_every": 5e-3, "fields_every": 0.02},
        }
    )


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("ball")
    run_confirmed("tet10", out)
    return out


def run_confirmed(cell, directory, *method):
    carom.run(dropped(cell, *method), out=directory)
    checks = confirmed(directory)
    assert checks["contact gaps"].count >= 1
    assert checks["contact gaps"].figure < 1e-11
    assert checks["contact normals"].figure < 1e-9
    assert checks["nodal reactions"].figure < 1e-8
    return checks


@pytest.mark.parametrize(
    ("cell", "method"),
    [("hex27", ("massless", "conserving")), ("wedge15", ("gap", "theta"))],
)
def test_smooth_targets_over_facets_of_second_order_are_confirmed(tmp_path, cell, method):
    run_confirmed(cell, tmp_path, method)


def test_another_surface_or_radius_is_found(run, tmp_path):
    other = in_case('targets = "smooth"', 'targets = "faceted"')
    assert {"contact gaps", "nodal reactions"} <= refuted_after(run, tmp_path / "a", other)


def test_a_changed_normal_or_force_on_a_tile_is_found(run, tmp_path):
    def tamper(directory):
        in_h5("audit.h5:steps/000000/end/contact_normal", lambda n: n - 1e-6)(directory)
        in_h5("audit.h5:steps/000000/end/contact_force", lambda f: 1.0001 * f)(directory)

    assert {"contact normals", "nodal reactions"} <= refuted_after(run, tmp_path, tamper)


def test_a_sphere_of_second_order_facets_is_round_to_fourth_order():
    """Facets of eight and nine nodes, of which the tiles have the same corners."""
    rng = np.random.default_rng(3)
    x = rng.normal(size=(5, 3))
    x *= 1.05 / np.linalg.norm(x, axis=1, keepdims=True)
    for middles in (False, True):
        errors = []
        for n in (1, 2):
            facets, points = second_order_sphere(n, middles=middles)
            found = Sheet(GregoryPatches(facets, points)).signed_distance(x, points)
            errors.append(np.abs(found - 0.05).max())
        assert errors[1] < errors[0] / 8.0


def second_order_sphere(n, *, middles):
    """Facets with a node between all corners and, if wanted, one in the middle."""
    quads, points = cube_sphere(n)
    numbers, places, facets = {}, list(points), []

    def node(*corners):
        key = frozenset(corners)
        if key not in numbers:
            mean = points[list(key)].mean(axis=0)
            places.append(mean / np.linalg.norm(mean))
            numbers[key] = len(places) - 1
        return numbers[key]

    for quad in quads.tolist():
        around = [node(a, b) for a, b in zip(quad, [*quad[1:], quad[0]], strict=True)]
        facets.append([*quad, *around, *([node(*quad)] if middles else [])])
    return np.array(facets), np.array(places)
