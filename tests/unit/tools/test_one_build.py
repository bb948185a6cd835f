"""One build serves the wheel, the tests and the lints: crates have the same features in all."""

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


def features(*arguments):
    """Return every crate with its features, as cargo resolves them."""
    call = ["cargo", "tree", "--locked", "--prefix", "none", "--format", "{p} [{f}]", *arguments]
    told = subprocess.run(call, cwd=ROOT, capture_output=True, text=True, check=False)
    if told.returncode:
        pytest.skip(f"cargo does not resolve the crates here: {told.stderr[-200:]}")
    # A crate that was listed before has a mark, a procedural macro another.
    lines = {
        line.removesuffix(" (*)").replace(" (proc-macro)", "") for line in told.stdout.splitlines()
    }
    return {line for line in lines if line.endswith("]")}


@pytest.mark.skipif(shutil.which("cargo") is None, reason="without cargo there are no crates")
@pytest.mark.parametrize(
    "built", [["--package", "carom-python"], ["--workspace"]], ids=["wheel", "library for C"]
)
def test_the_wheel_and_the_library_for_c_are_built_of_the_crates_that_tests_have(built):
    """Symptom guarded against: faer, nalgebra and all of carom were compiled once for each."""
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    assert "CAROM_C_BUILT_WITH=--workspace $(MAKE) c" in makefile
    crates = features(*built, "--edges", "normal,build")
    tests = features("--workspace", "--edges", "all")
    assert len(crates) > 50
    assert crates - tests == set()
