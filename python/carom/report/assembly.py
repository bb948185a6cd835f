"""What pages are put together from: files of the package, and the policy of scripts."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence
from importlib import resources

from carom.display.markup import Html


def asset(folder: str, name: str) -> str:
    """Return a text file of the package, of the folder ``assets`` or ``vendor``."""
    return (resources.files("carom.report") / folder / name).read_text(encoding="utf-8")


def policy(scripts: Sequence[str], *, unpacked: bool = False) -> str:
    """Return a policy under which no other script runs, and nothing is fetched.

    Parameters
    ----------
    scripts
        What may run.
    unpacked
        Whether these may run what they have unpacked from the page itself.
    """
    digests = (hashlib.sha256(script.encode()).digest() for script in scripts)
    allowed = " ".join(f"'sha256-{base64.b64encode(digest).decode()}'" for digest in digests)
    own = " blob:" if unpacked else ""
    return (
        f"default-src 'none'; script-src {allowed}{own}; style-src 'unsafe-inline'; "
        "img-src data: blob:; base-uri 'none'; form-action 'none'"
    )


def elements(scripts: Sequence[str]) -> list[Html]:
    """Return scripts as elements, with the very text that the policy names."""
    return [Html(f"<script>{script}</script>\n") for script in scripts]
