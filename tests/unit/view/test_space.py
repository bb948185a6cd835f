"""Bodies in space, with light and shadows."""

import sys

import matplotlib
import matplotlib.image
import numpy as np
import pytest
from typer.testing import CliRunner

import carom
from carom.cli import app
from carom.view.space import creases
from falling import block


def picture(*arguments):
    pytest.importorskip("pyvista")
    return CliRunner().invoke(app, ["picture", *map(str, arguments)])


def pixels(file):
    return matplotlib.image.imread(file)[:, :, :3]


@pytest.mark.parametrize(
    "options",
    [(), ("--field", "velocity", "--time", "0"), ("--field", "slip"), ("--smooth", "--reactions")],
)
def test_a_picture_shows_the_body(ball, tmp_path, options):
    file = tmp_path / "ball.png"
    answer = picture(ball, "--out", file, "--colours", "viridis", *options)
    assert answer.exit_code == 0, answer.output
    image = pixels(file)
    centre = image[image.shape[0] // 3 : image.shape[0] // 2]
    coloured = np.ptp(centre, axis=2) > 0.1
    assert coloured.sum() > 0.2 * coloured.size


@pytest.mark.parametrize("size", [0.2, 2e-3])
def test_bodies_fill_the_picture_and_not_the_obstacles(tmp_path, size):
    """Symptom guarded against: beside a ball of 1 m, which does not move, the block was a stamp."""
    carom.run(carom.Scenario.from_dict(block(3, size)), out=tmp_path / "run")
    options = ("--colours", "viridis", "--field", "velocity")
    assert picture(tmp_path / "run", "--out", tmp_path / "a.png", *options).exit_code == 0
    image = pixels(tmp_path / "a.png")
    above = image[: round(0.78 * len(image))]  # the colours stand below
    rows, columns = np.nonzero(np.ptp(above, axis=2) > 0.15)
    assert len(rows) > 0.35 * above.shape[0] * above.shape[1]
    assert columns.min() > 0
    assert columns.max() < image.shape[1] - 1


def test_the_side_that_faces_the_camera_has_the_colour_of_the_bar(tmp_path):
    """Symptom guarded against: parts in space were dim, and no colour of the bar was on them."""
    still = block(3)
    still["bodies"][0]["velocity"] = [0.0, 0.0, 0.0]
    carom.run(carom.Scenario.from_dict(still), out=tmp_path / "run")
    options = ("--out", tmp_path / "a.png", "--field", "displacement", "--colours", "viridis")
    assert picture(tmp_path / "run", *options).exit_code == 0
    image = pixels(tmp_path / "a.png")
    above = image[: round(0.78 * len(image))]
    body = above[np.ptp(above, axis=2) > 0.1]
    least = np.array(matplotlib.colormaps["viridis"](0.0)[:3])
    assert np.percentile(body.sum(axis=1), 90) > 0.8 * least.sum()


def test_instants_differ(ball, tmp_path):
    """Symptom guarded against: all instants of a strip showed the first."""
    assert picture(ball, "--out", tmp_path / "a.png", "--time", "0,0.004").exit_code == 0
    image = pixels(tmp_path / "a.png")
    half = image.shape[1] // 2
    top = slice(round(0.1 * len(image)), round(0.8 * len(image)))
    left, right = image[top, : half - 20], image[top, half + 20 :]
    width = min(left.shape[1], right.shape[1])
    assert np.abs(left[:, -width:] - right[:, -width:]).max() > 0.1


def test_edges_of_a_cube_are_those_of_its_shape():
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    squares = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in squares for t in ((a, b, c), (a, c, d))])
    found = creases(triangles, corners)
    lengths = np.linalg.norm(corners[found[:, 0]] - corners[found[:, 1]], axis=1)
    np.testing.assert_allclose(np.sort(lengths), np.ones(12))


def test_an_open_surface_ends_in_edges():
    found = creases(np.array([[0, 1, 2]]), np.eye(3))
    assert len(found) == 3


def test_a_missing_pyvista_says_how_to_get_it(ball, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    answer = CliRunner().invoke(app, ["picture", str(ball), "--out", str(tmp_path / "x.png")])
    assert answer.exit_code == 2
    assert 'pip install "carom[view]"' in answer.output


def test_every_obstacle_is_drawn(tmp_path):
    pytest.importorskip("pyvista")
    case = block(3)
    more = [
        {"name": "bore", "kind": "cylinder", "point": [0, 0, 0], "axis": [0, 0, 1], "radius": 0.4}
        | {"cavity": True},
        {"name": "box", "kind": "box", "corner": [0.2, -0.1, 0], "size": [0.1, 0.1, 0.1]},
        {"name": "wall", "kind": "plane", "point": [-0.3, 0, 0], "normal": [1, 0, 0]},
        {"name": "turned", "kind": "plane", "point": [0, 0.4, 0], "normal": [0, -1, 0.3]},
    ]
    case["obstacles"] += more
    carom.run(carom.Scenario.from_dict(case), out=tmp_path / "run")
    for azimuth in (-58, 122):
        file = tmp_path / f"{azimuth}.png"
        answer = picture(tmp_path / "run", "--out", file, "--camera", azimuth, 20)
        assert answer.exit_code == 0, answer.output
    one, other = (pixels(tmp_path / f"{azimuth}.png") for azimuth in (-58, 122))
    assert one.shape != other.shape or np.abs(one - other).max() > 0.1
