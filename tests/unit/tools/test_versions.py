"""One version everywhere: the place it comes from, and those that say it again."""

import importlib
import importlib.metadata
import shutil
import sys
from pathlib import Path

import pytest

import carom

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def versions():
    sys.path.insert(0, str(ROOT / "tools"))
    try:
        return importlib.import_module("versions")
    finally:
        sys.path.remove(str(ROOT / "tools"))


@pytest.fixture
def copy(versions, tmp_path):
    """The files that state the version, to be spoilt."""
    for file in {file for file, _ in versions.PLACES}:
        shutil.copy(ROOT / file, tmp_path)
    return tmp_path


def spoil(file, old, new):
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), encoding="utf-8")


def test_all_places_state_the_version_of_the_package(versions):
    assert versions.disagreements() == []
    assert {version for _, version in versions.stated()} == {carom.__version__}


def test_every_crate_inherits_the_version():
    manifests = list(ROOT.glob("crates/*/Cargo.toml"))
    assert len(manifests) > 5
    for manifest in manifests:
        assert "version.workspace = true" in manifest.read_text(encoding="utf-8"), manifest
    assert 'dynamic = ["version"]' in (ROOT / "pyproject.toml").read_text(encoding="utf-8")


def test_every_place_that_says_another_version_is_named(versions, copy):
    spoil(copy / "CITATION.cff", f"version: {carom.__version__}", "version: 9.9.9")
    spoil(
        copy / "Cargo.lock",
        f'"carom-fem"\nversion = "{carom.__version__}"',
        '"carom-fem"\nversion = "8.8.8"',
    )
    places = [line.split(":")[0] for line in versions.disagreements(copy)]
    assert places == ["Cargo.lock", "CITATION.cff"]


def test_a_place_that_no_longer_states_a_version_is_told(versions, copy):
    spoil(copy / "CITATION.cff", "\nversion: ", "\nrelease: ")
    with pytest.raises(SystemExit, match=r"CITATION\.cff: no version is where it was"):
        versions.stated(copy)


def test_a_new_version_is_written_everywhere_and_to_nothing_else(versions, copy):
    before = {file.name: file.read_text(encoding="utf-8") for file in copy.iterdir()}
    places = len(versions.stated(copy))
    versions.state("12.3.4", copy)
    assert [version for _, version in versions.stated(copy)] == ["12.3.4"] * places
    for name in ("CITATION.cff", "Cargo.lock", "Cargo.toml"):
        text = (copy / name).read_text(encoding="utf-8")
        changed = [
            pair
            for pair in zip(before[name].splitlines(), text.splitlines(), strict=True)
            if len({*pair}) > 1
        ]
        assert changed
        for old, new in changed:
            assert new == old.replace(carom.__version__, "12.3.4")
    news = (copy / "CHANGELOG.md").read_text(encoding="utf-8")
    assert news.replace("## [12.3.4] – unreleased\n\n", "") == before["CHANGELOG.md"]


def test_a_version_is_three_numbers(versions, copy):
    with pytest.raises(SystemExit, match=r"2\.0: versions are three numbers"):
        versions.state("2.0", copy)


def test_a_tag_is_released_only_with_its_version_and_a_day(versions, copy):
    version = carom.__version__
    assert "the tag is v0.0.7" in versions.unready("v0.0.7", copy)[0]
    log = copy / "CHANGELOG.md"
    spoil(log, f"## [{version}] – ", f"## [{version}] – soon, and not ")
    (fault,) = versions.unready(f"v{version}", copy)
    assert fault.startswith("CHANGELOG.md: give the day of the release")
    log.write_text(
        f"# Changelog\n\n## [{version}] – 2026-12-24\n\n- New.\n\n## [0.0.1] – 2026-01-01\n",
        "utf-8",
    )
    assert versions.unready(f"v{version}", copy) == []
    assert versions.news(copy) == "- New."
