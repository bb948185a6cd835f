"""Run every validation, long ones included, and rewrite docs/validation.md with its pictures.

    .venv/bin/python benchmarks/validate.py [PART …]

``make validate`` runs this. The cases and the measures are those of tests/validation; every section
of the page is made in `sections`, and is written as soon as it has been measured.
"""

from __future__ import annotations

import argparse
import re
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "validation"))

from same_sources import refuse_another_carom
from sections import (
    bars,
    beams,
    cohesion,
    conservation,
    cylinders,
    damping,
    dissipation,
    foreign,
    friction_laws,
    impacts,
    layer,
    massless,
    materials,
    robustness,
    springs,
    statics,
)
from sections.layout import IMAGES, PAGE, ROOT

import carom

PARTS = {
    "bars": bars.section,
    "layer": layer.section,
    "cylinders": cylinders.section,
    "conservation": conservation.section,
    "foreign bodies": foreign.section,
    "dissipation": dissipation.section,
    "damping": damping.section,
    "massless cylinders": massless.cylinders_section,
    "long runs": robustness.long_runs_section,
    "massless bars": massless.bars_section,
    "bouncing bar": massless.bounces_section,
    "massless layer": massless.layer_section,
    "loads": robustness.loads_section,
    "random scenes": robustness.random_scenes_section,
    "statics": statics.references_section,
    "ironing": statics.ironing_section,
    "static scenes": statics.scenes_section,
    "friction laws": friction_laws.section,
    "cohesion": cohesion.section,
    "springs": springs.section,
    "materials": materials.materials_section,
    "modes": materials.modes_section,
    "plates": impacts.plates_section,
    "beams": beams.beams_section,
    "throws": impacts.throws_section,
}
"""What the page consists of, in its order; each part begins with a heading of the second level."""

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
    """Run the parts that were asked for, or all, and write the page."""
    parser = argparse.ArgumentParser(description="Rewrite docs/validation.md.")
    parser.add_argument("parts", nargs="*", help=f"of {', '.join(PARTS)}; by default all")
    chosen = parser.parse_args().parts or list(PARTS)
    if unknown := set(chosen) - set(PARTS):
        parser.error(f"no part: {', '.join(unknown)}")
    refuse_another_carom()
    start = time.perf_counter()
    IMAGES.mkdir(parents=True, exist_ok=True)
    for name in chosen:
        section = PARTS[name]()  # Minutes; the page is read afterwards.
        PAGE.write_text(renewed(PAGE.read_text(encoding="utf-8"), section), encoding="utf-8")
    if chosen == list(PARTS):
        written = INTRODUCTION.format(version=carom.__version__)
        sections = headed(PAGE.read_text(encoding="utf-8"))
        PAGE.write_text("\n".join([written, *list(sections.values())[1:]]), encoding="utf-8")
    print(f"wrote {PAGE.relative_to(ROOT)} in {time.perf_counter() - start:.0f} s")


def renewed(page: str, section: str) -> str:
    """Return the page with one section replaced, or put at its end."""
    sections = headed(page)
    sections[section.partition("\n")[0]] = section
    return "\n".join(each.rstrip("\n") + "\n" for each in sections.values())


def headed(page: str) -> dict[str, str]:
    """Return the sections of a page by their headings; what comes first has none."""
    first, *rest = re.split(r"^(?=## )", page, flags=re.MULTILINE)
    return {"": first, **{each.partition("\n")[0]: each for each in rest}}


if __name__ == "__main__":
    main()
