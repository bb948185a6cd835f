"""Springs and point masses on the page of a report."""

import numpy as np
import pytest
from browsing import drawn, scrub_to

import carom
from carom.io import layout
from carom.io.history import read_history
from carom.report import write_report
from carom.report.codec import unpack
from hanging import PLANE, SPACE


def reported(case, directory):
    result = carom.run(carom.Scenario.from_dict(case), out=directory / "run")
    write_report(result.path)
    return result


@pytest.fixture(scope="module")
def plane(tmp_path_factory):
    return reported(PLANE, tmp_path_factory.mktemp("plane"))


@pytest.fixture(scope="module")
def space(tmp_path_factory):
    return reported(SPACE, tmp_path_factory.mktemp("space"))


@pytest.fixture(scope="module")
def page(plane, pages):
    return pages.open(plane.path / layout.REPORT)


@pytest.fixture(autouse=True)
def nothing_goes_wrong(pages):
    yield
    assert not pages.wrong


def test_the_scene_has_all_springs_with_their_forces(plane, data_of):
    scene = data_of(plane.path / layout.REPORT).scene
    found = scene["connections"]
    assert [link["name"] for link in found["links"]] == ["cable", "strut", "dashpot", "hook"]
    assert [link["kind"] for link in found["links"]].count("damper") == 1
    assert found["links"][1]["between"] == ["wheel", "right of beam"]
    assert [lump["mass"] for lump in found["lumps"]] == [4.0, 10.0]
    history = read_history(plane.path / layout.HISTORY)
    force = unpack(found["arrays"]["force"])
    assert force[-1, 0] == pytest.approx(history["cable.force"][-1])
    ends = unpack(found["arrays"]["drawn"]) + unpack(found["arrays"]["moved"])
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert lengths == pytest.approx(history["cable.length"], abs=1e-4)
    assert scene["high"][1] >= 1.0  # where the hook is fixed


def test_a_case_without_them_has_none(disc, data_of):
    page = disc.path / layout.REPORT
    assert data_of(page).scene["connections"] is None
    assert 'id="spring-table"' not in page.read_text()
    assert 'id="mass-table"' not in page.read_text()


def test_tables_tell_how_far_springs_went(plane, page):
    history = read_history(plane.path / layout.HISTORY)
    rows = page.locator("#spring-table tbody tr").all_inner_texts()
    name, between, shortest, longest, pull, push = rows[1].split("\t")
    assert (name, between) == ("strut", "wheel – right of beam")
    assert float(shortest) == pytest.approx(history["strut.length"].min(), rel=1e-3)
    assert float(longest) == pytest.approx(history["strut.length"].max(), rel=1e-3)
    assert float(pull) == pytest.approx(history["strut.force"].max(), rel=1e-3)
    assert float(push) == pytest.approx(-history["strut.force"].min(), rel=1e-3)
    assert rows[3].endswith("\t0")  # the hook only pulled
    masses = page.locator("#mass-table tbody tr").all_inner_texts()
    assert masses == ["left of beam\t4", "wheel\t10"]


def point_at(page, x, y):
    """Move the pointer to a place of the plane [m]; return what is told of it."""
    box = page.locator("#stage canvas").bounding_box()
    low, high = (
        page.evaluate(f"JSON.parse(data.textContent).scene.{end}") for end in ("low", "high")
    )
    size = [b - a for a, b in zip(low, high, strict=True)]
    half = 0.54 * max(size[1], size[0] * box["height"] / box["width"])
    per_metre = box["height"] / (2 * half)
    across = box["width"] / 2 + (x - (low[0] + high[0]) / 2) * per_metre
    up = box["height"] / 2 - (y - (low[1] + high[1]) / 2) * per_metre
    page.mouse.move(box["x"] + across, box["y"] + up)
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => setTimeout(done)))")
    return page.locator("#readout").inner_text()


def test_the_force_over_time_can_be_shown(page):
    page.select_option("#group", label="strut: length and force")
    page.select_option("#column", label="force")
    heading = page.locator("#panel-explored h2")
    assert "strut: length and force, force [N]" in heading.inner_text()
    page.select_option("#column", label="length")
    heading.get_by_text("length [m]").wait_for()


def test_the_pointer_tells_length_and_force(page):
    scrub_to(page, 0)
    told = point_at(page, 0.5, 0.9)
    assert told.startswith("hook (wheel – a fixed point): length 0.35")
    assert "as long as without tension" in told
    assert "pulls with 0" in told
    told = point_at(page, 0.7, 0.25)
    assert "strut (wheel – right of beam)" in told
    # drawn 0.61 m long, free 0.5 m, 2 kN/m
    assert "stretched by 0.11" in told
    assert "pulls with 220.7" in told
    assert point_at(page, 0.4, 0.5) == "point mass of 10\u202fkg on wheel"
    assert point_at(page, 0.5, 0.05).startswith("beam: von Mises stress")


def test_springs_are_drawn_and_can_be_left_out(page):
    scrub_to(page, 10)
    shown = drawn(page)
    page.locator("#attached").uncheck()
    without = drawn(page)
    assert shown != without
    point_at(page, 0.5, 0.95)
    assert "hook" not in page.locator("#readout").inner_text()
    page.locator("#attached").check()
    assert drawn(page) == shown


def test_springs_of_space_are_drawn(space, opened):
    page = opened(space.path / layout.REPORT)
    scrub_to(page, 5)
    shown = drawn(page)
    page.locator("#attached").uncheck()
    assert drawn(page) != shown


def test_what_nothing_moves_is_drawn_all_the_same(tmp_path, opened):
    """Symptom: the page of a run in which nothing moved never got ready."""
    crate = SPACE["bodies"][1]
    still = {**SPACE, "analysis": {"end_time": 0.02, "time_step": 4e-3}, "bodies": [crate]}
    hook = {"name": "hook", "stiffness": 10.0}
    hook["between"] = [{"body": "crate", "point": [0.7, 0.1, 0.3]}, {"point": [0.7, 0.1, 1.0]}]
    result = reported({**still, "springs": [hook], "output": {}}, tmp_path)
    page = opened(result.path / layout.REPORT)
    assert page.locator("#field option").all_inner_texts() == ["displacement"]
    assert page.locator("#readout").inner_text() == "displacement in this frame up to 0\u202fm"
    shown = drawn(page)
    page.locator("#attached").uncheck()
    assert drawn(page) != shown


def test_without_springs_there_is_nothing_to_choose(disc_page):
    assert not disc_page.locator("#attached-choice").is_visible()
