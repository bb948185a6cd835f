"""Digests of files."""

from __future__ import annotations

import hashlib
from pathlib import Path

_PART = 1 << 20
"""Bytes that are read at once."""


def digest(path: Path) -> str:
    """Return the SHA-256 of a file, in hexadecimal digits."""
    with path.open("rb") as file:
        sha = hashlib.sha256()
        while part := file.read(_PART):
            sha.update(part)
    return sha.hexdigest()
