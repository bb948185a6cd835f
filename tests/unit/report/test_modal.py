"""The energy of modes on the page: spectrograms, and which modes ring after which contact."""

import base64
import io
import re
import shutil
from dataclasses import replace

import numpy as np
import pytest
from browsing import scrub_to
from PIL import Image

import carom
from carom.display.markup import format_number
from carom.io import layout
from carom.report import write_report
from carom.report.modal import DECADES, MOST_BODIES, ringing_table, spectrograms


@pytest.fixture(scope="module")
def bars(tmp_path_factory):
    """A short bar strikes a long one; both fly on alone and ring."""
    steel = carom.SaintVenantKirchhoff(young=1e4, poisson=0.0, density=1.0)
    short, long = (
        carom.Body(
            name=name,
            material="steel",
            mesh=carom.Rectangle(corner=[at, 0.0], size=[length, 0.02], divisions=[cells, 1]),
            velocity=[speed, 0.0],
        )
        for name, at, length, cells, speed in (
            ("short", -1.001, 1.0, 20, 0.1),
            ("long", 0.0, 2.0, 40, 0.0),
        )
    )
    scenario = carom.Scenario(
        title="bars",
        analysis=carom.Dynamic(end_time=0.08, time_step=4e-4),
        materials={"steel": steel},
        bodies=[short, long],
        output=carom.Output(fields_every=2e-3, modes=5, report=True),
    )
    return carom.run(scenario, out=tmp_path_factory.mktemp("bars") / "run")


@pytest.fixture(scope="module")
def page(bars, pages):
    return pages.open(bars.path / layout.REPORT)


@pytest.fixture(autouse=True)
def nothing_goes_wrong(pages):
    yield
    assert not pages.wrong


def pictures(html):
    """Return the spectrograms of a page as shares of full colour, the slowest mode first."""
    found = re.findall(r'href="data:image/png;base64,([^"]+)"', html)
    images = [Image.open(io.BytesIO(base64.b64decode(one))) for one in found]
    return [np.asarray(image, dtype=float)[::-1] / 255.0 for image in images]


def test_a_spectrogram_has_the_energies_in_its_shades(bars):
    modes = carom.modal_energies(bars, count=5)
    drawn = pictures(spectrograms({"long": modes["long"]}))
    assert len(drawn) == 1
    (shades,) = drawn
    energies = modes["long"].energies
    assert shades.shape == (5, 2 * len(energies))
    assert shades.max() == 1.0
    level = 1.0 + np.log10(energies.T / energies.max()) / DECADES
    # Two columns to a frame, but half of one at the ends.
    middle = shades[:, 20]
    assert middle == pytest.approx(level[:, 10].clip(0.0, 1.0), abs=0.5 / 255 + 1e-12)
    assert not shades[:, 0].any()  # at rest


def test_bodies_that_vibrate_most_come_first_and_the_rest_is_counted(bars):
    modes = carom.modal_energies(bars, count=5)
    loud = modes["long"]
    many = {f"bar {k}": loud for k in range(MOST_BODIES + 2)}
    html = spectrograms(many)
    assert html.count('class="spectrogram"') == MOST_BODIES
    assert "2 more bodies are in modes.csv" in html
    assert html.count("<mask ") == len(set(re.findall(r'<mask id="([^"]+)"', html)))


def test_nothing_is_drawn_of_what_does_not_vibrate(bars, disc):
    assert spectrograms({}) is None
    loud = carom.modal_energies(bars, count=5)["long"]
    quiet = replace(loud, kinetic=0.0 * loud.kinetic, strain=0.0 * loud.strain)
    assert spectrograms({"quiet": quiet}) is None
    assert ringing_table({"quiet": quiet}, bars.summary) is None
    assert 'id="modes-table"' not in (disc.path / layout.REPORT).read_text()


def test_the_table_tells_which_modes_ring_after_the_contact(bars, page):
    (contact,) = bars.summary["contacts"]
    rows = [row.split("\t") for row in page.locator("#modes-table tbody tr").all_inner_texts()]
    assert [row[2] for row in rows] == ["short", "long"]
    for between, parted, name, rings, joule in rows:
        assert between == "short – long"
        assert float(parted) == pytest.approx(contact["release"], rel=1e-3)
        one = carom.modal_energies(bars, count=5)[name]
        mean = one.energies[one.times >= contact["release"]].mean(axis=0)
        assert joule == format_number(float(mean.sum()), 4)
        first = int(mean.argmax())
        share = 100 * mean[first] / mean.sum()
        assert rings.startswith(f"{one.frequencies[first]:.3g}\u202fHz ({share:.0f} %)")


def test_what_still_presses_keeps_a_body_from_ringing_by_itself(bars):
    modes = carom.modal_energies(bars, count=5)
    (contact,) = bars.summary["contacts"]
    pressing = {**contact, "pair": ["long", "wall"], "onset": 0.0, "release": None}
    rows = ringing_table(modes, {"contacts": [contact, pressing]})
    assert rows.count("<td>long</td>") == 0
    assert rows.count("<td>short</td>") == 1


def test_a_click_on_a_spectrogram_goes_to_that_time(page):
    assert page.locator(".spectrogram").count() == 2
    scrub_to(page, 0)
    track = page.locator(".spectrogram .track").first
    track.scroll_into_view_if_needed()
    box = track.bounding_box()
    track.click(position={"x": 0.5 * box["width"], "y": 8})
    times = page.locator(".now").evaluate_all("all => all.map(m => Number(m.dataset.time))")
    assert min(times) == max(times) == pytest.approx(0.04)
    marker = page.locator(".spectrogram .now").first.bounding_box()
    assert marker["x"] + marker["width"] / 2 == pytest.approx(box["x"] + box["width"] / 2, abs=2)


def test_a_damaged_table_is_noted_on_the_page(bars, tmp_path):
    shutil.copytree(bars.path, tmp_path / "run")
    (tmp_path / "run" / layout.MODES).write_text("nothing\n")
    text = write_report(tmp_path / "run").read_text(encoding="utf-8")
    assert "no energies by modes of carom" in text
    assert 'id="modes-table"' not in text
