"""`carom view` draws what a run left, without a display."""

import itertools
import re
from pathlib import Path

import numpy as np
import pytest
import tomlkit
from typer.testing import CliRunner

import carom
from carom.cli import app
from carom.io.frames import Frames
from carom.view import shown

pytest.importorskip("pyvista")

BALL = {
    "title": "ball",
    "dimension": 3,
    "analysis": {"end_time": 4e-3, "time_step": 1e-3, "scheme": {"kind": "theta"}},
    "materials": {"rubber": {"kind": "neo-hookean", "young": 1e4, "poisson": 0.3, "density": 1.0}},
    "bodies": [
        {
            "name": "ball",
            "material": "rubber",
            "mesh": {
                "kind": "ball",
                "centre": [0, 0, 1.001],
                "radius": 1,
                "divisions": 2,
                "cell": "hex20",
            },
            "velocity": [0, 0, -1.0],
        }
    ],
    "obstacles": [{"name": "floor", "kind": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],
    "output": {"fields_every": 2e-3},
}


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    directory = tmp_path_factory.mktemp("ball")
    carom.run(carom.Scenario.from_dict(BALL), out=directory)
    return directory


def view(*arguments):
    return CliRunner().invoke(app, ["view", *map(str, arguments)])


@pytest.mark.parametrize(
    "options", [(), ("--field", "velocity", "--time", "0"), ("--surface", "--field", "slip")]
)
def test_a_picture_shows_the_body(results, tmp_path, options):
    import matplotlib.image

    file = tmp_path / "ball.png"
    answer = view(results, "--screenshot", file, *options)
    assert answer.exit_code == 0, answer.output
    assert answer.output.strip() == str(file)
    pixels = matplotlib.image.imread(file)[:, :, :3]
    centre = pixels[pixels.shape[0] // 3 : 2 * pixels.shape[0] // 3]
    coloured = np.ptp(centre, axis=2) > 0.1
    assert coloured.sum() > 5000, "more than the axes"


def test_a_film_without_what_writes_it_says_what_to_install(results, tmp_path, monkeypatch):
    import pyvista

    def missing(*_, **__):
        raise ImportError("Install imageio to use this")

    monkeypatch.setattr(pyvista.Plotter, "open_gif", missing)
    answer = view(results, "--animation", tmp_path / "ball.gif")
    assert answer.exit_code == 2
    assert answer.output.endswith(
        'ball.gif: Install imageio to use this; pip install "carom[view]"\n'
    )


def test_a_film_has_a_picture_of_every_frame(results, tmp_path):
    pytest.importorskip("imageio")
    from PIL import Image, ImageSequence

    file = tmp_path / "ball.gif"
    answer = view(results, "--animation", file)
    assert answer.exit_code == 0, answer.output
    assert answer.output.strip() == str(file)
    with Image.open(file) as film:
        pictures = [np.asarray(p.convert("L"), float) for p in ImageSequence.Iterator(film)]
    assert len(pictures) == 3
    assert all(np.abs(a - b).max() > 20 for a, b in itertools.pairwise(pictures)), "it moves"


def test_the_extra_brings_what_films_are_written_with():
    """Symptom guarded against: --animation asked for imageio after pip install carom[view]."""
    project = Path(__file__).parents[3] / "pyproject.toml"
    extra = tomlkit.parse(project.read_text())["project"]["optional-dependencies"]["view"]
    assert {"imageio", "pyvista"} <= {re.split(r"[\[>=<]", line)[0] for line in extra}
    (imageio,) = [line for line in extra if line.startswith("imageio")]
    assert imageio.startswith("imageio[ffmpeg]")  # for .mp4


def block(dimension, size=0.2):
    """A small block above obstacles that are large, or far away."""
    low = [-size / 2] * dimension
    low[-1] = 0.01
    shape = "box" if dimension == 3 else "rectangle"
    down = [0.0] * (dimension - 1)
    return {
        **BALL,
        "dimension": dimension,
        "bodies": [
            {
                **BALL["bodies"][0],
                "mesh": {"kind": shape, "corner": low, "size": [size] * dimension}
                | {"divisions": [2] * dimension},
                "velocity": [*down, -1.0],
            }
        ],
        "obstacles": [
            {"name": "globe", "kind": "sphere", "centre": [*down, -1.0], "radius": 1.0},
            {"name": "floor", "kind": "plane", "point": [*down, -9.0], "normal": [*down, 1.0]},
        ],
    }


@pytest.mark.parametrize(("dimension", "size"), [(3, 0.2), (3, 2e-3), (2, 0.2)])
def test_bodies_fill_the_picture_and_not_the_obstacles(tmp_path, dimension, size):
    """Symptom guarded against: beside a ball of 1 m, which does not move, the block was a stamp."""
    import matplotlib.image

    carom.run(carom.Scenario.from_dict(block(dimension, size)), out=tmp_path / "run")
    assert view(tmp_path / "run", "--screenshot", tmp_path / "a.png").exit_code == 0
    pixels = matplotlib.image.imread(tmp_path / "a.png")[:, :, :3]
    above = pixels[: round(0.82 * len(pixels))]  # the colours stand below
    rows, columns = np.nonzero(np.ptp(above, axis=2) > 0.15)
    assert len(rows) > 0.25 * above.shape[0] * above.shape[1]
    assert 0.02 * len(pixels) < rows.min() < 0.2 * len(pixels)
    assert columns.min() > 0
    assert columns.max() < pixels.shape[1] - 1


def test_a_polygon_is_drawn_where_it_has_moved(tmp_path):
    import matplotlib.image

    case = block(2)
    beside = {
        "name": "beside",
        "kind": "polygon",
        "points": [[0.14, 0.02], [0.2, 0.02], [0.17, 0.2]],
    }
    pictures = []
    for k, more in enumerate(([], [beside], [{**beside, "velocity": [0.0, 2.0]}])):
        made = {**case, "obstacles": [*case["obstacles"], *more]}
        carom.run(carom.Scenario.from_dict(made), out=tmp_path / f"run{k}")
        assert view(tmp_path / f"run{k}", "--screenshot", tmp_path / f"{k}.png").exit_code == 0
        pictures.append(matplotlib.image.imread(tmp_path / f"{k}.png"))
    without, still, moved = pictures
    assert np.abs(still - without).max() > 0.1
    assert np.abs(still - moved).max() > 0.1


def test_the_side_that_faces_the_camera_has_the_colour_of_the_bar(tmp_path):
    """Symptom guarded against: parts in space were dim, and no colour of the bar was on them."""
    import matplotlib.image

    still = block(3)
    still["bodies"][0]["velocity"] = [0.0, 0.0, 0.0]
    carom.run(carom.Scenario.from_dict(still), out=tmp_path / "run")
    options = ("--screenshot", tmp_path / "a.png", "--field", "displacement")
    assert view(tmp_path / "run", *options).exit_code == 0
    pixels = matplotlib.image.imread(tmp_path / "a.png")[:, :, :3]
    above = pixels[: round(0.82 * len(pixels))]
    body = above[np.ptp(above, axis=2) > 0.1]
    least = np.array(matplotlib.colormaps["viridis"](0.0)[:3])
    assert np.percentile(body.sum(axis=1), 90) > 0.8 * least.sum()


@pytest.mark.parametrize("option", ["--screenshot", "--animation"])
def test_a_picture_that_is_there_is_replaced_with_force_only(results, tmp_path, option):
    file = tmp_path / ("ball.gif" if option == "--animation" else "ball.png")
    file.write_text("mine")
    answer = view(results, option, file, "--time", "0")
    assert answer.exit_code == 2
    assert answer.output == f"error: {file}: is there already; give --force to replace it\n"
    assert file.read_text() == "mine"
    if option == "--screenshot":
        assert view(results, option, file, "--force").exit_code == 0
        assert file.read_bytes().startswith(b"\x89PNG")


def test_frames_are_read_back(results):
    frames = Frames(results / "fields.vtkhdf")
    np.testing.assert_allclose(frames.times, [0, 2e-3, 4e-3])
    assert frames.nearest(1.9e-3) == 1
    assert frames.nearest(None) == 2
    assert set(frames.types) == {25}
    fall = frames.field("displacement", 2)[:, 2]
    assert fall.mean() == pytest.approx(-4e-3, rel=0.1)
    speed = shown(frames, "velocity").values(frames, 0)
    np.testing.assert_allclose(speed, 1.0)


def test_equivalent_stress_of_pure_tension_is_the_tension(results, monkeypatch):
    frames = Frames(results / "fields.vtkhdf")
    tension = np.array([[7.0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 7.0 / np.sqrt(3)]])
    monkeypatch.setattr(frames, "field", lambda name, frame: tension)
    np.testing.assert_allclose(shown(frames, "von-mises").values(frames, 0), 7.0)
    np.testing.assert_allclose(shown(frames, "hydrostatic-pressure").values(frames, 0), [-7 / 3, 0])


def test_pictures_and_pages_have_one_word_for_a_field(results):
    frames = Frames(results / "fields.vtkhdf")
    assert shown(frames, None).title == "von Mises stress [Pa]"
    assert shown(frames, "velocity").title == "speed [m/s]"
    assert shown(frames, "strain").title == "equivalent strain"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--field", "velocty"), '--field velocty: no such field; did you mean "velocity"? (known'),
        (("--screenshot", "ball.pdf"), "--screenshot ball.pdf: must end in .png"),
        (("--animation", "ball.avi"), "--animation ball.avi: must end in .gif or .mp4"),
    ],
)
def test_bad_input_is_named(results, options, message):
    answer = view(results, *options)
    assert answer.exit_code == 2
    assert message in answer.output


def test_without_a_display_a_file_is_asked_for(results, monkeypatch):
    monkeypatch.setattr("carom.view.scene._is_headless", lambda: True)
    answer = view(results)
    assert answer.exit_code == 2
    assert "there is no display; give --screenshot FILE" in answer.output


def test_a_directory_without_results_is_refused(tmp_path):
    answer = view(tmp_path, "--screenshot", "x.png")
    assert answer.exit_code == 2
    assert "fields.vtkhdf: no such file" in answer.output


def test_a_missing_pyvista_says_how_to_get_it(results, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "pyvista", None)
    answer = view(results, "--screenshot", "x.png")
    assert answer.exit_code == 2
    assert 'pip install "carom[view]"' in answer.output
