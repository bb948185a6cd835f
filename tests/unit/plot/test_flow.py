"""Where the energy of a run went: nothing is lost between both sides."""

import numpy as np
import pytest
from typer.testing import CliRunner

import carom
from carom.cli import app
from carom.plot.flow import flow

DISC = {
    "analysis": {"end_time": 0.3, "time_step": 4e-3},
    "materials": {"rubber": {"kind": "neo-hookean", "young": 1e4, "poisson": 0.3, "density": 1.0}},
    "bodies": [
        {
            "name": "disc",
            "material": "rubber",
            "mesh": {"kind": "disc", "centre": [0, 1.05], "radius": 1, "divisions": 4},
            "velocity": [0.3, -1.0],
        }
    ],
    "obstacles": [{"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}],
    "contact": {"friction": 0.2},
}


@pytest.fixture(scope="module")
def disc(tmp_path_factory):
    return carom.run(carom.Scenario.from_dict(DISC), out=tmp_path_factory.mktemp("disc") / "run")


def joules(shares):
    return {share.label: share.joule for share in shares}


def test_what_came_in_went_somewhere(disc):
    what = flow(disc)
    came, went = joules(what.sources), joules(what.sinks)
    assert sum(came.values()) == pytest.approx(sum(went.values()), rel=1e-12)
    assert came["kinetic energy at the start"] == disc.history["kinetic"][0]
    assert went["friction disc – floor"] == pytest.approx(disc.history["friction"][-1])
    assert went["rotation at the end"] == pytest.approx(disc.history["rotation"][-1])


def test_work_of_the_other_sign_is_on_the_other_side(disc):
    history = {name: values.copy() for name, values in disc.history.items()}
    history["external"][-1] = -0.5
    history["kinetic"][0] += 0.5
    turned = carom.Result(path=disc.path, summary=disc.summary, history=history)
    assert joules(flow(turned).sinks)["work of gravity and loads"] == 0.5


def test_friction_that_the_books_of_pairs_do_not_have_is_told_as_one(disc):
    history = {name: values.copy() for name, values in disc.history.items()}
    history["friction"][-1] *= 2.0
    other = carom.Result(path=disc.path, summary=disc.summary, history=history)
    went = joules(flow(other).sinks)
    assert went["friction"] == history["friction"][-1]
    assert not any("–" in label for label in went)


def test_a_run_without_energy_says_so(disc):
    nothing = {name: np.zeros_like(values) for name, values in disc.history.items()}
    still = carom.Result(path=disc.path, summary=disc.summary, history=nothing)
    assert flow(still).sources == flow(still).sinks == ()
    assert [text.get_text() for text in carom.energy_flow(still).axes[0].texts] == ["no energy"]


def test_labels_do_not_overlap_and_are_on_the_page(disc):
    figure = carom.energy_flow(disc)
    figure.canvas.draw()
    page = figure.bbox
    boxes = [text.get_window_extent() for text in figure.axes[0].texts]
    assert all(page.x0 <= b.x0 and b.x1 <= page.x1 and page.y0 <= b.y0 for b in boxes)
    for k, one in enumerate(boxes):
        assert not any(one.overlaps(other) for other in boxes[k + 1 :] if one.y0 >= other.y1 + 1)


def test_the_command_writes_it(disc, tmp_path):
    words = ["picture", str(disc.path), "--what", "energy", "--out", str(tmp_path / "a.pdf")]
    answer = CliRunner().invoke(app, words)
    assert answer.exit_code == 0, answer.output
    assert (tmp_path / "a.pdf").read_bytes().startswith(b"%PDF")
    answer = CliRunner().invoke(app, [*words[:-1], str(tmp_path / "a.txt")])
    assert answer.exit_code == 2
    assert "must end in .pdf, .svg or .png" in answer.output
