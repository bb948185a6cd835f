"""Take the published contact problems of docs/friction.md from a clone of Siconos' repository.

    git clone https://github.com/siconos/siconos
    .venv/bin/python benchmarks/published_problems.py siconos problems
    .venv/bin/python benchmarks/friction.py problems

Every file is known by its content, so that it does not matter which commit has been cloned.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import tomlkit

PROBLEMS = Path(__file__).parent / "published-problems.toml"


def main(clone: Path, folder: Path) -> None:
    """Write every problem into the folder."""
    for name, problem in tomlkit.parse(PROBLEMS.read_text(encoding="utf-8")).items():
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content(clone, problem["blob"], problem["path"]))
        print(target)


def content(clone: Path, blob: str, path: str) -> bytes:
    """Return what a file was when it was measured, whatever the clone has checked out."""
    found = subprocess.run(
        ["git", "-C", clone, "cat-file", "blob", blob], check=False, capture_output=True
    )
    if found.returncode != 0:
        sys.exit(f"{clone}: has no {path} of this content ({blob}); is it a full clone of Siconos?")
    return found.stdout


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
