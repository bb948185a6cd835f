"""The page in Firefox, where there is one: it draws in 2D and 3D, obeys keys and its policy."""

import shutil
import time
from contextlib import ExitStack

import pytest
from browsing import found_firefox
from firefox import Display, Firefox, StartError

FRAME = "return Number(document.querySelector('#stage').dataset.frame);"
HOME, RIGHT = "\ue011", "\ue014"
LEAST = 3000
"""Bytes of a picture with something in it; of one colour it packs into some hundred."""


@pytest.fixture(scope="module")
def started(tmp_path_factory):
    if found_firefox() is None or shutil.which("Xvfb") is None:
        pytest.skip("there is no Firefox, or no Xvfb for it: python tools/get_browser.py")
    with ExitStack() as ends:
        try:
            display = Display()
            ends.callback(display.close)
            browser = Firefox(tmp_path_factory.mktemp("firefox"), display.name)
        except StartError as error:
            pytest.skip(str(error))
        ends.callback(browser.close)
        yield browser


@pytest.fixture
def firefox(started):
    started.forget()
    return started


def until(condition):
    """Wait for what the page says."""
    end = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.05)


def is_ready(firefox):
    return firefox.run("return 'ready' in document.documentElement.dataset;")


def open_report(firefox, run):
    firefox.open(run.path / "report.html")
    until(lambda: is_ready(firefox))


@pytest.mark.parametrize("name", ["disc", "ball"])
def test_the_report_draws_and_goes_through_time_by_its_keys(firefox, request, name):
    open_report(firefox, request.getfixturevalue(name))
    firefox.press(HOME)
    until(lambda: firefox.run(FRAME) == 0)
    first = firefox.picture("#stage canvas")
    firefox.press(RIGHT, RIGHT, RIGHT)
    until(lambda: firefox.run(FRAME) == 3)
    assert firefox.picture("#stage canvas") != first
    assert len(first) > LEAST
    assert firefox.run("return window.injected;") is None
    assert firefox.wrong() == []


def test_what_goes_wrong_in_a_page_is_heard(firefox, tmp_path):
    """Without this nothing else here could fail."""
    page = tmp_path / "page.html"
    policy = "<meta http-equiv='Content-Security-Policy' content=\"script-src 'unsafe-inline'\">"
    page.write_text(f"{policy}<script>eval('1')</script><script>absent.call()</script>")
    firefox.open(page)
    until(lambda: "absent" in " ".join(firefox.wrong()))
    until(lambda: "eval" in " ".join(firefox.wrong()))


def test_a_cell_of_a_notebook_shows_the_scene(firefox, ball, tmp_path):
    page = tmp_path / "notebook.html"
    page.write_text(f"<!doctype html><body>{ball._repr_html_()}</body>", encoding="utf-8")
    firefox.open(page)
    firefox.ask("WebDriver:SwitchToFrame", id=0)
    until(lambda: is_ready(firefox))
    assert len(firefox.picture("#stage canvas")) > LEAST
    firefox.ask("WebDriver:SwitchToFrame", id=None)
    assert firefox.wrong() == []


def test_curves_are_drawn_beside_the_scene(firefox, disc):
    open_report(firefox, disc)
    assert len(firefox.picture("#panel-energy canvas")) > LEAST
    rows = firefox.run("return document.querySelectorAll('#timeline .event').length;")
    assert rows >= len(disc.summary["contacts"])
    assert firefox.wrong() == []
