"""Spheres on a rigid plane against Hertz: pressed, and at impact; coarse runs of the examples."""

import importlib.util
import sys

import pytest

import carom

UNRESOLVED = "waves will not be resolved"
"""Steps are a hundredth of the impact, as long as waves need for many cells."""


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


def test_steel_sphere_rebounds_as_a_finite_sphere_must(example):
    """Hertz's theory, and what is stiffer in a sphere than in a half space, measured at rest."""
    sphere = example("steel_sphere")
    hertz = sphere.quasi_static()
    with pytest.warns(carom.CaromWarning, match=UNRESOLVED):
        impact = sphere.strike(2, 12)
    assert hertz.time == pytest.approx(52.24e-6, rel=1e-4)
    assert hertz.force == pytest.approx(2300.9, rel=1e-4)
    assert hertz.depth == pytest.approx(17.75e-6, rel=1e-3)
    assert max(map(abs, impact.errors(hertz))) < 0.02
    beta = sphere.stiffening(12)
    assert max(map(abs, impact.errors(sphere.quasi_static(stiffening=beta)))) < 0.005


def test_steel_sphere_in_space_rebounds_as_one_of_revolution(example):
    sphere = example("steel_sphere")
    with pytest.warns(carom.CaromWarning, match=UNRESOLVED):
        space, plane = sphere.strike(3, 4, steps=100), sphere.strike(2, 4, steps=100)
    assert max(map(abs, space.errors(plane))) < 0.02


def test_sphere_moved_to_and_fro_rubs_as_much_as_mindlin_found(example):
    """Four cells over the contact, of which one to two slip: the example has finer meshes."""
    loop = example("mindlin_loop").cycle(4, 0.85, steps=6)
    assert loop.dissipated == pytest.approx(loop.theory(), rel=0.05)
