"""Imports of a crate and of a package go down, and nowhere in circles."""

import importlib
from pathlib import Path

import pytest
import tomlkit

ROOT = Path(__file__).parents[3]


@pytest.fixture
def check_rooms(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "tools")
    return importlib.import_module("check_rooms")


def written(folder, files):
    """Write files by path into a folder and return it."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return folder


@pytest.fixture
def package(check_rooms, tmp_path):
    """A package of three rooms, whose cellar knows the attic, and whose attic goes in a circle."""
    return check_rooms.python_house(
        written(
            tmp_path / "house",
            {
                "__init__.py": "from house.attic.roof import slate\n",
                "__main__.py": "from house.attic.roof import slate\n",
                "cellar.py": "def dig():\n    from house.attic import roof\n    return roof\n",
                "hall/__init__.py": "",
                "hall/door.py": "import house.cellar\nimport os\n",
                "attic/__init__.py": "",
                "attic/roof.py": "from house.attic.beam import oak\nfrom house.hall import door\n",
                "attic/beam.py": "from house.attic import roof\n",
            },
        )
    )


def test_a_package_has_an_arrow_upward_and_a_circle(check_rooms, package):
    assert check_rooms.complaints(package, ["cellar", "hall", "attic"]) == [
        "python: files in a circle: attic/beam.py, attic/roof.py, cellar.py, hall/door.py",
        "python: cellar.py imports attic/roof.py above it",
    ]
    assert check_rooms.complaints(package, None) == [
        "python: files in a circle: attic/beam.py, attic/roof.py, cellar.py, hall/door.py"
    ]
    assert ("attic", "hall") in package.room_arrows()


def test_what_only_type_checkers_import_is_no_arrow(check_rooms, tmp_path):
    house = check_rooms.python_house(
        written(
            tmp_path / "house",
            {
                "cellar.py": "from typing import TYPE_CHECKING\n\nif TYPE_CHECKING:\n"
                "    from house.hall import Door\n",
                "hall.py": "from house.cellar import stairs\n",
            },
        )
    )
    assert check_rooms.complaints(house, ["cellar", "hall"]) == []
    assert check_rooms.complaints(house, ["hall", "cellar"]) == [
        "python: hall.py imports cellar.py above it"
    ]


def test_rooms_are_those_of_the_list(check_rooms, package):
    circle, *rest = check_rooms.complaints(package, ["cellar", "attic", "tower"])
    assert "circle" in circle
    assert rest == [
        "python: rooms.toml and the folder differ in the room 'hall'",
        "python: rooms.toml and the folder differ in the room 'tower'",
    ]


def test_a_crate_has_an_arrow_upward_and_a_circle(check_rooms, tmp_path):
    """A name that a module hands on is of the file that it comes from; tests may import all."""
    crate = check_rooms.rust_house(
        "house",
        written(
            tmp_path / "src",
            {
                "lib.rs": "mod attic;\nmod cellar;\nmod hall;\npub use attic::Roof;\n",
                "cellar.rs": "// use crate::hall::Door;\nuse crate::attic::Roof;\n"
                "#[cfg(test)]\nmod tests {\n    use crate::hall::Door;\n}\n",
                "hall/mod.rs": "mod door;\npub use door::Door;\n",
                "hall/door.rs": "use std::fmt;\nfn f() { crate::cellar::dig() }\n",
                "attic/mod.rs": "mod beam;\nmod roof;\npub use roof::Roof;\n",
                "attic/roof.rs": "use super::beam::Beam;\n",
                "attic/beam.rs": "use super::Roof;\nuse crate::hall::{self, Door};\n",
            },
        ),
    )
    assert crate.arrows["cellar.rs"] == {"attic/roof.rs"}
    assert "hall/door.rs" in crate.arrows["attic/beam.rs"]
    circle, *upward = check_rooms.complaints(crate, ["cellar", "hall", "attic"])
    assert circle.startswith("house: files in a circle: attic/beam.rs, attic/roof.rs")
    assert upward == ["house: cellar.rs imports attic/roof.rs above it"]


def test_a_module_knows_what_it_uses_of_its_folder(check_rooms, tmp_path):
    """What it only hands on it does not know; who takes that, by however many hands, does."""
    files = {
        "lib.rs": "mod hall;\npub use hall::Door;\n",
        "hall/mod.rs": "mod door;\nmod wall;\npub use door::Door;\nuse wall::Wall;\n",
        "hall/door.rs": "pub struct Door;\n",
        "hall/wall.rs": "use crate::Door;\n",
    }
    crate = check_rooms.rust_house("house", written(tmp_path / "src", files))
    assert crate.arrows == {"hall/mod.rs": {"hall/wall.rs"}, "hall/wall.rs": {"hall/door.rs"}}
    files["hall/wall.rs"] = "use super::Lamp;\n"
    crate = check_rooms.rust_house("house", written(tmp_path / "src", files))
    assert check_rooms.complaints(crate, None) == [
        "house: files in a circle: hall/mod.rs, hall/wall.rs"
    ]


def test_the_rooms_of_carom_know_nothing_above_them(check_rooms, monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["check_rooms"])
    status = check_rooms.main()
    assert (status, capsys.readouterr().err) == (0, "")


def test_unit_tests_are_in_rooms_of_the_package(check_rooms):
    listed = tomlkit.parse(check_rooms.ROOMS.read_text(encoding="utf-8")).unwrap()["python"]
    rooms = {*listed, "benchmarks", "tools"}
    unit = ROOT / "tests" / "unit"
    assert {path.relative_to(unit).parts[0] for path in unit.rglob("test_*.py")} <= rooms
