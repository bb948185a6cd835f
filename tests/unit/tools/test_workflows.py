"""Workflows run what a contributor can run, by tools of known versions."""

import importlib
import os
import re
import sys
import tarfile
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
WORKFLOWS = sorted(ROOT.glob(".github/workflows/*.yml"))


@pytest.fixture(scope="module")
def release_check():
    sys.path.insert(0, str(ROOT / "tools"))
    try:
        return importlib.import_module("release_check")
    finally:
        sys.path.remove(str(ROOT / "tools"))


def text_of(name):
    return (ROOT / name).read_text(encoding="utf-8")


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda path: path.stem)
def test_actions_of_others_are_pinned_to_a_commit_whose_version_is_told(workflow):
    """A tag can be moved to other code; a commit cannot."""
    used = re.findall(r"uses: (.*)", workflow.read_text(encoding="utf-8"))
    assert used
    for action in used:
        assert re.fullmatch(r"[\w.-]+/[\w.-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+", action), action


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda path: path.stem)
def test_no_job_has_rights_that_it_does_not_name(workflow):
    text = workflow.read_text(encoding="utf-8")
    assert "\npermissions: {}\n" in text
    assert text.count("    permissions:\n") == text.count("    runs-on:")


def test_the_steps_that_workflows_name_are_there(release_check):
    named = re.findall(r"release_check\.py (.+)", text_of(".github/workflows/release.yml"))
    assert {step for steps in named for step in steps.split()} == set(release_check.STEPS)


def test_a_wheel_is_tried_on_every_python_that_the_package_names(release_check):
    project = text_of("pyproject.toml")
    named = re.findall(r"Programming Language :: Python :: 3\.(\d+)", project)
    assert list(map(int, named)) == list(release_check.MINORS)
    assert f'requires-python = ">=3.{named[0]}"' in project
    assert f"abi3-py3{named[0]}" in text_of("crates/carom-python/Cargo.toml")
    tried = re.search(
        r"python-version: \|\n((?: +3\.\d+\n)+)", text_of(".github/workflows/release.yml")
    )
    assert sorted(tried[1].split()) == [f"3.{minor}" for minor in named]


def test_the_tests_of_an_installed_wheel_are_there(release_check):
    assert [test for test in release_check.TESTS if not (ROOT / "tests" / test).exists()] == []


@pytest.mark.parametrize(
    ("found", "said"),
    [
        ({}, None),
        ({"overall_tag": "manylinux_2_17_x86_64"}, None),
        ({"overall_tag": "manylinux_2_34_x86_64"}, "it needs manylinux_2_34_x86_64"),
        ({"overall_tag": "linux_x86_64"}, "it needs linux_x86_64"),
        ({"external_libs": {"libblas.so.3": None}}, "it needs libblas.so.3, which systems may"),
        ({"unsupported_isa": True}, "it needs a newer processor"),
    ],
)
def test_a_wheel_that_promises_too_much_is_refused(release_check, found, said):
    """Symptom guarded against: a wheel of a new machine that older ones could not import."""
    plain = {"overall_tag": "manylinux_2_28_x86_64", "external_libs": {}, "unsupported_isa": False}
    name = "carom-0.1.0-cp310-abi3-manylinux_2_28_x86_64.whl"
    fault = release_check._promises_too_much(name, {**plain, **found})
    assert (fault is None) == (said is None)
    assert said is None or fault.startswith(said)


def test_unpacked_sources_are_newer_than_what_was_built_of_others(release_check, tmp_path):
    """Symptom guarded against: all files of an sdist are of 2006, and Cargo built none anew."""
    source = tmp_path / "carom-1.2.3" / "lib.rs"
    source.parent.mkdir()
    source.write_text("fn main() {}")
    os.utime(source, (1e9, 1e9))
    with tarfile.open(tmp_path / "carom.tar.gz", "w:gz") as archive:
        archive.add(source, "carom-1.2.3/lib.rs")
    before = time.time() - 60.0
    folder = release_check._unpack(tmp_path / "carom.tar.gz", tmp_path / "place")
    assert folder == tmp_path / "place" / "carom-1.2.3"
    assert (folder / "lib.rs").stat().st_mtime > before


def test_releases_are_built_by_the_maturin_of_development():
    (developing,) = re.findall(r'"maturin==([\d.]+)"', text_of("pyproject.toml"))
    (releasing,) = re.findall(r"(?m)^maturin==([\d.]+)", text_of("tools/release-requirements.txt"))
    assert developing == releasing


def test_a_rust_on_the_path_is_not_there_for_the_wheel(release_check, tmp_path, monkeypatch):
    """A wheel that is tried where Rust is could be one that only works where Rust is."""
    for name in ("rusty", "plain"):
        (tmp_path / name).mkdir()
    suffix = ".exe" if sys.platform == "win32" else ""
    cargo = tmp_path / "rusty" / f"cargo{suffix}"
    cargo.touch(mode=0o755)
    folders = [str(tmp_path / name) for name in ("rusty", "plain")]
    monkeypatch.setenv("PATH", release_check.os.pathsep.join(folders))
    monkeypatch.setenv("PYTHONPATH", "somewhere")
    kept = release_check._without_rust(tmp_path / "venv")
    assert kept["PATH"].split(release_check.os.pathsep) == [str(tmp_path / "venv"), folders[1]]
    assert "PYTHONPATH" not in kept
