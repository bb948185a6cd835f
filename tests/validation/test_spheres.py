"""Spheres on a rigid plane against Hertz: pressed, and at impact; coarse runs of the examples."""

import importlib.util
import sys

import pytest


@pytest.fixture
def example(examples):
    def load(name):
        spec = importlib.util.spec_from_file_location(name, examples / f"{name}.py")
        module = importlib.util.module_from_spec(spec)
        # dataclasses look their module up.
        sys.modules[name] = module
        spec.loader.exec_module(module)
        return module

    return load


def test_pressure_under_a_pressed_sphere_converges_to_hertz(example):
    press = example("hertz_sphere").press
    coarse, fine = (press(2, divisions).errors() for divisions in (6, 24))
    assert max(map(abs, coarse)) < 0.04
    assert max(map(abs, fine)) < 0.0075
    assert max(map(abs, fine)) < 0.3 * max(map(abs, coarse))


def test_sphere_in_space_is_pressed_as_one_of_revolution(example):
    press = example("hertz_sphere").press
    space, plane = press(3, 4), press(2, 24)
    assert space.force == pytest.approx(plane.force, rel=0.02)
    assert max(map(abs, space.errors())) < 0.06


def test_steel_sphere_rebounds_as_hertz_found(example):
    impact = example("steel_sphere").strike(2, 6)
    assert max(map(abs, impact.errors())) < 0.03
    assert impact.energy == pytest.approx(1.0, abs=1e-9)
