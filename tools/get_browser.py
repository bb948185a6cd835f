"""Get the browsers for the tests of the report that this machine has not; never fail.

Of Chromium Playwright's own build comes first; where its server cannot be reached, root takes the
one of the distribution, and its Firefox with a screen that nobody sees. What is not there `make
test` skips, and says so.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable

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


def found_firefox() -> str | None:
    """Return the path of a Firefox."""
    return shutil.which("firefox-esr") or shutil.which("firefox")


PACKAGES: dict[str, Callable[[], object]] = {
    "chromium": found,
    "firefox-esr": found_firefox,
    "xvfb": lambda: shutil.which("Xvfb"),
}
"""What is wanted, as Debian calls it, and whether it is there."""


def _ran(*command: str) -> bool:
    try:
        return subprocess.run(command, check=False, timeout=600).returncode == 0
    except (OSError, subprocess.TimeoutExpired):
        return False


def main() -> int:
    """Run the script."""
    root = hasattr(os, "geteuid") and os.geteuid() == 0
    missing = [name for name, is_there in PACKAGES.items() if not is_there()]
    playwright = (sys.executable, "-m", "playwright")
    if "chromium" in missing and _ran(*playwright, "install", "chromium"):
        missing.remove("chromium")
        if root:
            _ran(*playwright, "install-deps", "chromium")
    if missing and root and shutil.which("apt-get") and _ran("apt-get", "update", "-qq"):
        for name in missing:
            _ran("apt-get", "install", "-y", "-qq", "--no-install-recommends", name)
    for name, is_there in PACKAGES.items():
        if not is_there():
            print(f"no {name} could be installed: the tests that need it are skipped")
    return 0


if __name__ == "__main__":
    sys.exit(main())
