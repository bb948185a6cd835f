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
def test_the_wheel_is_built_of_crates_with_the_features_that_they_have_in_tests():
    """Symptom guarded against: faer, nalgebra and all of carom were compiled once for each."""
    wheel = features("--package", "carom-python", "--edges", "normal,build")
    tests = features("--workspace", "--edges", "all")
    assert len(wheel) > 50
    assert wheel - tests == set()
