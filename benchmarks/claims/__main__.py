"""Measure every number of the documentation again and say which drifted.

    .venv/bin/python benchmarks/claims [--page PAGE …] [--run NAME …] [--write] [--bare PAGE]

``claims.toml`` has the numbers, the pages on which they stand, what measures them and what they may
be off by. A drift of physics, of a count or of a bound ends with exit status 1; timings are told as
ratios and never fail. What was measured is kept in ``measured.json``, with the machine.
``--write`` puts what was measured where a number drifted, on its page and in ``claims.toml``, so
that a reviewer sees the change. ``--bare`` lists the numbers of a page that are in no claim.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "validation"))

from same_sources import refuse_another_carom

import carom
from claims.judge import Verdict, judged
from claims.manifest import MANIFEST, MEASURED, Manifest
from claims.pages import ROOT, Page
from claims.rewriting import changes, claimed, rewritten
from claims.runs import MissingError, measure, values

RECORD = Path(__file__).resolve().parents[1] / "measured.json"


def main() -> int:
    """Run what was asked for, or everything."""
    manifest = Manifest.read()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--page", action="append", choices=manifest.pages, help="only this page")
    parser.add_argument("--run", action="append", choices=list(manifest.runs), help="only this run")
    parser.add_argument("--write", action="store_true", help="correct the pages where they drifted")
    parser.add_argument("--bare", choices=manifest.pages, help="list numbers in no claim")
    options = parser.parse_args()
    if options.bare:
        print(*manifest.bare(options.bare), sep="\n")
        return 0
    refuse_another_carom()
    verdicts, troubles = [], []
    for name, run in manifest.runs.items():
        claims = [
            claim
            for claim in manifest.claims
            if claim.run == name and (not options.page or claim.page in options.page)
        ]
        if not claims or (options.run and name not in options.run):
            continue
        start = time.perf_counter()
        try:
            output = measure(run)
        except MissingError as error:
            print(f"not run  {name}: {error}", flush=True)
            continue
        except subprocess.CalledProcessError as error:
            troubles.append(f"{name}: {error}")
            continue
        print(f"{time.perf_counter() - start:6.1f} s  {name}", flush=True)
        for claim in claims:
            try:
                verdicts += judged(claim, values(claim, output))
            except ValueError as error:
                troubles.append(f"{claim.page}: “{claim.plain}”: {error}")
    status = told(manifest, verdicts, troubles)
    if options.write:
        write(manifest, verdicts)
    return status


def write(manifest: Manifest, verdicts: list[Verdict]) -> None:
    """Correct the pages where they drifted, and the claims with them."""
    claims = MANIFEST.read_text(encoding="utf-8")
    for name in manifest.pages:
        page = Page.read(name)
        done = changes(page, [verdict for verdict in verdicts if verdict.claim.page == name])
        if not done:
            continue
        for claim in manifest.claims:
            if claim.page == name:
                new = claimed(claim, page, done)
                claims = claims.replace(f'"{claim.text}"', f'"{new}"')
        (ROOT / name).write_text(rewritten(page, done), encoding="utf-8")
        print(f"{name}: {len(done)} numbers corrected")
    MANIFEST.write_text(claims, encoding="utf-8")


def told(manifest: Manifest, verdicts: list[Verdict], troubles: list[str]) -> int:
    """Keep what was measured, say what drifted, and return the exit status."""
    kept = json.loads(RECORD.read_text(encoding="utf-8")) if RECORD.exists() else {}
    machine = f"{platform.machine()}, {os.cpu_count()} cores"
    now: dict[str, dict[str, Any]] = {}
    for verdict in verdicts:
        entry = now.setdefault(
            f"{verdict.claim.page}: {verdict.claim.plain}",
            {"said": [], "measured": [], "version": carom.__version__, "machine": machine},
        )
        entry["said"].append(verdict.number.shown)
        entry["measured"].append(float(f"{verdict.measured:.6g}"))
    kept.update(now)
    claimed = {f"{claim.page}: {claim.plain}" for claim in manifest.claims}
    kept = {text: entry for text, entry in kept.items() if text in claimed}
    lines = (
        f"{json.dumps(text, ensure_ascii=False)}: {json.dumps(entry, ensure_ascii=False)}"
        for text, entry in sorted(kept.items())
    )
    RECORD.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
    timings = [verdict for verdict in verdicts if verdict.claim.kind == "timing"]
    drifted = [verdict for verdict in verdicts if not verdict.holds]
    if timings:
        print("Timings, which depend on the machine:", *timings, sep="\n  ")
    if drifted:
        print("Drifted:", *drifted, sep="\n  ")
    if troubles:
        print("Not measured:", *troubles, sep="\n  ")
    bare = sum(len(manifest.bare(page)) for page in manifest.pages)
    total = sum(len(c.numbers) for c in manifest.claims if c.kind in MEASURED)
    print(
        f"{len(verdicts)} of {total} numbers measured, {len(drifted)} drifted, "
        f"{len(troubles)} claims without an answer; {bare} numbers of the pages are in no claim"
    )
    return 1 if drifted or troubles else 0


if __name__ == "__main__":
    sys.exit(main())
