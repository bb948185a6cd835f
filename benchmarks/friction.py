"""Compare the friction solvers on a folder of contact problems and rewrite docs/friction.md.

    .venv/bin/python benchmarks/friction.py FOLDER [time limit in s]

What ``carom friction bench FOLDER --against siconos`` runs; Siconos takes part where it is there.
"""

from __future__ import annotations

import sys
from pathlib import Path

from carom import InputError, friction
from carom.friction import bench

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "friction.md"
PICTURE = ROOT / "docs" / "images" / "friction-profile.png"

BEGIN, END = "<!-- comparison: begin -->", "<!-- comparison: end -->"
"""What is between them on the page is written here."""


def main(folder: Path, time_limit: float) -> None:
    """Run everything and put tables and picture where the page has them."""
    cases, refused = bench.read_cases(folder)
    for file, why in refused.items():
        print(f"left out: {file}: {why}")
    try:
        siconos = bench.Siconos.find()
    except InputError as error:
        print(error)
        siconos = None
    comparison = bench.compare(
        cases,
        friction.SOLVERS,
        tolerance=1e-8,
        time_limit=time_limit,
        siconos=siconos,
        observer=lambda run: print(f"{run.case}: {run.solver}: {run.status}", flush=True),
    )
    bench.draw_profile(comparison, PICTURE.parent).replace(PICTURE)
    picture = f"![Performance profiles of all solvers](images/{PICTURE.name})"
    PAGE.write_text(rewritten(PAGE.read_text(), f"{bench.markdown(comparison)}\n{picture}"))


def rewritten(page: str, comparison: str) -> str:
    """Return the page with the comparison between its marks."""
    before, rest = page.split(BEGIN)
    return f"{before}{BEGIN}\n{comparison}\n{END}{rest.split(END)[1]}"


if __name__ == "__main__":
    main(Path(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 10.0)
