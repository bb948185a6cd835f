"""The libraries in the page are those that were chosen, with their licences."""

import subprocess
import sys
from importlib import resources
from pathlib import Path

SCRIPT = Path(__file__).parents[3] / "tools" / "renew_vendored.py"


def test_vendored_files_are_those_of_the_pinned_packages():
    done = subprocess.run(
        [sys.executable, SCRIPT, "--check"], check=False, capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (0, "")


def test_the_package_has_libraries_licences_and_scripts():
    package = resources.files("carom.report")
    names = {file.name for folder in ("vendor", "assets") for file in (package / folder).iterdir()}
    assert {"three.min.js", "uPlot.iife.min.js", "LICENSE-three", "LICENSE-uPlot"} <= names
    assert {"page.html", "style.css", "main.js"} <= names
    for library in ("three", "uPlot"):
        licence = (package / "vendor" / f"LICENSE-{library}").read_text()
        assert "MIT" in licence and "Permission is hereby granted" in licence
