"""Press fits against Lamé's closed form, and what it takes to pull the shaft out.

A solid shaft of 20 mm is fitted into a hub of 20 to 40 mm, both of steel and held along the axis,
in three ways: by the interference of the pair, by meshes that overlap at the start, by growth of
the shaft. The pressure is the normal force over the area of the fit.

.venv/bin/python benchmarks/press_fit.py
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "validation"))

import press_fits
from sections.layout import table


def pressures() -> str:
    """Return the table of the pressures."""
    rows = []
    for shape, divisions in (("slice", (8, 16, 32)), ("revolution", (4, 8, 16))):
        for discretisation in press_fits.DISCRETISATIONS:
            for way in press_fits.WAYS:
                fits = [press_fits.fit(shape, way, discretisation, n) for n in divisions]
                errors = [f"{100 * fit.error:+.3f} %" for fit in fits]
                rows.append((f"{shape}, {discretisation}", way, *errors))
    return table(("fit", "by", "coarse", "middle", "fine"), rows)


def pulls() -> str:
    """Return the table of the forces that pull the shaft out."""
    rows = []
    for discretisation in press_fits.DISCRETISATIONS:
        for way in press_fits.WAYS:
            pull = press_fits.pull(way, discretisation, 16)
            rows.append((discretisation, way, f"{pull.force:.1f} N", f"{100 * pull.error:+.3f} %"))
    return table(("discretisation", "by", "force", "off μ p A"), rows)


if __name__ == "__main__":
    print(pressures())
    print()
    print(pulls())
