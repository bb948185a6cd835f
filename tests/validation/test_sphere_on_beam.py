"""A sphere on a beam leaves in every mode of it what Timoshenko's theory says."""

import math
from dataclasses import replace

import numpy as np
import pytest
import sphere_on_beam
import timoshenko
from numpy.testing import assert_allclose
from sphere_on_beam import BEAM, MASS, STIFFNESS

import carom

UNRESOLVED = "waves will not be resolved"
"""Steps are as long as waves need for many of the finest cells."""


def test_a_pinned_beam_has_the_frequencies_of_the_closed_form():
    """Waves sin nπx/L: (ρI ω² − EI k² − S)(ρA ω² − S k²) = S² k², S = κGA."""
    found = replace(BEAM, supports="pinned").modes(8).frequencies
    area, second = BEAM.width * BEAM.height, BEAM.width * BEAM.height**3 / 12
    nu = BEAM.poisson
    shear = 10 * (1 + nu) / (12 + 11 * nu) * BEAM.young / (2 * (1 + nu)) * area
    k = math.pi * np.arange(1, 9) / BEAM.length
    rho = BEAM.density
    roots = [
        np.roots(
            [
                rho**2 * area * second,
                -rho * (second * shear * n**2 + area * (BEAM.young * second * n**2 + shear)),
                shear * BEAM.young * second * n**4,
            ]
        ).min()
        for n in k
    ]
    assert_allclose(found, np.sqrt(roots), rtol=1e-8)


@pytest.mark.parametrize("supports", ["free", "clamped"])
def test_a_slender_beam_is_euler_and_bernoullis(supports):
    """cos βL cosh βL = 1, free or clamped: 4.7300, 7.8532."""
    thin = replace(BEAM, height=BEAM.length / 1000, supports=supports)
    found = thin.modes(4).frequencies
    speed = math.sqrt(thin.young / thin.density / 12) * thin.height
    wanted = speed * (np.array([4.730040745, 7.853204624]) / thin.length) ** 2
    assert_allclose(found[found > 0][:2], wanted, rtol=1e-4)


def test_nothing_is_lost_to_a_beam_where_it_is_held():
    held = replace(BEAM, supports="pinned").modes(20)
    found = timoshenko.strike(
        held, at=BEAM.length / 2, mass=MASS, speed=1.0, stiffness=STIFFNESS, longest=1e-3
    )
    assert found.rebound == pytest.approx(1.0, abs=1e-9)
    duration, _ = sphere_on_beam.hertz(1.0)
    assert found.duration == pytest.approx(duration, rel=1e-4)


def test_a_long_thin_beam_is_an_endless_one():
    """Before a wave comes back, and where shear is slow to matter, Boussinesq's integral holds."""
    long = replace(BEAM, length=3.0, height=0.004, width=0.01)
    struck = {"mass": 0.05, "speed": 0.1, "stiffness": 3e5}
    found = timoshenko.strike(long.modes(60), at=0.0, longest=0.2, **struck)
    line = long.mass / long.length
    bending = long.young * long.width * long.height**3 / 12
    endless = [
        timoshenko.rebound_from_endless(line=line, bending=bending, steps=steps, **struck)
        for steps in (200, 400)
    ]
    assert abs(endless[1] - endless[0]) < 1e-4
    assert found.rebound == pytest.approx(endless[1], abs=2e-4)
    assert found.defect < 1e-12


@pytest.mark.parametrize(
    "given",
    [
        pytest.param({}, id="free"),
        pytest.param({"clamped": True}, id="clamped"),
        pytest.param({"modes": 30}, id="reduced", marks=pytest.mark.long),
    ],
)
def test_each_mode_has_what_theory_says(given):
    """Two cells over 1.4 radii of the contact; finer ones are in docs/validation.md."""
    with pytest.warns(carom.CaromWarning, match=UNRESOLVED):
        found = sphere_on_beam.strike(
            at=0.0, speed=1.0, divisions=2, steps=30, coarse=5e-3, **given
        )
    supports = "clamped" if given.get("clamped") else "free"
    theory = timoshenko.strike(
        replace(BEAM, supports=supports).modes(50),
        at=0.0,
        mass=found.mass,
        speed=1.0,
        stiffness=STIFFNESS,
        longest=1e-3,
    )
    assert theory.defect < 1e-12
    assert found.rebound == pytest.approx(theory.rebound, abs=0.02)
    shares = found.of_bending(theory.frequencies[:5])
    assert shares[0] > 0.3
    assert_allclose(shares, theory.shares[:5], rtol=0, atol=0.02)
    assert found.rigid == pytest.approx(theory.rigid, abs=0.01)
    # What is not of bending is in the neighbourhood of the contact.
    assert found.shares.sum() - shares.sum() + found.rest < 3e-3
    assert found.defect < 1e-11
    assert found.closes < 1e-11
