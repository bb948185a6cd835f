"""Fields as they are shown, and the window of `carom view`."""

import re
from pathlib import Path

import numpy as np
import pytest
import tomlkit
from typer.testing import CliRunner

from carom.cli import app
from carom.io.frames import Frames
from carom.view import shown
from carom.view.subject import subject


def view(*arguments):
    return CliRunner().invoke(app, ["view", *map(str, arguments)])


def test_frames_are_read_back(ball):
    frames = Frames(ball / "fields.vtkhdf")
    np.testing.assert_allclose(frames.times, [0, 2e-3, 4e-3])
    assert frames.nearest(1.9e-3) == 1
    assert frames.nearest(None) == 2
    assert set(frames.types) == {25}
    fall = frames.field("displacement", 2)[:, 2]
    assert fall.mean() == pytest.approx(-4e-3, rel=0.1)
    speed = shown(frames, "velocity").values(frames, 0)
    np.testing.assert_allclose(speed, 1.0)


def test_equivalent_stress_of_pure_tension_is_the_tension(ball, monkeypatch):
    frames = Frames(ball / "fields.vtkhdf")
    tension = np.array([[7.0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 7.0 / np.sqrt(3)]])
    monkeypatch.setattr(frames, "field", lambda name, frame: tension)
    np.testing.assert_allclose(shown(frames, "von-mises").values(frames, 0), 7.0)
    np.testing.assert_allclose(shown(frames, "hydrostatic-pressure").values(frames, 0), [-7 / 3, 0])


def test_pictures_and_pages_have_one_word_for_a_field(ball):
    frames = Frames(ball / "fields.vtkhdf")
    assert shown(frames, None).title == "von Mises stress [Pa]"
    assert shown(frames, "velocity").title == "speed [m/s]"
    assert shown(frames, "strain").title == "equivalent strain"


def test_smooth_values_of_a_constant_are_the_constant(disc):
    what = subject(disc)
    faces = np.full(len(what.seen.cell), 3.0)
    np.testing.assert_allclose(what.on_points(faces), 3.0)
    faces[0] = np.nan  # no value is none
    smooth = what.on_points(faces)
    np.testing.assert_allclose(smooth[np.isfinite(smooth)], 3.0)


def test_limits_of_what_has_a_sign_have_zero_in_the_middle(disc):
    what = subject(disc, field="hydrostatic-pressure")
    low, high = what.colouring.limits(range(5))
    assert low == -high < 0.0


def test_limits_of_what_is_the_same_everywhere_begin_at_zero(ball):
    assert subject(ball, field="velocity").colouring.limits([0]) == (0.0, pytest.approx(1.0))
    assert subject(ball, field="displacement").colouring.limits([0]) == (0.0, 1.0)


def test_without_a_display_the_commands_for_files_are_named(ball, monkeypatch):
    monkeypatch.setattr("carom.view.window._is_headless", lambda: True)
    answer = view(ball)
    assert answer.exit_code == 2
    assert "there is no display for a window; carom picture and carom film draw" in answer.output


def test_the_window_has_bodies_colours_and_a_slider(ball, monkeypatch):
    pyvista = pytest.importorskip("pyvista")
    monkeypatch.setattr("carom.view.window._is_headless", lambda: False)
    made = pyvista.Plotter
    seen = {}

    def hidden(**options):
        plotter = made(**{**options, "off_screen": True})
        monkeypatch.setattr(plotter, "add_slider_widget", lambda turn, *_, **__: turn(1))
        monkeypatch.setattr(plotter, "show", lambda: seen.update(actors=list(plotter.actors)))
        return plotter

    monkeypatch.setattr(pyvista, "Plotter", hidden)
    answer = view(ball)
    assert answer.exit_code == 0, answer.output
    assert "time" in seen["actors"]


def test_extras_bring_what_pictures_and_films_take():
    """Symptom guarded against: films asked for imageio after pip install carom[view]."""
    project = Path(__file__).parents[3] / "pyproject.toml"
    extras = tomlkit.parse(project.read_text())["project"]["optional-dependencies"]
    named = {k: {re.split(r"[\[>=<]", line)[0] for line in extras[k]} for k in ("view", "film")}
    assert named == {"view": {"pyvista"}, "film": {"imageio-ffmpeg"}}
