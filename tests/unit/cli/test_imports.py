"""What is imported, and when: nobody likes to wait for a command to say what it can do."""

import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import carom
from carom import cli

SLOW = {"h5py", "matplotlib", "meshio", "pydantic", "pyvista", "scipy"}
"""Packages that take long to import."""


def imported(code):
    """Return which slow packages a fresh process has imported after some code."""
    done = subprocess.run(
        [sys.executable, "-c", f"{code}\nimport sys; print(*sys.modules)"],
        capture_output=True,
        text=True,
        check=True,
    )
    return SLOW & set(done.stdout.splitlines()[-1].split())


def command(*words):
    """Return the code of a command."""
    return f"from carom.cli import app\napp({list(map(str, words))}, standalone_mode=False)"


@pytest.mark.parametrize("code", ["import carom", command("--help"), command("--version")])
def test_neither_carom_nor_its_help_imports_what_takes_long(code):
    assert imported(code) == set()


def test_a_run_imports_no_more_than_it_needs(examples):
    assert imported(command("check", examples / "two_cylinders.toml")) == {"pydantic"}
    assert imported("from carom import Scenario, run") == {"h5py", "pydantic"}


def test_every_public_name_is_found():
    stub = Path(carom.__file__).with_suffix(".pyi").read_text(encoding="utf-8")
    assert len(carom.__all__) == stub.count(" import ")
    assert sorted(carom._HOME_OF) == carom.__all__
    assert set(carom.__all__) <= set(dir(carom))
    for name, home in carom._HOME_OF.items():
        assert getattr(carom, name) is getattr(import_module(home), name)
    with pytest.raises(AttributeError, match="no attribute 'Disk'"):
        carom.Disk  # noqa: B018 (looking is what is tested)


def test_names_are_functions_however_they_are_reached():
    """A module of the same name would take their place as soon as it is imported."""
    for name in ("audit", "check", "run"):
        assert imported(f"import carom.auditing.report\nassert callable(carom.{name})")


@pytest.mark.parametrize("name", cli.COMMANDS)
def test_the_list_of_commands_says_what_their_help_says(name):
    assert " ".join(cli.command(name).help.split("\n\n")[0].split()) == cli.COMMANDS[name]
