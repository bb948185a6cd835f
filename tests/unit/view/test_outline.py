"""What is drawn of a mesh has the area and the rim that the mesh has."""

import numpy as np
import pytest

import carom
from carom.io.frames import Frames
from carom.view.outline import outline

MATERIAL = {"kind": "linear-elastic", "young": 1e6, "poisson": 0.3, "density": 1e3}


def run(tmp_path, mesh, **more):
    dimension = len(mesh["size"])
    case = {
        "dimension": dimension,
        "analysis": {"end_time": 1e-3, "time_step": 1e-3, "scheme": {"kind": "theta"}},
        "materials": {"m": MATERIAL},
        "bodies": [{"name": "b", "material": "m", "mesh": mesh, **more}],
    }
    result = carom.run(carom.Scenario.from_dict(case), out=tmp_path / "run")
    frames, surface = Frames(result.fields_path), Frames(result.surface_path)
    return frames, surface, outline(frames, surface)


def area(frames, drawn):
    a, b, c = np.moveaxis(frames.points[drawn.points][drawn.triangles], 1, 0)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


@pytest.mark.parametrize("cell", ["tri3", "quad4", "tri6", "quad8", "quad9"])
def test_cells_of_the_plane_fill_it(tmp_path, cell):
    mesh = {"kind": "rectangle", "corner": [0, 0], "size": [3, 2], "divisions": [3, 4]}
    frames, _, drawn = run(tmp_path, {**mesh, "cell": cell})
    assert drawn.dimension == 2
    assert area(frames, drawn) == pytest.approx(6.0)
    ends = frames.points[drawn.points][drawn.rim]
    assert np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).sum() == pytest.approx(10.0)
    assert sorted(drawn.cell) == list(range(len(frames.types)))
    assert (drawn.facets >= 0).all()


@pytest.mark.parametrize("cell", ["tet4", "hex8", "tet10", "hex20", "hex27", "wedge6", "wedge15"])
def test_the_boundary_of_a_body_in_space_is_closed(tmp_path, cell):
    mesh = {"kind": "box", "corner": [0, 0, 0], "size": [1, 2, 3], "divisions": [2, 2, 3]}
    frames, surface, drawn = run(tmp_path, {**mesh, "cell": cell})
    assert drawn.dimension == 3
    assert area(frames, drawn) == pytest.approx(22.0)
    assert sorted(drawn.facets) == list(range(len(surface.types)))
    # A closed surface has every edge twice: Euler's 3 F = 2 E of its triangles.
    pairs = np.sort(drawn.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    assert (np.unique(pairs, axis=0, return_counts=True)[1] == 2).all()
