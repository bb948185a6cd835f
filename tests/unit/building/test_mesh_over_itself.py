"""A mesh that lies over itself is refused before anything moves."""

import re

import meshio
import numpy as np
import pytest

import carom

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
QUADS = np.array([[0, 1, 2, 3], [4, 5, 6, 7]])


def two_squares(directory, offset):
    """A body of two squares, the second this much [m] to the right of the first."""
    file = directory / "part.msh"
    points = np.pad(np.vstack([SQUARE, SQUARE + np.array([offset, 0.0])]), ((0, 0), (0, 1)))
    meshio.write(file, meshio.Mesh(points, [("quad", QUADS)]), file_format="gmsh22", binary=False)
    return carom.Scenario.from_dict(
        {
            "dimension": 2,
            "analysis": {"end_time": 2e-3, "time_step": 1e-3},
            "materials": {
                "m": {"kind": "linear-elastic", "young": 1e4, "poisson": 0.3, "density": 1.0}
            },
            "bodies": [
                {"name": "part", "material": "m", "mesh": {"kind": "file", "file": str(file)}}
            ],
        }
    )


@pytest.mark.parametrize("offset", [0.3, 0.8, 0.95])
def test_cells_of_a_body_that_lie_over_others_are_named(tmp_path, offset):
    """Symptom guarded against: its first step told that it was inside itself, and to mesh finer."""
    message = 'bodies.0.mesh: the mesh of "part" lies over itself: near ('
    with pytest.raises(carom.InputError, match=re.escape(message)) as caught:
        carom.run(two_squares(tmp_path, offset), out=tmp_path / "out")
    # The way out is the shorter one, to the left or to the right.
    assert f"it is {min(offset, 1.0 - offset):.0e}"[:7] in str(caught.value)
    assert not (tmp_path / "out").exists()


@pytest.mark.filterwarnings("ignore:.*pieces that share no node:carom.CaromWarning")
def test_parts_that_lie_flush_or_apart_are_no_matter(tmp_path):
    for offset in (1.0, 1.5):
        result = carom.run(two_squares(tmp_path, offset), out=tmp_path / "out", force=True)
        assert result.summary["status"] == "completed"
