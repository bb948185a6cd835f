"""Make deliberate errors, one by one, and see whether the tests notice.

``python benchmarks/mutants`` takes an hour on two cores. Every error of ``mutants.toml`` is made in
a copy of the tree; the tests of the crates run first, then those of Python with the package built
anew. ``--only WORD`` makes those with the word in name or file, ``--rest`` those that have no
verdict yet; ``--write`` writes the table into docs/reliability.md.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter

import tomlkit

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
RESULTS = HERE / "results.json"
PAGE = ROOT / "docs" / "reliability.md"
BEGIN, END = "<!-- mutants: begin -->", "<!-- mutants: end -->"

QUICK = {"CARGO_PROFILE_RELEASE_INCREMENTAL": "true"}
"""Compiles a changed crate in a fraction of the time."""

LIMIT = 1800.0
"""Seconds after which a test program counts as killed: it hangs."""


@dataclass(frozen=True)
class Mutant:
    """A deliberate error: what to replace in which file."""

    name: str
    file: str
    find: str
    replace: str

    @property
    def crate(self) -> str | None:
        """The crate that has the code; None for Python."""
        parts = Path(self.file).parts
        return parts[1] if parts[0] == "crates" else None

    def make(self, tree: Path) -> str:
        """Make the error in a tree; return what the file was.

        Raises
        ------
        SystemExit
            What to replace does not stand exactly once in the file.
        """
        path = tree / self.file
        text = path.read_text(encoding="utf-8")
        if text.count(self.find) != 1:
            sys.exit(
                f"{self.name}: {self.find!r} stands {text.count(self.find)} times in {self.file}"
            )
        path.write_text(text.replace(self.find, self.replace), encoding="utf-8")
        return text


@dataclass(frozen=True)
class Verdict:
    """What became of a mutant: who noticed, which test first, and how many seconds it took."""

    name: str
    file: str
    killed_by: str
    test: str
    seconds: float


def mutants() -> list[Mutant]:
    """Return the list of ``mutants.toml``."""
    listed = tomlkit.parse((HERE / "mutants.toml").read_text(encoding="utf-8")).unwrap()
    return [Mutant(**entry) for entry in listed["mutant"]]


def judge(mutant: Mutant, tree: Path, target: Path) -> Verdict:
    """Make an error in a copy of the tree, see who notices, and take it back."""
    start = perf_counter()
    before = mutant.make(tree)
    try:
        by, test = _judge(mutant, tree, target)
    finally:
        (tree / mutant.file).write_text(before, encoding="utf-8")
    return Verdict(mutant.name, mutant.file, by, test, round(perf_counter() - start, 1))


def _judge(mutant: Mutant, tree: Path, target: Path) -> tuple[str, str]:
    environment = {**os.environ, **QUICK, "CARGO_TARGET_DIR": str(target)}
    if mutant.crate is not None:
        base = ["cargo", "test", "--release", "--locked", "--lib", "--tests", "--no-fail-fast"]
        # The crate itself first: the others take long to build. None of them knows the topmost.
        others = [] if mutant.crate == "carom" else [["--workspace", "--exclude", "carom-python"]]
        for packages in (["-p", mutant.crate], *others):
            code, said = _run([*base, *packages], tree, environment)
            if code is None:
                return mutant.crate, "does not end"
            if code != 0:
                failed = _failed(said)
                if not failed:
                    sys.exit(f"{mutant.name} does not compile:\n{said[-3000:]}")
                return failed[0]
    own = tree / ".mutant-venv"
    if not own.exists():
        subprocess.run(["cp", "-r", str(ROOT / ".venv"), str(own)], check=True)
    python = own / "bin" / "python"
    code, said = _run([str(python), "-m", "pip", "install", "--quiet", "."], tree, environment)
    if code != 0:
        sys.exit(f"{mutant.name}: the package does not build:\n{said[-3000:]}")
    # The test of this list sees every error, where its text no longer stands.
    own = "tests/unit/benchmarks/test_mutants.py"
    tests = [str(python), "-m", "pytest", "-x", "-q", "--ignore", own]
    code, said = _run(tests, tree, environment)
    if code == 0:
        return "nobody", ""
    if code is None:
        return "Python", "does not end"
    failed = re.findall(r"(?m)^FAILED (\S+)", said)
    if not failed:
        sys.exit(f"{mutant.name}: the tests do not run:\n{said[-3000:]}")
    return "Python", failed[0]


def _failed(said: str) -> list[tuple[str, str]]:
    """Return the crates and names of tests that failed, in the order in which they ran."""
    crate, failed = "", []
    for line in said.splitlines():
        if doing := re.match(r"\s+Running (\S+) .*/(\w+)-[0-9a-f]+\)", line):
            # Programs of unit tests are named after their crate; the others follow these.
            crate = doing[2].replace("_", "-") if doing[1] == "unittests" else crate
        elif test := re.match(r"test (\S+) .*FAILED$", line):
            failed.append((crate, test[1]))
    return failed


def _run(command: Sequence[str], tree: Path, environment: dict[str, str]) -> tuple[int | None, str]:
    """Run a command; return its exit status, None if it had to be stopped, and what it said."""
    try:
        done = subprocess.run(
            command,
            cwd=tree,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=LIMIT,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return None, ""
    return done.returncode, done.stdout


def _built(folder: str, names: list[str]) -> set[str]:
    """Return what of a folder is no source."""
    at_top = {".git", ".venv", "target", "results", "site"} if Path(folder) == ROOT else set()
    return {name for name in names if name in at_top or name.endswith(".so")}


def table(verdicts: Sequence[Verdict]) -> str:
    """Return the verdicts as a table in Markdown."""
    rows = ["| error | in | noticed by | first test |", "| --- | --- | --- | --- |"]
    for v in verdicts:
        where, test = f"[{Path(v.file).name}](../{v.file})", f"`{v.test}`" if v.test else ""
        rows.append(f"| {v.name} | {where} | {v.killed_by} | {test} |")
    return "\n".join(rows)


def write(verdicts: Sequence[Verdict]) -> None:
    """Put the table into docs/reliability.md."""
    page = PAGE.read_text(encoding="utf-8")
    head, rest = page.split(BEGIN)
    _, tail = rest.split(END)
    PAGE.write_text(f"{head}{BEGIN}\n{table(verdicts)}\n{END}{tail}", encoding="utf-8")


def main() -> int:
    """Judge the mutants; the exit status is 1 if one survives."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--only", metavar="WORD", default="", help="those with this word in name or file"
    )
    parser.add_argument("--rest", action="store_true", help="those without a verdict")
    parser.add_argument("--write", action="store_true", help="write the table into the docs")
    options = parser.parse_args()
    known = (
        {v["name"]: Verdict(**v) for v in json.loads(RESULTS.read_text())}
        if RESULTS.exists()
        else {}
    )
    listed = mutants()
    with tempfile.TemporaryDirectory(prefix="carom-mutants-") as place:
        tree = Path(place) / "tree"
        shutil.copytree(ROOT, tree, ignore=_built)
        target = ROOT / "target" / "mutants"
        for mutant in listed:
            if options.only.lower() not in f"{mutant.name} {mutant.file}".lower():
                continue
            if options.rest and mutant.name in known:
                continue
            verdict = judge(mutant, tree, target)
            known[mutant.name] = verdict
            print(
                f"{verdict.name}: {verdict.killed_by} {verdict.test} ({verdict.seconds:.0f} s)",
                flush=True,
            )
            current = [known[m.name] for m in listed if m.name in known]
            RESULTS.write_text(json.dumps([asdict(v) for v in current], indent=1) + "\n")
    verdicts = [known[m.name] for m in listed if m.name in known]
    if options.write:
        write(verdicts)
    survivors = [v for v in verdicts if v.killed_by == "nobody"]
    print(f"{len(verdicts)} errors, {len(survivors)} not noticed")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
