"""The page in Firefox, where there is one: it draws in 2D and 3D, obeys keys, asks nobody."""

import shutil
import time

import pytest
from firefox import Display, Firefox, found

ASKED = "return performance.getEntriesByType('resource').map(e => e.name);"
FRAME = "return Number(document.querySelector('#stage').dataset.frame);"


@pytest.fixture(scope="module")
def firefox(tmp_path_factory):
    if found() is None or shutil.which("Xvfb") is None:
        pytest.skip("there is no Firefox, or no Xvfb for it: python tools/get_browser.py")
    display = Display()
    browser = Firefox(tmp_path_factory.mktemp("firefox"), display.name)
    yield browser
    browser.close()
    display.close()


def until(condition):
    """Wait for what the page says."""
    end = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.05)


def open_report(firefox, run):
    firefox.open(run.path / "report.html")
    until(lambda: firefox.run("return 'ready' in document.documentElement.dataset;"))


@pytest.mark.parametrize("name", ["disc", "ball"])
def test_the_report_draws_and_goes_through_time_by_its_keys(firefox, request, name):
    open_report(firefox, request.getfixturevalue(name))
    firefox.press("\ue011")
    until(lambda: firefox.run(FRAME) == 0)
    first = firefox.picture("#stage canvas")
    firefox.press("\ue014", "\ue014", "\ue014")
    until(lambda: firefox.run(FRAME) == 3)
    assert firefox.picture("#stage canvas") != first
    # An empty picture has one colour; of a scene some thousand bytes are left when it is packed.
    assert len(first) > 3000
    assert firefox.run("return window.injected;") is None
    assert firefox.run(ASKED) == []
    assert firefox.wrong() == []


def test_what_goes_wrong_in_a_page_is_heard(firefox, tmp_path):
    """Without this nothing above could fail."""
    page = tmp_path / "page.html"
    policy = "<meta http-equiv='Content-Security-Policy' content=\"script-src 'unsafe-inline'\">"
    page.write_text(f"{policy}<script>eval('1')</script><script>absent.call()</script>")
    before = len(firefox.wrong())
    firefox.open(page)
    until(lambda: len(firefox.wrong()) >= before + 2)
    said = " ".join(firefox.wrong()[before:])
    assert "absent" in said
    assert "eval" in said
    firefox.forget()


def test_a_cell_of_a_notebook_shows_the_scene(firefox, ball, tmp_path):
    page = tmp_path / "notebook.html"
    page.write_text(f"<!doctype html><body>{ball._repr_html_()}</body>", encoding="utf-8")
    firefox.open(page)
    firefox.ask("WebDriver:SwitchToFrame", id=0)
    until(lambda: firefox.run("return 'ready' in document.documentElement.dataset;"))
    assert len(firefox.picture("#stage canvas")) > 3000
    firefox.ask("WebDriver:SwitchToFrame", id=None)
    assert firefox.wrong() == []


def test_curves_are_drawn_beside_the_scene(firefox, disc):
    open_report(firefox, disc)
    assert len(firefox.picture("#panel-energy canvas")) > 3000
    rows = firefox.run("return document.querySelectorAll('#timeline .event').length;")
    assert rows >= len(disc.summary["contacts"])
