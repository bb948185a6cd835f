"""A sphere on a thin plate loses to the waves in it what Zener says."""

import pytest
import zener

import carom

UNRESOLVED = "waves will not be resolved"
"""Steps are as long as waves need for many of the finest cells."""


def test_zeners_equation_has_its_limits():
    """Hertz's impact without λ; what follows e ≈ exp(−1.719 λ) to a hundredth up to λ = 0.2."""
    assert zener.restitution(0.0) == pytest.approx(1.0, abs=1e-8)
    assert zener.restitution(0.1) == pytest.approx(0.8421, abs=2e-3)
    assert zener.restitution(1.0) < 0.2


@pytest.mark.parametrize(("inelasticity", "within"), [(0.1, 0.015), (0.5, 0.025)])
def test_waves_in_a_plate_take_what_zener_says(inelasticity, within):
    with pytest.warns(carom.CaromWarning, match=UNRESOLVED):
        found = zener.strike(inelasticity, speed=1.0, divisions=4, steps=60)
    assert found.restitution == pytest.approx(zener.restitution(inelasticity), abs=within)
    assert found.defect < 1e-11
    assert found.closes < 1e-9
