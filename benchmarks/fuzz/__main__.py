"""Spoil input at random and print what was answered: ``python benchmarks/fuzz [COUNT] [SEED]``."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from fuzz.subjects import SUBJECTS
from fuzz.watch import search

SHARES = {
    "tables of cases": 0.7,
    "text of cases": 0.3,
    "meshes": 0.2,
    "contact problems": 0.1,
    "checkpoints": 0.05,
    "results": 0.05,
}
"""Attempts of each subject over `COUNT`, which counts case files."""


def main() -> None:
    """Search and print; exit status 1 if there is a defect."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("count", nargs="?", type=int, default=100_000, help="case files")
    parser.add_argument("seed", nargs="?", type=int, default=0, help="first seed")
    parser.add_argument("--only", choices=SUBJECTS, help="one subject alone")
    options = parser.parse_args()
    found = 0
    for subject in [options.only] if options.only else SUBJECTS:
        start = time.perf_counter()
        count = round(SHARES[subject] * options.count)
        tally = search(subject, range(options.seed, options.seed + count))
        answers = ", ".join(f"{n} {what}" for what, n in sorted(tally.outcomes.items()))
        print(f"{subject}: {count} in {time.perf_counter() - start:.0f} s: {answers}", flush=True)
        for seed, text in tally.defects.items():
            print(f"  seed {seed}: {text}", flush=True)
        found += len(tally.defects)
    print(f"{found} defects")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
