"""Who wrote what a wheel links is named in it, with the licence under which it is used."""

import importlib
import importlib.metadata
import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
NOTICES = ROOT / "THIRD-PARTY-NOTICES.txt"


@pytest.fixture
def make_notices(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "tools")
    return importlib.import_module("make_notices")


def package(folder, licence, *, name="stranger", authors=()):
    return {
        "name": name,
        "version": "1.2.3",
        "license": licence,
        "repository": None,
        "authors": list(authors),
        "manifest_path": str(folder / "Cargo.toml"),
    }


def test_a_wheel_carries_the_notices():
    """Symptom guarded against: BSD-2-Clause and Apache-2.0 crates in a wheel without a word."""
    carried = [file for file in importlib.metadata.files("carom") if file.name == NOTICES.name]
    assert [file.parent.name for file in carried] == ["licenses"]
    assert carried[0].read_text(encoding="utf-8") == NOTICES.read_text(encoding="utf-8")


def test_notices_are_of_the_crates_that_are_linked(make_notices):
    if shutil.which("cargo") is None:
        pytest.skip("cargo is not there to say what is linked")
    linked = make_notices.crates()
    assert NOTICES.read_text(encoding="utf-8") == make_notices.text(linked)
    names = {crate.name for crate in linked}
    # The last two serve tests and the compiler.
    assert {"numpy", "nalgebra", "faer", "windows-sys", "std"} <= names
    assert names.isdisjoint({"proptest", "syn"})


def test_every_text_stands_once_below_those_who_use_it(make_notices):
    crate = make_notices.Crate
    same = ["Permission  is\nhereby granted", "Permission is hereby granted"]
    page = make_notices.text(
        [
            crate("one", "1.0", "MIT", "there", (same[0],)),
            crate("two", "2.0", "MIT", "there", (same[1], "ported from elsewhere")),
        ]
    )
    assert "\none 1.0, two 2.0\n" in page
    assert page.count("Permission") == 1
    assert page.index("two 2.0\n") < page.index("ported from elsewhere")


def test_of_a_choice_the_text_of_the_chosen_licence_is_taken(make_notices, tmp_path):
    mit = make_notices.permission("somebody")
    (tmp_path / "LICENSE-MIT").write_text(mit)
    (tmp_path / "LICENSE-APACHE").write_text("TERMS AND CONDITIONS FOR USE")
    for licence in ("MIT OR Apache-2.0", "MIT/Apache-2.0", "Apache-2.0 OR MIT"):
        assert make_notices.described(package(tmp_path, licence)).texts == (mit,)


def test_a_crate_without_a_text_gets_that_of_the_licence_it_names(make_notices, tmp_path):
    (tmp_path / "COPYING.PARTS.BSD").write_text("ported: Redistribution and use in source and ...")
    crate = make_notices.described(package(tmp_path, "MIT", authors=["A. Writer <a@b.org>"]))
    own, ported = crate.texts
    assert "Copyright (c) A. Writer\n" in own and "Permission is hereby granted" in own
    assert ported.startswith("ported")
    apache = make_notices.described(package(tmp_path, "Apache-2.0"))
    assert "TERMS AND CONDITIONS" in apache.texts[0]


def test_a_licence_that_nobody_has_decided_on_is_refused(make_notices, tmp_path):
    with pytest.raises(SystemExit, match=r"GPL-3\.0.*not one that carom has decided on"):
        make_notices.described(package(tmp_path, "GPL-3.0"))
    with pytest.raises(SystemExit, match="no text of BSD-2-Clause"):
        make_notices.described(package(tmp_path, "BSD-2-Clause"))
