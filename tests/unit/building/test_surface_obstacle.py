"""A closed surface from an STL file as a rigid obstacle."""

import numpy as np
import pytest

import carom
from carom.building.build import build

CORNERS = [[x, y, z] for z in (0, 1000) for y in (0, 1000) for x in (0, 1000)]
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
TRIANGLES = [t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))]


@pytest.fixture
def case(tmp_path):
    """A block that falls on a cube of 1 m, given in millimetres by these triangles."""

    def make(triangles):
        facets = "".join(
            "facet normal 0 0 0\nouter loop\n"
            + "".join(f"vertex {' '.join(map(str, CORNERS[n]))}\n" for n in triangle)
            + "endloop\nendfacet\n"
            for triangle in triangles
        )
        (tmp_path / "cube.stl").write_text(f"solid cube\n{facets}endsolid cube\n")
        block = {
            "name": "block",
            "material": "m",
            "mesh": {
                "kind": "box",
                "corner": [0.3, 0.3, 1.005],
                "size": [0.3, 0.3, 0.3],
                "divisions": [1, 1, 1],
            },
            "velocity": [0.0, 0.0, -1.0],
        }
        cube = {
            "name": "cube",
            "kind": "surface",
            "file": str(tmp_path / "cube.stl"),
            "scale": 1e-3,
        }
        return carom.Scenario.from_dict(
            {
                "dimension": 3,
                "analysis": {"end_time": 0.05, "time_step": 1e-3},
                "materials": {
                    "m": {
                        "kind": "saint-venant-kirchhoff",
                        "young": 2700.0,
                        "poisson": 0.33,
                        "density": 1.0,
                    }
                },
                "bodies": [block],
                "obstacles": [cube],
            }
        )

    return make


def test_a_block_lands_on_the_cube_of_a_file(case):
    simulation = build(case(TRIANGLES))
    while not simulation.advance(1.0, 1.0):
        pass
    simulation.finish()
    summary = simulation.summary()
    (contact,) = summary["contacts"]
    assert contact["pair"] == ["block", "cube"]
    assert contact["onset"] == pytest.approx(0.005, abs=1.5e-3)
    assert -2e-3 < summary["min_gap"] < 0.0  # two steps at 1 m/s


def test_the_core_knows_how_far_points_are_from_the_cube_of_a_file(case):
    simulation = build(case(TRIANGLES))
    points = np.array([[0.4, 0.3, 1.5], [0.2, 0.5, 0.6], [1.3, 1.4, 0.5]])
    gaps, normals = simulation.obstacle_gaps(0, points)
    assert gaps == pytest.approx([0.5, -0.2, 0.5])
    assert normals == pytest.approx(np.array([[0, 0, 1], [-1, 0, 0], [0.6, 0.8, 0]]))
    with pytest.raises(IndexError, match=r"^1$"):
        simulation.obstacle_gaps(1, points)


def test_triangles_that_do_not_close_are_refused(case):
    with pytest.raises(carom.InputError, match=r"obstacles\.0.* 3 edges"):
        build(case(TRIANGLES[1:]))


def test_a_surface_is_no_obstacle_of_the_plane(case):
    data = case(TRIANGLES).model_dump(mode="json")
    flat = {
        "dimension": 2,
        "bodies": [
            {
                "name": "disc",
                "material": "m",
                "mesh": {"kind": "disc", "centre": [0, 9], "radius": 1, "divisions": 4},
            }
        ],
    }
    with pytest.raises(carom.InputError, match=r"obstacles\.0\.kind.* in 3D"):
        build(carom.Scenario.from_dict({**data, **flat}))
