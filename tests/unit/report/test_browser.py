"""The page in a real browser: no errors, one time for all views, keys, themes, nothing injected."""

import json
import shutil

import pytest
from browsing import BLIND, Pages, drawn, frame, scrub_to

from carom.io import layout


@pytest.fixture(autouse=True)
def nothing_goes_wrong(pages):
    yield
    assert not pages.wrong


def marked(page):
    """The time at which the markers of all curves and of the timeline stand [s]."""
    times = page.locator(".now").evaluate_all("all => all.map(m => Number(m.dataset.time))")
    assert len(times) >= 5
    assert len(set(times)) == 1
    return times[0]


def test_scrubbing_moves_scene_and_curves(disc_page):
    scrub_to(disc_page, 2)
    assert frame(disc_page) == 2
    assert marked(disc_page) == pytest.approx(0.04)
    before, place = drawn(disc_page), disc_page.locator("#panel-energy .now").bounding_box()
    scrub_to(disc_page, 15)
    assert frame(disc_page) == 15
    assert marked(disc_page) == pytest.approx(0.3)
    assert drawn(disc_page) != before
    assert disc_page.locator("#panel-energy .now").bounding_box()["x"] > place["x"] + 50
    assert "0.3" in disc_page.locator("#time").inner_text()


def test_a_click_on_a_curve_moves_the_scene(disc_page):
    scrub_to(disc_page, 0)
    over = disc_page.locator("#panel-energy .u-over")
    box = over.bounding_box()
    over.click(position={"x": 0.5 * box["width"], "y": 20})
    assert frame(disc_page) == 10
    assert marked(disc_page) == pytest.approx(0.2)


def test_a_contact_event_takes_the_scene_there(disc, disc_page):
    (contact, *_) = disc.summary["contacts"]
    scrub_to(disc_page, 0)
    disc_page.locator("#timeline .event").first.click()
    assert contact["onset"] <= marked(disc_page) <= contact["release"]
    scrub_to(disc_page, 0)
    disc_page.locator(".go").first.click()
    assert marked(disc_page) == pytest.approx(contact["onset"], abs=0.011)


def test_play_goes_on_and_stops_at_the_end(disc_page):
    scrub_to(disc_page, 0)
    disc_page.select_option("#speed", "0.5")
    disc_page.click("#play")
    assert disc_page.locator("#play").get_attribute("aria-label") == "Pause"
    disc_page.wait_for_selector("#stage:not([data-frame='0']):not([data-frame='20'])")
    disc_page.select_option("#speed", "4")
    disc_page.wait_for_selector("#play[aria-pressed='false']")
    assert frame(disc_page) == 20


def test_keys_step_jump_and_play(disc_page):
    keys = disc_page.keyboard
    keys.press("Home")
    assert frame(disc_page) == 0
    keys.press("ArrowRight")
    assert frame(disc_page) == 1
    keys.press("Shift+ArrowRight")
    assert frame(disc_page) == 11
    keys.press("ArrowLeft")
    assert frame(disc_page) == 10
    keys.press("End")
    assert frame(disc_page) == 20
    disc_page.focus("#scrub")
    keys.press("ArrowLeft")
    assert frame(disc_page) == 19  # once, not by the slider and the page
    keys.press("Space")
    assert disc_page.locator("#play").get_attribute("aria-pressed") == "true"
    keys.press("Space")
    assert disc_page.locator("#play").get_attribute("aria-pressed") == "false"
    disc_page.focus("#field")
    at = frame(disc_page)
    keys.press("Home")  # belongs to the list
    assert frame(disc_page) == at


def test_a_run_of_microseconds_is_told_in_microseconds(steel, opened):
    """Symptom guarded against: ticks 2 × 10⁻⁶, 4 × 10⁻⁶, …, and a clock at 1.2 × 10⁻⁵ s."""
    page = opened(steel.path / layout.REPORT)
    scrub_to(page, 12)
    assert page.locator("#time").inner_text().startswith("t = 12\u202fµs")
    assert "1\u202fµs a second" in page.locator("#pace").inner_text()
    assert page.locator("#curves .hint").inner_text().startswith("Times are in µs.")
    event = page.locator("#timeline .event").first.get_attribute("title")
    assert event.startswith("disc – floor: ")
    assert event.count("\u202fµs") >= 1
    assert "10⁻" not in event.partition(",")[0]


def test_focus_is_seen_and_every_control_has_a_name(disc_page):
    disc_page.keyboard.press("Tab")
    for _ in range(6):
        disc_page.keyboard.press("Tab")
        style = disc_page.evaluate("getComputedStyle(document.activeElement).outlineStyle")
        assert style != "none"
    nameless = disc_page.evaluate(
        """() => [...document.querySelectorAll("button, select, input")].filter((control) =>
            !(control.getAttribute("aria-label") || control.textContent.trim() ||
              [...(control.labels ?? [])].some((label) => label.textContent.trim()))).length"""
    )
    assert nameless == 0


def test_the_theme_follows_the_system_and_the_switch(disc, opened):
    background = "getComputedStyle(document.body).backgroundColor"
    light = opened(disc.path / layout.REPORT, color_scheme="light")
    dark = opened(disc.path / layout.REPORT, color_scheme="dark")
    bright, dim = light.evaluate(background), dark.evaluate(background)
    assert sum(map(int, bright[4:-1].split(","))) > 600
    assert sum(map(int, dim[4:-1].split(","))) < 150
    before = drawn(light)
    light.click("#theme")
    assert light.evaluate(background) == dim
    assert drawn(light) != before
    light.keyboard.press("t")
    assert light.evaluate(background) == bright


def test_numbers_on_the_page_equal_the_summary(disc, disc_page):
    summary = json.loads((disc.path / layout.SUMMARY).read_text())
    disc_page.locator("#numbers summary").click()
    shown = disc_page.locator("#numbers data").evaluate_all(
        "all => Object.fromEntries(all.map(d => [d.dataset.key, Number(d.innerText)]))"
    )
    assert shown["energy.friction"] == summary["energy"]["friction"]
    assert shown["steps"] == summary["steps"]
    assert shown["contacts.0.peak_force"] == summary["contacts"][0]["peak_force"]
    figure = disc_page.locator(".figure data[data-key='energy.final']")
    assert float(figure.inner_text()) == pytest.approx(summary["energy"]["final"], rel=1e-4)


def test_legends_show_the_values_at_the_marked_time(disc, disc_page):
    scrub_to(disc_page, 20)
    disc_page.mouse.move(2, 2)
    shown = disc_page.locator("#panel-energy .legend button").evaluate_all(
        """all => Object.fromEntries(all.map(
            b => [b.childNodes[1].textContent, b.lastChild.innerText]))"""
    )
    for column in ("total", "kinetic", "strain"):
        assert float(shown[column].replace("−", "-")) == pytest.approx(
            disc.history[column][-1], rel=1e-4
        )


def test_fields_can_be_chosen_and_say_their_range(disc_page):
    scrub_to(disc_page, 10)
    seen = set()
    options = disc_page.locator("#field option").all_inner_texts()
    assert {"von Mises stress", "contact pressure", "speed"} <= set(options)
    for option in options:
        disc_page.select_option("#field", label=option)
        assert disc_page.locator("#colour-title").inner_text().startswith(option)
        seen.add(drawn(disc_page))
    assert len(seen) >= len(options) - 1


def test_magnification_and_mesh_change_the_picture(disc_page):
    scrub_to(disc_page, 10)
    pictures = [drawn(disc_page)]
    disc_page.fill("#magnification", "0")
    pictures.append(drawn(disc_page))
    disc_page.uncheck("#edges")
    pictures.append(drawn(disc_page))
    disc_page.fill("#magnification", "1")
    disc_page.check("#edges")
    pictures.append(drawn(disc_page))
    assert pictures.pop() == pictures[0]
    assert len(set(pictures)) == 3


def test_other_columns_and_books_can_be_shown(disc_page):
    disc_page.select_option("#group", label="disc: energy books")
    disc_page.wait_for_selector("#panel-explored h2:has-text('disc: energy books')")
    assert disc_page.locator("#panel-explored .legend li").count() >= 2
    for column, unit in (("v x", "m/s"), ("spin", "rad/s"), ("y", "m")):
        disc_page.select_option("#group", label="disc: motion")
        disc_page.select_option("#column", label=column)
        disc_page.wait_for_selector(
            f"#panel-explored h2:text-is('disc: motion, {column} [{unit}]')"
        )


def test_a_body_in_space_turns_under_the_pointer_and_nothing_is_injected(ball, opened):
    page = opened(ball.path / layout.REPORT)
    assert page.evaluate("window.injected") is None
    assert page.locator("#injected").count() == 0
    assert page.locator("h1").inner_text() == ball.summary["title"]
    before = drawn(page)
    box = page.locator("#stage").bounding_box()
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    assert page.locator("#readout").inner_text().startswith("ball: von Mises stress")
    page.mouse.down()
    page.mouse.move(box["x"] + 0.7 * box["width"], box["y"] + 0.4 * box["height"], steps=3)
    page.mouse.up()
    assert drawn(page) != before


def test_obstacles_of_every_kind_are_drawn(museum, opened):
    page = opened(museum.path / layout.REPORT)
    kinds = [obstacle.kind for obstacle in museum.scenario.obstacles]
    assert kinds == ["plane", "sphere", "cylinder", "box", "surface"]
    page.wait_for_selector("#stage canvas")
    before = drawn(page)
    page.keyboard.press("End")
    assert drawn(page) != before


def test_without_webgl_the_page_says_so_and_the_rest_of_it_works(disc, launched):
    browser = launched(BLIND)
    pages = Pages(browser)
    page = pages.open(disc.path / layout.REPORT)
    assert page.evaluate("document.createElement('canvas').getContext('webgl2')") is None
    said = page.locator("#stage").inner_text()
    assert said.startswith("The scene needs WebGL 2, which this browser does not offer: turn on")
    assert not page.locator("#scene").locator("select, input, button, canvas").first.is_visible()
    (contact, *_) = disc.summary["contacts"]
    assert contact["onset"] <= marked(page) <= contact["release"]
    scrub_to(page, 2)
    assert marked(page) == pytest.approx(0.04)
    page.keyboard.press("End")
    assert page.locator("#time").inner_text().startswith("t = 0.4")
    over = page.locator("#panel-energy .u-over")
    over.click(position={"x": 0.5 * over.bounding_box()["width"], "y": 20})
    assert marked(page) == pytest.approx(0.2)
    page.locator("#numbers summary").click()
    assert page.locator("#numbers data[data-key='steps']").inner_text() == "200"
    assert not pages.wrong
    browser.close()


def test_a_narrow_screen_is_not_overrun(disc, opened):
    page = opened(disc.path / layout.REPORT, viewport={"width": 360, "height": 740})
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    assert page.locator("#stage canvas").bounding_box()["width"] > 250


@pytest.mark.parametrize(
    "missing", [(layout.FIELDS,), (layout.HISTORY, layout.LEDGER), (layout.SUMMARY, layout.SURFACE)]
)
def test_partial_results_open_without_errors(disc, opened, tmp_path, missing):
    from carom.report import write_report

    copy = shutil.copytree(disc.path, tmp_path / "copy")
    for name in missing:
        (copy / name).unlink()
    page = opened(write_report(copy))
    assert page.locator("#scene").is_visible() == (layout.FIELDS not in missing)
    assert page.locator("#curves").is_visible() == (layout.HISTORY not in missing)
    page.keyboard.press("End")
    assert page.locator("#time").inner_text().startswith("t = 0.4")
