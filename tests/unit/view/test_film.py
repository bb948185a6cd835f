"""`carom film` makes a film of what a run left, without a display."""

import itertools
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image, ImageSequence
from typer.testing import CliRunner

import carom
from carom.cli import app
from carom.display.colours import BLUE
from carom.plot.books import layers


def film(*arguments):
    return CliRunner().invoke(app, ["film", *map(str, arguments)])


def pictures(file):
    with Image.open(file) as opened:
        return [
            (np.asarray(frame.convert("RGB"), float), frame.info.get("duration"))
            for frame in ImageSequence.Iterator(opened)
        ]


@pytest.mark.parametrize("ending", ["gif", "webp"])
def test_a_film_has_a_picture_of_every_frame(disc, tmp_path, ending):
    file = tmp_path / f"disc.{ending}"
    answer = film(disc, "--out", file, "--size", "480x270", "--speed", 1)
    assert answer.exit_code == 0, answer.output
    assert answer.output.strip() == str(file)
    shown = pictures(file)
    assert len(shown) == 5
    assert all(p.shape == (270, 480, 3) for p, _ in shown)
    assert all(np.abs(a - b).max() > 100 for (a, _), (b, _) in itertools.pairwise(shown)), "moves"
    if ending == "gif":
        assert [delay for _, delay in shown] == [100] * 5


def test_an_mp4_has_a_picture_of_every_frame(disc, tmp_path):
    ffmpeg = pytest.importorskip("imageio_ffmpeg")
    file = tmp_path / "disc.mp4"
    answer = film(disc, "--out", file, "--size", "320x180", "--fps", 10)
    assert answer.exit_code == 0, answer.output
    count, seconds = ffmpeg.count_frames_and_secs(str(file))
    assert (count, seconds) == (5, pytest.approx(0.5))


def test_a_film_in_space(ball, tmp_path):
    pytest.importorskip("pyvista")
    file = tmp_path / "ball.gif"
    answer = film(ball, "--out", file, "--size", "320x240", "--reactions")
    assert answer.exit_code == 0, answer.output
    shown = pictures(file)
    assert len(shown) == 3
    scene = [picture[40:180, :200] for picture, _ in shown]
    assert all(np.abs(a - b).max() > 20 for a, b in itertools.pairwise(scene)), "it moves"


def test_the_books_grow_with_time(disc, tmp_path):
    film(disc, "--out", tmp_path / "a.gif", "--size", "640x360")
    blue = np.array([int(BLUE[k : k + 2], 16) for k in (1, 3, 5)])
    seen = [
        int((np.abs(picture[:, 420:] - blue).max(axis=2) < 12).sum())
        for picture, _ in pictures(tmp_path / "a.gif")
    ]
    assert all(b > a + 100 for a, b in itertools.pairwise(seen)), seen


def test_without_energies_the_bodies_have_all_the_room(disc, tmp_path):
    film(disc, "--out", tmp_path / "a.gif", "--size", "640x360", "--no-energies")
    (last, _) = pictures(tmp_path / "a.gif")[-1]
    assert (last[150:330, 560:] < 240).any()  # the floor reaches there


def test_terms_that_cannot_be_seen_are_not_drawn():
    names = ("kinetic", "strain", "friction", "viscous", "plastic", "scheme", "normal_contact")
    history = {name: np.zeros(3) for name in (*names, "settling", "springs", "dampers")}
    history |= {"kinetic": np.array([1.0, 0.5, 0.2]), "friction": np.array([0.0, 0.5, 0.8])}
    history["scheme"] = np.full(3, 1e-9)
    assert [layer.label for layer in layers(history)] == ["kinetic", "friction"]
    assert layers({name: np.zeros(3) for name in history}) == []


def test_a_run_at_rest_has_a_film(tmp_path):
    case = {
        "analysis": {"end_time": 2e-3, "time_step": 1e-3},
        "materials": {"m": {"kind": "linear-elastic", "young": 1e6, "poisson": 0, "density": 1e3}},
        "bodies": [
            {
                "name": "b",
                "material": "m",
                "mesh": {
                    "kind": "rectangle",
                    "corner": [0, 0],
                    "size": [1, 1],
                    "divisions": [1, 1],
                },
            }
        ],
    }
    carom.run(carom.Scenario.from_dict(case), out=tmp_path / "run")
    answer = film(tmp_path / "run", "--out", tmp_path / "a.gif", "--size", "320x180")
    assert answer.exit_code == 0, answer.output


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--size", "big"), "--size big: give width and height in pixels, such as 1280x720"),
        (("--size", "641x360"), "--size 641x360: width and height are even numbers of pixels"),
        (("--size", "20x20"), "160 to 4096"),
        (("--duration", 2, "--speed", 1), "--duration and --speed: each says how fast time runs"),
        (("--between", 5, 6), "--between 5 6: no frame of the run is there"),
        (("--field", "velocty"), "--field velocty: no such field"),
    ],
)
def test_bad_input_is_named_before_anything_is_written(disc, tmp_path, options, message):
    answer = film(disc, "--out", tmp_path / "a.gif", *options)
    assert answer.exit_code == 2
    assert message in answer.output
    assert not (tmp_path / "a.gif").exists()


def test_a_file_of_another_kind_is_refused(disc, tmp_path):
    answer = film(disc, "--out", tmp_path / "a.avi")
    assert answer.exit_code == 2
    assert "a.avi: must end in .mp4, .gif or .webp" in answer.output


def test_without_ffmpeg_it_is_said_how_to_get_it(disc, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    answer = film(disc, "--out", tmp_path / "a.mp4")
    assert answer.exit_code == 2
    assert "pip install 'carom[film]'" in answer.output


def test_a_film_that_is_there_is_replaced_with_force_only(disc, tmp_path):
    file = tmp_path / "a.gif"
    file.write_text("mine")
    assert film(disc, "--out", file).exit_code == 2
    assert file.read_text() == "mine"


def test_no_display_is_needed(disc, tmp_path):
    code = f"import carom; carom.film({str(disc)!r}, {str(tmp_path / 'a.gif')!r}, size=(320, 180))"
    done = subprocess.run(
        [sys.executable, "-c", code], env={"PYTHONPATH": ":".join(sys.path)}, check=False
    )
    assert done.returncode == 0
    assert (tmp_path / "a.gif").exists()
