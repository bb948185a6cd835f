"""Static contact against closed forms: wedges, a rough bed, punches, blocks, strips, an O-ring.

Cylinders and spheres of Hertz are in examples/hertz_2d.py and examples/hertz_sphere.py, shafts in
hubs in press_fit.py.

.venv/bin/python benchmarks/static_references.py
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "validation"))

import frictional_bed
import o_ring
import pressed
import punches
import wedges
from compared import Compared
from sections.layout import power, table

PUNCH_CELLS = ((0.01, 1.3), (0.005, 1.15), (0.0025, 1.075))
"""Cells at the corner of a flat punch, in terms of its half-width, and how they grow from there."""


def problems() -> Iterator[Compared]:
    """Run the problems, one after the other."""
    yield from wedges.block_on_a_slope()
    yield wedges.wedge_in_a_gap()
    for discretisation in ("node-to-segment", "mortar"):
        for young in (1e6, 1e8, 1e10):
            yield wedges.wedge_under_a_weight(discretisation, young)
    for cells in (50, 100):
        yield frictional_bed.dissipation(100, cells)[1]
        yield frictional_bed.dissipation(100, cells, low=0.0)[1]
    for cell, growth in PUNCH_CELLS:
        yield punches.flat_of_revolution(cell, growth)
    for cell, growth in PUNCH_CELLS:
        yield punches.flat_in_the_plane(cell, growth)
    for cell in (0.05, 0.025):
        yield punches.rounded_in_the_plane(cell)
    for compression in (0.3, 0.4, 0.5):
        yield pressed.between_plates(compression)
    for compression in (0.4, 0.6):
        yield pressed.bonded(compression)
    for size in pressed.STRIPS:
        yield pressed.strip(*size)


def sealed() -> str:
    """Say what the O-ring does."""
    ring = o_ring.seal()
    return (
        f"O-ring squeezed by 30 %: {ring.squeezed:.0f} N; with {o_ring.FLUID:.0e} Pa at its inside "
        f"{ring.pressed:.0f} N and {ring.wall:.0f} N on the wall, mean pressure at the plate "
        f"{ring.seal:.2e} Pa; {ring.iterations:.1f} iterations per step, {ring.time:.1f} s"
    )


def tabulated() -> str:
    """Return the table of all problems."""
    head = ("problem", "value", "reference", "source", "error", "iterations per step")
    rows = []
    for c in problems():
        values = (f"{c.value:.8g}", f"{c.exact:.8g}")
        rows.append((c.problem, *values, c.source, power(c.error), f"{c.iterations:.1f}"))
    return table(head, rows)


if __name__ == "__main__":
    print(tabulated())
    print()
    print(sealed())
