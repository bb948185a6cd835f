"""A browser without a network, for the tests of the page."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[3] / "tools"))
from get_browser import WEBGL, found

__all__ = ["BLIND", "WEBGL", "Pages", "drawn", "found", "frame", "resize", "scrub_to"]

SIZE = {"width": 1100, "height": 700}


BLIND = ("--disable-gpu", "--disable-3d-apis", "--no-sandbox")
"""Arguments with which it does not draw in 3D, as some remote desktops and old machines."""


class Pages:
    """Opens reports without a network, and keeps what went wrong in them."""

    def __init__(self, browser):
        self._browser = browser
        self.wrong = []

    def open(self, file, **options):
        context = self._browser.new_context(**{"viewport": SIZE, **options})
        context.set_offline(True)
        page = context.new_page()
        page.on("console", lambda message: self.wrong.append(f"{message.type}: {message.text}"))
        page.on("pageerror", lambda error: self.wrong.append(str(error)))
        page.on("request", self._asked)
        page.goto(Path(file).resolve().as_uri())
        page.wait_for_selector("html[data-ready]")
        return page

    def _asked(self, request):
        if not request.url.startswith("file:") or request.resource_type != "document":
            self.wrong.append(f"asked for {request.url[:80]}")


def scrub_to(page, frame):
    page.locator("#scrub").evaluate(
        "(s, frame) => { s.value = frame; s.dispatchEvent(new Event('input')); }", frame
    )


def frame(page):
    return int(page.locator("#stage").get_attribute("data-frame"))


def resize(page, width, height):
    """Make its window as large and wait for what follows; a page of its own takes some seconds."""
    page.set_viewport_size({"width": width, "height": height})
    next_frame(page)


def next_frame(page):
    page.evaluate(
        "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
    )


def drawn(page):
    """What the scene shows, as a picture."""
    next_frame(page)
    return page.locator("#stage canvas").screenshot()
