"""The energy–momentum scheme with the midpoint condition: 15 s of impacts without a lost joule."""

import cylinders
import pytest
from cylinders import CONSERVING


@pytest.fixture
def frictionless(cylinders_run):
    return cylinders_run(friction=0.0, condition="midpoint", overrides=CONSERVING)


@pytest.fixture
def frictional(cylinders_run):
    return cylinders_run(friction=0.2, condition="midpoint", overrides=CONSERVING)


def test_frictionless_impacts_conserve_energy(frictionless):
    assert len(frictionless.summary["contacts"]) >= 8
    assert frictionless.energy("max_drift") <= 1e-11


def test_books_close_with_friction(frictional):
    assert frictional.energy("friction") > 0.15
    assert frictional.energy("max_defect") <= 1.5e-12


def test_momenta_are_constant_between_wall_contacts(frictionless):
    """From the rebound off the floor to the next wall, which includes the impact of the two."""
    assert max(cylinders.momentum_spread(frictionless).values()) <= 2e-14
