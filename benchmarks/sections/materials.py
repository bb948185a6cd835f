"""A body of two materials, and the energy of a body by its modes."""

from __future__ import annotations

import tempfile
from pathlib import Path

import composite_bar
import ringing_bar

from sections.layout import power, table

TEXT = """\
## Several materials in a body

A bar of two materials hits a wall at {speed:g} m/s: ρc = {first:g} and {second:g} Pa s/m, waves
cross each half in {crossing:g} s, ν = 0 (`tests/validation/composite_bar.py`). By d'Alembert's
solution the impulse of the wall per area is {exact:g} Pa s when the bar leaves after 6 ms; the
interface throws back (Z₁ − Z₂)/(Z₁ + Z₂) = {thrown:g}.

Conserving, massless contact. The largest error of the impulse at any time and that at the end,
relative to the whole, and the largest defect of the ledger relative to E₀. Asserted in
`test_composite_bar.py`; the patch test through two materials, to 1e-13 of the stress, in
`crates/carom-fem/tests/suite/regions.rs`.

{bars}
"""

MODES = """\
## Energy by modes

A bar hits one of twice its length, which is then strained by v/2c all along: mode n along it
has 8/(n²π²) of m v²/8 for odd n, and nothing for even n (`tests/validation/ringing_bar.py`).
Errors of the shares of the first three by the number of cells of the long bar, how far shares
change as it flies, and by how much rigid motion, modes and rest together are off kinetic and
strain energy of the history, relative to E₀.

Last, the relative error of e, which is ½.
Asserted in `test_modal_energies.py`.

{shares}
"""


def materials_section() -> str:
    """Run the composite bar with finer and finer cells, and in space."""
    rows = []
    end = 8 * composite_bar.CROSSING
    exact = composite_bar.exact_impulse(end)
    for dimension, cells in ((2, 40), (2, 80), (2, 160), (3, 40)):
        done = composite_bar.run(dimension, cells)
        time, impulse = composite_bar.impulses(done, dimension)
        off = [abs(j - composite_bar.exact_impulse(t)) for t, j in zip(time, impulse, strict=True)]
        energy = done.summary["energy"]
        figures = (max(off) / exact, abs(impulse[-1] / exact - 1.0))
        defect = energy["max_defect"] / energy["initial"]
        rows.append((f"{dimension}D", cells, *map(power, figures), power(defect)))
    first, second = composite_bar.IMPEDANCES
    return TEXT.format(
        speed=composite_bar.SPEED,
        first=first,
        second=second,
        crossing=composite_bar.CROSSING,
        exact=exact,
        thrown=(first - second) / (first + second),
        bars=table(("", "cells of the near half", "largest error", "at the end", "defect"), rows),
    )


def modes_section() -> str:
    """Run the bars with finer and finer cells."""
    rows = []
    with tempfile.TemporaryDirectory() as directory:
        for cells in (50, 100, 200):
            bar = ringing_bar.ringing(cells, Path(directory) / str(cells))
            errors = abs(bar.shares - ringing_bar.EXACT)
            figures = (bar.change, bar.off, abs(2.0 * bar.restitution - 1.0))
            rows.append((cells, *map(power, errors), *map(power, figures)))
    header = ("cells", *(f"mode {n}" for n in ringing_bar.NUMBERS), "change", "sum", "e")
    return MODES.format(shares=table(header, rows))
