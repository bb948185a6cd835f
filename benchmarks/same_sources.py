"""Refuse to measure a carom that is not the one of these sources."""

from __future__ import annotations

import sys
from pathlib import Path

import carom

ROOT = Path(__file__).parents[1]


def refuse_another_carom() -> None:
    """End with a message where what is imported was built of other sources.

    Hours of measurements would be those of another version, and nothing would say so.
    """
    if changed := changed_since_built(ROOT, Path(carom.__file__).parent):
        sys.exit(
            f"carom was installed before {changed.relative_to(ROOT)} was as it is now; "
            "run `make .venv/installed-dev` first"
        )


def changed_since_built(root: Path, package: Path) -> Path | None:
    """Return a source that is newer than the `package` made of it or differs from its copy."""
    for source in sorted((root / "python" / "carom").rglob("*.py")):
        copy = package / source.relative_to(root / "python" / "carom")
        if not copy.exists() or copy.read_bytes() != source.read_bytes():
            return source
    built_of = [*root.glob("Cargo.*"), *root.glob("crates/*/Cargo.toml")]
    built_of += root.glob("crates/*/src/**/*.rs")
    native = max((module.stat().st_mtime for module in package.glob("_carom*")), default=0.0)
    return next((source for source in sorted(built_of) if source.stat().st_mtime > native), None)
