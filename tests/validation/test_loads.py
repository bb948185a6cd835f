"""Gravity, damping and friction in the balance that massless contact closes."""

import cylinders
import pytest


@pytest.fixture
def loaded(cylinders_run):
    damping = "materials.elastic.damping={mass=0.2, stiffness=1e-5}"
    overrides = (*cylinders.LOADED, damping)
    return cylinders_run(friction=0.2, condition="massless", end_time=1.0, overrides=overrides)


def test_every_term_takes_part(loaded):
    for term in ("external", "friction", "viscous"):
        assert loaded.energy(term) > 0.1, term


def test_books_close_with_loads(loaded):
    """Impacts this hard ask for a blend beyond its limit: vibration pays what exceeds it."""
    assert loaded.energy("max_defect") <= 1e-10


def test_loaded_bodies_do_not_penetrate(loaded):
    assert loaded.summary["min_gap"] >= -1e-12
    assert loaded.summary["least_friction"] >= 0.0
