"""Get a Chromium for the tests of the report, if this machine has none; never fail.

Playwright's own build comes first; where its server cannot be reached, root takes the one of the
distribution. Without either, `make test` skips what needs a browser, and says so.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
"""Of browsers on the path that will do."""

WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox")
"""Arguments with which it draws in 3D where there is no graphics card."""


def found() -> str | None:
    """Return the path of a Chromium, that of Playwright before others."""
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 (only in the dev extra)

    with sync_playwright() as playwright:
        own = playwright.chromium.executable_path
    shells = [own] if os.path.exists(own) else []  # noqa: PTH110 (it is text)
    return next(filter(None, [*shells, *map(shutil.which, NAMES)]), None)


def _ran(*command: str) -> bool:
    try:
        return subprocess.run(command, check=False, timeout=600).returncode == 0
    except (OSError, subprocess.TimeoutExpired):
        return False


def main() -> int:
    """Run the script."""
    if found():
        return 0
    root = hasattr(os, "geteuid") and os.geteuid() == 0
    playwright = (sys.executable, "-m", "playwright")
    if _ran(*playwright, "install", "chromium"):
        if root:
            _ran(*playwright, "install-deps", "chromium")
    elif root and shutil.which("apt-get"):
        _ran("apt-get", "update", "-qq")
        _ran("apt-get", "install", "-y", "-qq", "--no-install-recommends", "chromium")
    if not found():
        print("no browser could be installed: the tests that need one are skipped")
    return 0


if __name__ == "__main__":
    sys.exit(main())
