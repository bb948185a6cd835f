"""The examples run, assert their numbers, and say the same as their case files."""

import importlib.util

import pytest

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
