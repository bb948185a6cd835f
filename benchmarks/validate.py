"""Run every validation, long ones included, and rewrite docs/validation.md with its pictures.

``make validate`` runs this. The cases and the measures are those of tests/validation; every section
of the page is a module of `sections`.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "validation"))

from sections import bars, conservation, cylinders, damping, dissipation, layer
from sections.layout import IMAGES, PAGE, ROOT

import carom

KEPT = "<!-- What follows has commands of its own; make validate leaves it as it is. -->"
"""Where the part of the page begins that is not written here."""

INTRODUCTION = """\
# Validation

`make validate` runs everything below and rewrites this page; the numbers are those of carom
{version}. The tests named in the tables assert them in every `make test`.

Where the references come from:

- **exact**: analytic solutions, written as code in `tests/validation/bars.py` (d'Alembert),
  `tests/validation/layer.py` and `tests/validation/oscillator.py`.
- **prototype**: an independent implementation in plain Python, same method, separate code. Its
  curves are in `tests/validation/reference/`.
- **paper**: B. Magnain, Z.-Q. Feng, J.-M. Cros, *Modélisation des problèmes d'impact avec
  dissipation d'énergie par frottement*, C. R. Mécanique 333 (2005) 419–424.

The paper gives the material, the velocities, the sizes of the bodies and the time steps, and two
times: the cylinders meet at **2.45 s** without friction and at **2.8 s** with μ = 0.2. The rest of
the geometry is **inferred** from its figures: the gap of 0.02 m between the bars, the box of
8 m × 8 m, and the centres (2, 4) and (6, 4) of the cylinders.

Energies are relative to the initial energy E₀ unless a unit is given.
"""


def main() -> None:
    """Run everything and write the page."""
    start = time.perf_counter()
    IMAGES.mkdir(parents=True, exist_ok=True)
    sections = [
        INTRODUCTION.format(version=carom.__version__),
        *(part.section() for part in (bars, layer, cylinders, conservation, dissipation, damping)),
    ]
    _, *kept = PAGE.read_text(encoding="utf-8").partition(KEPT)
    PAGE.write_text("\n".join(sections) + "\n" + "".join(kept), encoding="utf-8")
    print(f"wrote {PAGE.relative_to(ROOT)} in {time.perf_counter() - start:.0f} s")


if __name__ == "__main__":
    main()
