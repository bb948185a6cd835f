"""The scene of a result in the output of a cell, as Jupyter and exported HTML show it."""

import html
import re
import xml.etree.ElementTree as ET

import pytest
from browsing import told

from carom.io import layout
from carom.report import notebook

LARGEST = 450_000
"""Characters of an output: what a notebook of ten results can bear."""


@pytest.fixture
def cell(browser, tmp_path):
    """Return a function that shows results as an exported notebook does, and what went wrong."""
    made, wrong = [], []

    def asked(request):
        if not request.url.startswith(("file:", "blob:")):
            wrong.append(f"asked for {request.url[:80]}")

    def show(*results):
        file = tmp_path / "notebook.html"
        outputs = "".join(f"<div>{result._repr_html_()}</div>" for result in results)
        file.write_text(f"<!doctype html><body>{outputs}</body>", encoding="utf-8")
        context = browser.new_context(viewport={"width": 900, "height": 1200})
        made.append(context)
        context.set_offline(True)
        page = context.new_page()
        page.on("console", lambda message: wrong.extend(told(message)))
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("request", asked)
        page.goto(file.as_uri())
        frames = [frame for frame in page.frames if frame.parent_frame is not None]
        for frame in frames:
            frame.wait_for_selector("html[data-ready]", state="attached")
        return page, frames

    yield show
    for context in made:
        context.close()
    assert wrong == []


def pixels(frame):
    frame.evaluate(
        "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
    )
    return frame.locator("#stage canvas").screenshot()


def test_a_cell_shows_the_bodies_and_plays_them(disc, cell):
    _, (frame,) = cell(disc)
    frame.locator("#first").click()
    before = pixels(frame)
    for _ in range(9):
        frame.locator("#forward").click()
    assert frame.locator("#stage").get_attribute("data-frame") == "9"
    assert pixels(frame) != before
    assert "0.18" in frame.locator("#time").inner_text()
    (stress, *others) = frame.locator("#field option").all_inner_texts()
    assert "von Mises" in stress
    frame.select_option("#field", label=others[0])
    assert others[0] in frame.locator("#colour-title").inner_text()


def test_everything_is_within_the_frame(disc, cell):
    _, (frame,) = cell(disc)
    page = "document.documentElement"
    assert frame.evaluate(f"{page}.scrollHeight <= {page}.clientHeight")
    assert frame.evaluate(f"{page}.scrollWidth <= {page}.clientWidth")


def test_two_cells_do_not_disturb_each_other(disc, ball, cell):
    """Symptom guarded against: one `id` on a page twice, and both scenes follow one slider."""
    page, (flat, space) = cell(disc, ball)
    flat.locator("#first").click()
    space.locator("#last").click()
    assert flat.locator("#stage").get_attribute("data-frame") == "0"
    assert space.locator("#stage").get_attribute("data-frame") != "0"
    assert page.evaluate("window.injected") is None
    assert space.evaluate("window.injected") is None


def test_the_frame_has_no_rights_and_a_name(ball):
    (frame,) = ET.fromstring(ball._repr_html_()).iter("iframe")
    assert frame.get("sandbox") == "allow-scripts"
    assert frame.get("title").endswith("the bodies in motion")
    (policy,) = re.findall(r'Content-Security-Policy" content="([^"]*)"', frame.get("srcdoc"))
    policy = html.unescape(policy)
    assert policy.startswith("default-src 'none'; script-src 'sha256-")
    assert "http" not in policy
    assert "unsafe-eval" not in policy


def test_an_output_is_small(disc, ball):
    for result in (disc, ball):
        assert len(result._repr_html_()) < LARGEST


def test_large_fields_are_left_to_the_report(disc, monkeypatch):
    assert notebook.notebook_scene(disc.path) is not None
    size = (disc.path / layout.FIELDS).stat().st_size
    monkeypatch.setattr(notebook, "LARGEST_FILE", size - 1)
    assert notebook.notebook_scene(disc.path) is None


def test_a_result_whose_fields_are_broken_still_shows_its_numbers(disc, tmp_path):
    for name in (layout.SUMMARY, layout.HISTORY, layout.CASE):
        (tmp_path / name).write_bytes((disc.path / name).read_bytes())
    (tmp_path / layout.FIELDS).write_bytes(b"no fields")
    assert notebook.notebook_scene(tmp_path) is None
