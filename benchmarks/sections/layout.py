"""What the sections share: where the page is, and how numbers look on it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from runs import Run

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "validation.md"
IMAGES = ROOT / "docs" / "images"

FRICTIONS = (0.0, 0.2)


def told(name: str, run: Run) -> Run:
    """Return a run after saying how long it took."""
    print(f"{run.wall:6.1f} s  {name}", flush=True)
    return run


def table(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a Markdown table."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join(f"| {' | '.join(str(cell) for cell in line)} |" for line in lines)


def percent(value: float, digits: int = 2) -> str:
    """Return a value in per cent, with a proper minus sign."""
    return f"{signed(100 * value, digits)} %"


def power(value: float) -> str:
    """Return a value as a power of ten, with a proper minus sign in front."""
    return f"{value:.1e}".replace("-", "−", 1) if value < 0 else f"{value:.1e}"


def signed(value: float, digits: int) -> str:
    """Return a value with so many decimals and a proper minus sign."""
    return f"{value:.{digits}f}".replace("-", "−")
