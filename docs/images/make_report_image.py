"""Make the picture of a report that the README shows: that of examples/two_cylinders.toml as it is.

It needs a Chromium: ``python tools/get_browser.py``.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from playwright.sync_api import sync_playwright

import carom

sys.path.insert(0, str(Path(__file__).parents[2] / "tools"))
from get_browser import WEBGL, found

HERE = Path(__file__).parent
CASE = HERE.parents[1] / "examples" / "two_cylinders.toml"

OVERRIDES = ["output.report=true"]
"""Nothing of the case itself."""

TIME = 5.25
"""When the first cylinder is at the ceiling [s]."""


def main() -> None:
    """Run the case, open its report, and write what is seen beside this script."""
    scenario = carom.Scenario.from_toml(CASE)
    chromium = found()
    with TemporaryDirectory() as scratch, sync_playwright() as playwright:
        result = carom.run(scenario.with_overrides(OVERRIDES), out=scratch)
        browser = playwright.chromium.launch(executable_path=chromium, args=list(WEBGL))
        page = browser.new_page(viewport={"width": 1440, "height": 900})
        page.goto((result.path / "report.html").resolve().as_uri())
        page.wait_for_selector("html[data-ready]")
        page.keyboard.press("Home")
        for _ in range(round(TIME / 0.05)):
            page.keyboard.press("ArrowRight")
        page.wait_for_timeout(500)
        page.screenshot(path=HERE / "report.png")
        browser.close()


if __name__ == "__main__":
    main()
