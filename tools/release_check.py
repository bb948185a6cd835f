"""See whether a release would work, by what can be run on one machine: ``make release-check``.

The steps, in their order; those that are named are run, without names all are:

- ``versions``: all places that state the version agree.
- ``sdist``: the sources are packed, and their package can be prepared by pip.
- ``wheel``: the wheel is built from what was packed, not from the checkout; on Linux by a linker
  that knows the glibc of old systems, which maturin checks.
- ``audit``: auditwheel says whether a Linux wheel needs no more than its name promises.
- ``installed``: for every Python from 3.10 to 3.13 that is found, the wheel is installed in a fresh
  environment without Rust on the path; outside the checkout a case is run to its report, an example
  asserts its numbers, and tests pass.
- ``crates``: every crate is packaged, and built from its package and those of the ones it needs.

What is made is in ``target/release-check``, packages for the registries in its ``dist``. Nothing is
published. The workflows of ``.github`` run the same steps on other systems.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tarfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import versions

ROOT = versions.ROOT
HERE = ROOT / "target" / "release-check"
DIST, SOURCES, TOOLS = HERE / "dist", HERE / "sources", HERE / "tools"

MANYLINUX = "manylinux_2_28"
"""The oldest systems that a Linux wheel is for: glibc 2.28, of 2018, as NumPy's own wheels."""

MINORS = range(10, 14)
"""Of Python 3, for which there is one wheel (abi3)."""

TESTS = (
    "unit/building/test_core_refusals.py",
    "unit/case/test_overrides.py",
    "unit/case/test_scenario.py",
    "unit/cli/test_cli.py",
    "unit/contact/test_contact.py",
    "unit/friction/test_solve.py",
    "unit/io/test_history.py",
    "unit/io/test_summary_types.py",
    "unit/results/test_notebook.py",
    "unit/running/test_simulation.py",
    "test_determinism.py",
)
"""What is tried of an installed wheel: every door to the core, without extras, in a minute."""

TEST_TOOLS = ("pytest", "hypothesis")
"""Packages that these tests need: the newest that each Python has."""

RUST = ("cargo", "rustc")

Environment = Mapping[str, str]


def check_versions() -> None:
    """Refuse places that state another version than the workspace."""
    if faults := versions.disagreements():
        raise SystemExit("\n".join(faults))
    print(f"version {versions.stated()[0][1]}")


def pack_sources() -> None:
    """Make the sdist, and see that pip can prepare what it packs."""
    _clean(DIST, SOURCES)
    _run(_tool("maturin"), "sdist", "--out", str(DIST))
    (packed,) = DIST.glob("*.tar.gz")
    _run(_tool("python"), "-m", "pip", "install", "--quiet", "--dry-run", "--no-deps", str(packed))
    print(f"{packed.name}: {packed.stat().st_size / 1e6:.1f} MB")


def build_wheel() -> None:
    """Build the wheel from the sdist."""
    (packed,) = DIST.glob("*.tar.gz")
    _clean(SOURCES)
    sources = _unpack(packed, SOURCES)
    for old in DIST.glob("*.whl"):
        old.unlink()
    linux = sys.platform == "linux"
    _run(
        *(_tool("maturin"), "build", "--release", "--out", str(DIST)),
        *(("--zig", "--compatibility", MANYLINUX) if linux else ()),
        folder=sources,
        environment={
            **os.environ,
            "PATH": os.pathsep.join((str(_programs(TOOLS)), os.environ["PATH"])),
            "CARGO_TARGET_DIR": os.environ.get("CARGO_TARGET_DIR", str(ROOT / "target")),
            "SOURCE_DATE_EPOCH": _last_commit(),
            "RUSTFLAGS": f"--remap-path-prefix={_cargo_home()}=/cargo",
        },
    )
    _see_what_was_locked(sources)
    (wheel,) = DIST.glob("*.whl")
    print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.1f} MB")


def audit_wheel() -> None:
    """Refuse a wheel that needs a newer system than its name says, by auditwheel."""
    (wheel,) = DIST.glob("*.whl")
    if sys.platform != "linux":
        print("auditwheel knows Linux only")
        return
    found = json.loads(_said(_tool("auditwheel"), "show", "--json", str(wheel)))
    print(f"{found['overall_tag']}, built with {' '.join(platform.libc_ver())}")
    if (fault := _promises_too_much(wheel.name, found)) is not None:
        raise SystemExit(f"{wheel.name}: {fault}")


def try_installed() -> None:
    """Install the wheel for every Python that is found, and use it."""
    (wheel,) = DIST.glob("*.whl")
    tried = 0
    for minor in MINORS:
        python = _python(minor)
        if python is None:
            print(f"Python 3.{minor} is not here: not tried")
            continue
        _try(wheel, minor, python)
        tried += 1
    if not tried:
        raise SystemExit("no Python was found on which the wheel could be tried")


def package_crates() -> None:
    """Package every crate that is published, and build each from its package."""
    _run("cargo", "package", "--workspace", "--exclude", "carom-python", "--locked", *_dirty())
    for manifest in sorted(ROOT.glob("crates/*/Cargo.toml")):
        if "publish = false" in manifest.read_text(encoding="utf-8"):
            continue
        name = manifest.parent.name
        listed = _said("cargo", "package", "--list", "--package", name, *_dirty()).split()
        if missing := {"LICENSE-APACHE", "LICENSE-MIT", "README.md", "src/lib.rs"} - set(listed):
            raise SystemExit(f"{name}: its package lacks {', '.join(sorted(missing))}")
        print(f"{name}: {len(listed)} files")


STEPS: dict[str, Callable[[], None]] = {
    "versions": check_versions,
    "sdist": pack_sources,
    "wheel": build_wheel,
    "audit": audit_wheel,
    "installed": try_installed,
    "crates": package_crates,
}


def _try(wheel: Path, minor: int, python: str) -> None:
    """Install a wheel in a fresh environment, and use it from a folder that is no checkout."""
    place = HERE / f"python3.{minor}"
    _clean(place)
    place.mkdir()
    start = time.perf_counter()
    _run(python, "-m", "venv", str(place / "venv"))
    programs = _programs(place / "venv")
    environment = _without_rust(programs)
    own = str(programs / "python")
    use = {"folder": place, "environment": environment}
    _run(own, "-m", "pip", "install", "--quiet", str(wheel), **use)
    carom = str(programs / "carom")
    _run(carom, "new", "two-bodies", **use)
    _run(carom, "run", "two-bodies.toml", "--out", "run", "--set", "output.report=true", **use)
    if not (place / "run" / "report.html").exists():
        raise SystemExit("the run has left no report")
    print(f"Python 3.{minor}: from the wheel to a report in {time.perf_counter() - start:.0f} s")
    _see_where_it_is(own, place, environment)
    for name in ("examples", "tests"):
        shutil.copytree(ROOT / name, place / name)
    shutil.copy(ROOT / "pyproject.toml", place)
    _run(own, "examples/two_bars.py", "--out", "bars", **use)
    _run(own, "-m", "pip", "install", "--quiet", *TEST_TOOLS, **use)
    tests = [f"tests/{test}" for test in TESTS]
    _run(own, "-m", "pytest", "-p", "no:cacheprovider", *tests, **use)


def _see_where_it_is(python: str, place: Path, environment: Environment) -> None:
    """Refuse a package that is not the installed one, or an environment that has Rust."""
    code = (
        "import carom, shutil; print(carom.__version__, carom.__file__, "
        f"*filter(None, map(shutil.which, {RUST})))"
    )
    version, file, *rust = _said(python, "-c", code, folder=place, environment=environment).split()
    if version != versions.stated()[0][1] or not Path(file).is_relative_to(place):
        raise SystemExit(f"what was tried is carom {version} of {file}, not the wheel")
    if rust:
        raise SystemExit(f"what was tried could have used {rust[0]}")


def _unpack(packed: Path, place: Path) -> Path:
    """Unpack an sdist and return its folder; its files are of now.

    Cargo tells by times what has changed. In an sdist all files have one of long ago, so that it
    would take what it built from another.
    """
    with tarfile.open(packed) as archive:
        archive.extractall(place, filter="data")
    for file in place.rglob("*"):
        os.utime(file)
    (folder,) = place.iterdir()
    return folder


def _see_what_was_locked(sources: Path) -> None:
    """Refuse crates of other versions than ours.

    The sdist has no carom-c, so that Cargo takes lines out of the lock, and ``--locked`` would not
    let it.
    """
    locked = re.compile(r'name = "(.+)"\nversion = "(.+)"')
    ours, theirs = (
        set(locked.findall((folder / "Cargo.lock").read_text(encoding="utf-8")))
        for folder in (ROOT, sources)
    )
    if others := theirs - ours:
        raise SystemExit(f"the wheel has other crates than Cargo.lock names: {sorted(others)}")


def _promises_too_much(wheel: str, found: Mapping[str, Any]) -> str | None:
    """Return what a wheel needs beyond its name, by what auditwheel found; None if nothing."""
    promised, needed = (
        re.search(r"manylinux_2_(\d+)", tag) for tag in (wheel, found["overall_tag"])
    )
    if promised is None or needed is None or int(needed[1]) > int(promised[1]):
        return f"it needs {found['overall_tag']}"
    if found["external_libs"]:
        return f"it needs {', '.join(found['external_libs'])}, which systems may not have"
    return "it needs a newer processor" if found["unsupported_isa"] else None


def _python(minor: int) -> str | None:
    """Return a Python of this version that runs, or None."""
    name = f"python3.{minor}"
    root = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
    own = [sys.executable] if sys.version_info[:2] == (3, minor) else []
    others = sorted(map(str, root.glob(f"versions/3.{minor}.*/bin/{name}")))
    for python in [*own, *filter(None, [shutil.which(name)]), *others]:
        # A name on the path may stand for a Python that was never chosen.
        command = (python, "-c", "import sys, venv; print(sys.version_info[1])")
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode == 0 and done.stdout.strip() == str(minor):
            return python
    return None


def _without_rust(programs: Path) -> dict[str, str]:
    """Return the environment with these programs first, and without folders that have Rust."""
    folders = [
        folder
        for folder in os.environ["PATH"].split(os.pathsep)
        if not any(shutil.which(program, path=folder) for program in RUST)
    ]
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    return {**kept, "PATH": os.pathsep.join([str(programs), *folders])}


def _last_commit() -> str:
    """Return the time that files of packages have, so that the same sources make the same bytes."""
    return os.environ.get("SOURCE_DATE_EPOCH") or _said("git", "log", "-1", "--format=%ct")


def _dirty() -> list[str]:
    """Return what lets Cargo package files that are not committed, which this only tries."""
    return ["--allow-dirty"] if _said("git", "status", "--porcelain") else []


def _cargo_home() -> Path:
    return Path(os.environ.get("CARGO_HOME", Path.home() / ".cargo"))


def _programs(environment: Path) -> Path:
    return environment / ("Scripts" if os.name == "nt" else "bin")


def _tool(name: str) -> str:
    """Return a program of the environment of tools, which is made where it is not there."""
    wanted = (ROOT / "tools" / "release-requirements.txt").read_text(encoding="utf-8")
    had = TOOLS / "requirements.txt"
    if not had.exists() or had.read_text(encoding="utf-8") != wanted:
        _clean(TOOLS)
        _run(sys.executable, "-m", "venv", str(TOOLS))
        pip = (str(_programs(TOOLS) / "python"), "-m", "pip", "install", "--quiet")
        _run(*pip, "-r", str(ROOT / "tools" / "release-requirements.txt"))
        had.write_text(wanted, encoding="utf-8")
    return str(_programs(TOOLS) / name)


def _clean(*folders: Path) -> None:
    for folder in folders:
        shutil.rmtree(folder, ignore_errors=True)


def _run(*command: str, folder: Path = ROOT, environment: Environment = os.environ) -> None:
    """Run a program; what it says is shown, and its failure is ours."""
    print("+", *(part.replace(f"{ROOT}{os.sep}", "") for part in command), flush=True)
    done = subprocess.run(command, cwd=folder, env=environment, check=False)
    if done.returncode:
        raise SystemExit(f"{command[0]} ended with status {done.returncode}")


def _said(*command: str, folder: Path = ROOT, environment: Environment = os.environ) -> str:
    """Run a program and return what it says."""
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise SystemExit(f"{command[0]} ended with status {done.returncode}: {done.stderr}")
    return done.stdout.strip()


def main() -> int:
    """Run the script."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("steps", nargs="*", metavar="STEP", help=", ".join(STEPS))
    wanted = parser.parse_args().steps or list(STEPS)
    if unknown := sorted(set(wanted) - set(STEPS)):
        parser.error(f"{unknown[0]}: no such step; there are {', '.join(STEPS)}")
    HERE.mkdir(parents=True, exist_ok=True)
    for name in (name for name in STEPS if name in wanted):
        start = time.perf_counter()
        print(f"== {name}", flush=True)
        STEPS[name]()
        print(f"== {name} took {time.perf_counter() - start:.0f} s", flush=True)
    print(f"done: {', '.join(wanted)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
