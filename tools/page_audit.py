"""What is wrong with a page for those who cannot see it well, use no mouse, or have no network.

`tools/check_site.py` asks this of the site, the tests ask it of the report.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

LEAST_CONTRAST = 4.5
"""Of text with its ground, as WCAG 2 has it for level AA; 3 for large text."""

AUDIT = Path(__file__).with_name("page_audit.js").read_text(encoding="utf-8")

FOCUS = Path(__file__).with_name("page_focus.js").read_text(encoding="utf-8")


def audit(page: Any) -> list[str]:  # noqa: ANN401 (a page or frame of Playwright)
    """Return what is wrong with a page that a browser shows, in the colours that it has."""
    found: list[str] = page.evaluate(AUDIT, LEAST_CONTRAST)
    return found


def focus_is_seen(page: Any, presses: int = 12) -> list[str]:  # noqa: ANN401 (as above)
    """Return what the key Tab comes to without a mark of it, in so many presses."""
    unseen = []
    for _ in range(presses):
        page.keyboard.press("Tab")
        if marked := page.evaluate(FOCUS):
            unseen.append(f"focus is not seen: {marked}")
    return unseen
