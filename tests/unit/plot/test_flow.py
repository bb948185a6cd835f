"""Where the energy of a run went: nothing is lost between both sides."""

from itertools import pairwise

import numpy as np
import pytest
from typer.testing import CliRunner

import carom
from carom.cli import app
from carom.plot.flow import Flow, Share, bands, flow
from falling import DISC


@pytest.fixture(scope="module")
def disc(tmp_path_factory):
    return carom.run(carom.Scenario.from_dict(DISC), out=tmp_path_factory.mktemp("disc") / "run")


def joules(shares):
    return {share.label: share.joule for share in shares}


def test_what_came_in_went_somewhere(disc):
    what = flow(disc.history, disc.ledger)
    came, went = joules(what.sources), joules(what.sinks)
    assert sum(came.values()) == pytest.approx(sum(went.values()), rel=1e-12)
    assert came["kinetic energy at the start"] == disc.history["kinetic"][0]
    assert went["friction disc – floor"] == pytest.approx(disc.history["friction"][-1])
    assert went["rotation at the end"] == pytest.approx(disc.history["rotation"][-1])


def test_work_of_the_other_sign_is_on_the_other_side(disc):
    history = {name: values.copy() for name, values in disc.history.items()}
    history["external"][-1] = -0.5
    history["kinetic"][0] += 0.5
    sinks = flow(history, disc.ledger).sinks
    assert joules(sinks)["work of gravity and loads"] == 0.5


def test_friction_that_the_books_of_pairs_do_not_have_is_told_as_one(disc):
    history = {name: values.copy() for name, values in disc.history.items()}
    history["friction"][-1] *= 2.0
    went = joules(flow(history, disc.ledger).sinks)
    assert went["friction"] == history["friction"][-1]
    assert not any("–" in label for label in went)


def test_a_run_without_energy_says_so(disc):
    nothing = {name: np.zeros_like(values) for name, values in disc.history.items()}
    still = carom.Result(path=disc.path, summary=disc.summary, history=nothing)
    assert flow(nothing, {}) == Flow((), ())
    assert [text.get_text() for text in carom.energy_flow(still).axes[0].texts] == ["no energy"]


def test_one_small_term_keeps_its_name_and_several_are_one(disc):
    """Symptom guarded against: what was unexplained of a run, 1e-12 J, stood as all other terms."""
    history = {name: np.zeros_like(values) for name, values in disc.history.items()}
    history["kinetic"] += 100.0
    history["translation"] += 100.0
    history["defect"][-1] = 1e-9
    what = flow(history, {})
    assert joules(what.sources) == {"kinetic energy at the start": 100.0, "unexplained": 1e-9}
    history["viscous"][-1], history["plastic"][-1] = 2e-3, 3e-3
    assert joules(flow(history, {}).sinks)["all other terms"] == pytest.approx(5e-3, rel=1e-12)


def test_bands_are_as_wide_as_their_joules_and_meet_without_a_gap():
    what = Flow(
        (Share("in", "blue", 3.0), Share("more", "grey", 1.0)),
        (Share("a", "red", 0.5), Share("b", "green", 2.5), Share("c", "sky", 1.0)),
    )
    drawn = bands(what, 200.0, lambda _, width: width + 30.0)
    for side in (drawn.sources, drawn.sinks):
        assert [band.width for band in side] == [50.0 * band.share.joule for band in side]
        ends = [band.trunk + band.width for band in side]
        assert side[0].trunk == drawn.top
        assert [band.trunk for band in side[1:]] == pytest.approx(ends[:-1])
        assert ends[-1] == pytest.approx(drawn.top + drawn.width)
        gaps = [b.label - a.label - a.width for a, b in pairwise(side)]
        assert gaps == pytest.approx([30.0] * len(gaps))
        assert side[0].label >= 15.0
        assert side[-1].label + side[-1].width <= drawn.height - 15.0 + 1e-9
    assert drawn.height == pytest.approx(200.0 + 3 * 30.0)


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
