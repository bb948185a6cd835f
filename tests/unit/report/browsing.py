"""A browser without a network, for the tests of the page."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[3] / "tools"))
import get_browser
from get_browser import found, found_firefox

__all__ = [
    "BLIND",
    "WEBGL",
    "Pages",
    "drawn",
    "found",
    "found_firefox",
    "frame",
    "resize",
    "scrub_to",
    "told",
]

SIZE = {"width": 1100, "height": 700}


WEBGL = (*get_browser.WEBGL, "--disable-gpu-compositing")
"""Arguments with which it draws in 3D, and puts pages together without doing so: in half the time
where there is no graphics card."""

STALL = "GPU stall due to ReadPixels"
"""What it warns of where it then reads scenes back."""

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
        page.on("console", lambda message: self.wrong.extend(told(message)))
        page.on("pageerror", lambda error: self.wrong.append(str(error)))
        page.on("request", self._asked)
        page.goto(Path(file).resolve().as_uri())
        page.wait_for_selector("html[data-ready]")
        return page

    def _asked(self, request):
        if not request.url.startswith("file:") or request.resource_type != "document":
            self.wrong.append(f"asked for {request.url[:80]}")


def told(message):
    """What a message of the console says of a page: nothing where it is about this browser."""
    return [] if STALL in message.text else [f"{message.type}: {message.text}"]


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
