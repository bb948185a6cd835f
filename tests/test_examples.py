"""The examples run, assert their numbers, and say the same as their case files."""

import importlib.util

import pytest

import carom
from carom import Scenario


@pytest.fixture
def example(examples):
    def load(name):
        spec = importlib.util.spec_from_file_location(name, examples / f"{name}.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module

    return load


def test_python_describes_what_the_case_files_describe(example, examples):
    cylinders = example("two_cylinders").scenario
    for python, case in (
        (example("two_bars").scenario(), "two_bars.toml"),
        (cylinders(friction=0.2), "two_cylinders.toml"),
        (cylinders(friction=0.0), "two_cylinders_frictionless.toml"),
        (example("oblique_layer").scenario(), "oblique_layer.toml"),
    ):
        assert python == Scenario.from_toml(examples / case)


@pytest.mark.parametrize("name", ["two_bars", "two_cylinders", "oblique_layer"])
def test_example_asserts_its_numbers(example, tmp_path, name):
    example(name).main(tmp_path)


def test_a_part_that_gmsh_meshes_falls_on_the_floor(example, examples, tmp_path):
    """The first steps on a coarse mesh; in full the example takes minutes."""
    pytest.importorskip("gmsh", exc_type=(ImportError, OSError))
    geometry = tmp_path / "bracket.geo"
    text = (examples / "bracket.geo").read_text(encoding="utf-8")
    geometry.write_text(text.replace("h = 1.6;", "h = 9;"), encoding="utf-8")
    scenario = example("gmsh_part").scenario(geometry, end_time=4e-5)
    result = carom.run(scenario, out=tmp_path / "out")
    energy = result.summary["energy"]
    assert result.summary["contacts"][0]["pair"] == ["bracket", "floor"]
    assert 0.9 * energy["initial"] < energy["final"] < 1.001 * energy["initial"]
