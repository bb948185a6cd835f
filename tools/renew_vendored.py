"""Renew the JavaScript libraries of the report, or check that they are what they should be.

``python tools/renew_vendored.py --check`` compares the files in ``python/carom/report/vendor`` with
the SHA-256 in ``sources.json`` (exit status 1 if one differs). Without ``--check`` it fetches the
packages that ``sources.json`` pins with npm, refuses those whose integrity is not the pinned one,
writes the files, and with them their SHA-256. To take a newer version, change its ``version`` and
``integrity`` (``npm view NAME@VERSION dist.integrity``) first.
"""

from __future__ import annotations

import argparse
import base64
import hashlib
import json
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path
from typing import Any

VENDOR = Path(__file__).parents[1] / "python" / "carom" / "report" / "vendor"
SOURCES = VENDOR / "sources.json"


def main() -> int:
    """Run the script."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="only compare with sources.json")
    sources = json.loads(SOURCES.read_text(encoding="utf-8"))
    if not parser.parse_args().check:
        _renew(sources)
    wrong = [name for name, digest in sources["files"].items() if _sha256(name) != digest]
    for name in wrong:
        print(f"{VENDOR / name}: is not the file that sources.json names", file=sys.stderr)
    return 1 if wrong else 0


def _renew(sources: dict[str, Any]) -> None:
    with tempfile.TemporaryDirectory() as scratch:
        work = Path(scratch)
        modules = work / "node_modules"
        for name, package in sources["packages"].items():
            _fetch(name, package, work, modules / name)
        # The one file that is not taken as published: what is used of three.js, in one piece.
        shutil.copy(VENDOR / "three_entry.js", work)
        esbuild = modules / "esbuild-wasm" / "bin" / "esbuild"
        subprocess.run(
            [
                *("node", esbuild, "three_entry.js", "--bundle", "--minify", "--format=iife"),
                *("--global-name=THREE", "--log-level=warning", "--outfile=three.min.js"),
            ],
            cwd=work,
            check=True,
        )
        licence = (modules / "three" / "LICENSE").read_text(encoding="utf-8")
        bundle = (work / "three.min.js").read_text(encoding="utf-8")
        version = sources["packages"]["three"]["version"]
        head = f"/*! three.js {version} (bundled)\n{licence.strip()}\n*/\n"
        (VENDOR / "three.min.js").write_text(head + bundle, encoding="utf-8")
        shutil.copy(modules / "three" / "LICENSE", VENDOR / "LICENSE-three")
        shutil.copy(modules / "uplot" / "LICENSE", VENDOR / "LICENSE-uPlot")
        for name in ("uPlot.iife.min.js", "uPlot.min.css"):
            shutil.copy(modules / "uplot" / "dist" / name, VENDOR / name)
    sources["files"] = {name: _sha256(name) for name in sources["files"]}
    SOURCES.write_text(json.dumps(sources, indent=2) + "\n", encoding="utf-8")


def _fetch(name: str, package: dict[str, str], work: Path, into: Path) -> None:
    """Take a published package apart where bundlers look for it."""
    what = f"{name}@{package['version']}"
    packed = subprocess.run(
        ["npm", "pack", "--silent", what], cwd=work, check=True, capture_output=True, text=True
    )
    archive = work / packed.stdout.split()[-1]
    digest = base64.b64encode(hashlib.sha512(archive.read_bytes()).digest()).decode()
    if f"sha512-{digest}" != package["integrity"]:
        sys.exit(f"{what}: has the integrity sha512-{digest}, sources.json pins another")
    with tarfile.open(archive) as tar:
        tar.extractall(work / "unpacked", filter="data")
    into.parent.mkdir(parents=True, exist_ok=True)
    shutil.move(work / "unpacked" / "package", into)


def _sha256(name: str) -> str:
    return hashlib.sha256((VENDOR / name).read_bytes()).hexdigest()


if __name__ == "__main__":
    sys.exit(main())
