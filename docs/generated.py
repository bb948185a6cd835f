"""Files of the documentation that scripts write, and that must be up to date."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path


def write_or_check(files: Mapping[Path, str]) -> int:
    """Write the files; with ``--check`` on the command line compare them, and return 1 if not."""
    if "--check" not in sys.argv[1:]:
        for file, text in files.items():
            file.write_text(text, encoding="utf-8")
        return 0
    outdated = [
        file
        for file, text in files.items()
        if not file.exists() or file.read_text(encoding="utf-8") != text
    ]
    for file in outdated:
        script = Path(sys.argv[0]).name
        print(f"{file} is out of date; run python docs/{script}", file=sys.stderr)
    return int(bool(outdated))
