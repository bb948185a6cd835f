"""Where the energy went, on the page: bands as wide as joules of the ledger, labels as text."""

import re

import numpy as np
import pytest
from browsing import resize

from carom.io import layout
from carom.ledger_terms import terms
from carom.report.flow import TRUNK, energy_flow

PATH = re.compile(
    r'<path d="M(?P<x>\S+),(?P<top>\S+)C.*?V(?P<foot>\S+)C.*? \S+,(?P<low>\S+)Z"[^>]*'
    r'data-joule="(?P<joule>[^"]+)"'
)


def drawn(page):
    """The bands of a page, those of what came and of what went: widths [px] and joules [J]."""
    found = [{k: float(v) for k, v in m.groupdict().items()} for m in PATH.finditer(page)]
    middle = np.mean([band["x"] for band in found])
    sides = [[band for band in found if (band["x"] < middle) == left] for left in (True, False)]
    return [
        (np.array([b["low"] - b["top"] for b in side]), np.array([b["joule"] for b in side]))
        for side in sides
    ]


def page_of(result):
    return (result.path / layout.REPORT).read_text(encoding="utf-8")


@pytest.mark.parametrize("run", ["disc", "ball"])
def test_bands_have_the_widths_of_the_ledger(request, run):
    result = request.getfixturevalue(run)
    first, last = ({name: v[k] for name, v in result.history.items()} for k in (0, -1))
    came, went = drawn(page_of(result))
    assert len(came[0]) >= 1
    assert len(went[0]) >= 3
    total = first["kinetic"] + first["strain"] + max(last["defect"], 0.0)
    for term in terms("run"):  # what has the other sign is on the other side
        total += max(last[term.name] if term.side == "given" else -last[term.name], 0.0)
    for widths, joules in (came, went):
        assert joules.sum() == pytest.approx(total, rel=1e-12)
        np.testing.assert_allclose(widths, joules * TRUNK / total, atol=1.1e-3)
    friction = last["friction"]
    text = page_of(result)
    assert ("friction disc – floor" in text) == (friction > 0.0)


def test_screen_readers_get_every_band_as_text(disc):
    (figure,) = re.findall(r'<div class="flow".*?</div>', page_of(disc), re.DOTALL)
    assert re.findall(r'<svg[^>]* aria-hidden="true"', figure)
    lists = re.findall(r'<ul[^>]*aria-label="([^"]+)">(.*?)</ul>', figure, re.DOTALL)
    assert [title for title, _ in lists] == ["The energy came from", "The energy went to"]
    items = [re.findall(r"<li[^>]*>(.*?)</li>", text, re.DOTALL) for _, text in lists]
    assert [len(side) for side in items] == [len(joules) for _, joules in drawn(figure)]
    for item in (item for side in items for item in side):
        assert re.search(r"\w <span>[\d.].*J \(.*%\)</span>$", item), item


def test_a_run_whose_books_are_not_whole_has_no_drawing(disc):
    history = dict(disc.history)
    assert energy_flow(history, disc.ledger) is not None
    assert energy_flow({}, {}) is None
    lost = {**history, "kinetic": history["kinetic"] * np.nan}
    assert energy_flow(lost, disc.ledger) is None
    del history["plastic"]
    assert energy_flow(history, disc.ledger) is None


def test_a_run_without_energy_has_no_drawing(disc):
    nothing = {name: np.zeros_like(values) for name, values in disc.history.items()}
    assert energy_flow(nothing, {}) is None


@pytest.mark.parametrize("width", [1440, 1050, 360])
def test_labels_do_not_meet_on_any_width(disc_page, width):
    page = disc_page
    resize(page, width, 800)
    boxes = page.locator(".flow li").evaluate_all(
        "all => all.map(e => e.getBoundingClientRect()).map(b => [b.x, b.right, b.y, b.bottom])"
    )
    assert len(boxes) >= 4
    left, right, upper, lower = np.array(boxes).T
    assert left.min() >= 0.0
    assert right.max() <= width
    for k in range(len(boxes)):
        apart = (
            (left >= right[k])
            | (right <= left[k])
            | (upper >= lower[k] - 1)
            | (lower <= upper[k] + 1)
        )
        assert apart[np.arange(len(boxes)) != k].all(), boxes
    svg = page.locator(".flow svg").bounding_box()
    assert svg["width"] > 60.0
    inside = (left < svg["x"] + svg["width"]) & (right > svg["x"])
    assert not inside.any(), boxes
