"""The energy–momentum scheme with the midpoint condition: 15 s of impacts without a lost joule."""

import numpy as np
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
    assert frictionless.energy("max_drift") <= 5e-11


def test_books_close_with_friction(frictional):
    assert frictional.energy("friction") > 0.15
    assert frictional.energy("max_defect") <= 2e-10


def test_momenta_are_constant_between_wall_contacts(frictionless):
    """From the rebound off the floor to the next wall, which includes the impact of the two."""
    time = frictionless.history["time"]
    pairs = {tuple(c["pair"]): c for c in reversed(frictionless.summary["contacts"])}
    start, end = pairs["left", "floor"]["release"], pairs["right", "east"]["onset"]
    assert start < pairs["left", "right"]["onset"] < pairs["left", "right"]["release"] < end
    between = (time > start) & (time < end - 1e-3)
    for column in ("momentum_x", "momentum_y", "angular_momentum"):
        momentum = frictionless.history[column][between]
        size = np.abs(frictionless.history[column]).max()
        assert np.ptp(momentum) <= 1e-11 * size, column
