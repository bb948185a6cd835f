"""A sphere thrown obliquely comes back the way Maw, Barber & Fawcett found."""

import pytest
from oblique_spheres import CHI, rebound, throw

import carom

UNRESOLVED = "waves will not be resolved"
"""Steps are as long as waves need for many of the finest cells."""


def test_the_reference_slips_throughout_beyond_the_last_angle():
    """ψ₂ = ψ₁ − 4χ from ψ₁ = 4χ − 1 on, and it is below −1 before."""
    for incidence in (4 * CHI - 0.9, 7.0):
        assert rebound(incidence, rings=40, steps=200) == pytest.approx(
            incidence - 4 * CHI, abs=1e-2
        )
    assert rebound(3.5, rings=40, steps=200) < -1.3


def test_the_reference_converges_with_its_rings():
    coarse, fine = rebound(2.0, rings=30, steps=150), rebound(2.0, rings=60, steps=300)
    assert coarse == pytest.approx(fine, abs=2e-3)


def test_a_sphere_thrown_at_a_floor_turns_round():
    with pytest.warns(carom.CaromWarning, match=UNRESOLVED):
        found = throw(3.0, divisions=2, steps=60)
    assert found.rebound == pytest.approx(rebound(3.0, rings=50, steps=200), abs=0.01 * 4 * CHI)
    assert found.restitution == pytest.approx(1.0, abs=5e-3)
    assert found.defect < 1e-10
