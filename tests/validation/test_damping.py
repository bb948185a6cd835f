"""Rayleigh damping: exact damped motions at the order of the scheme."""

from functools import cache

import oscillator
import pytest

ORDER = {0.5: 2.0, 1.0: 1.0}
"""Order in Δt by θ = ξ."""


@pytest.fixture(scope="module", params=["coasting", "column"])
def motion(request):
    run = cache(getattr(oscillator, request.param))
    return run, getattr(oscillator, f"{request.param}_error")


@pytest.mark.parametrize("theta", ORDER)
def test_damped_motion_converges_at_the_order_of_the_scheme(motion, theta):
    run, error = motion
    runs = [run(steps=steps, theta=theta) for steps in oscillator.STEPS]
    assert oscillator.order(runs, error) == pytest.approx(ORDER[theta], abs=0.05)
    assert error(runs[-1]) <= {2.0: 1e-5, 1.0: 1e-2}[ORDER[theta]]


def test_viscous_dissipation_closes_the_ledger(motion):
    run, _ = motion
    for theta in ORDER:
        fine = run(steps=oscillator.STEPS[-1], theta=theta)
        energy = fine.summary["energy"]
        assert energy["viscous"] > 0.0
        assert energy["max_defect"] <= 1e-12 * energy["viscous"]


def test_column_stays_on_the_floor():
    run = oscillator.column(steps=oscillator.STEPS[0], theta=0.5)
    (contact,) = run.summary["contacts"]
    assert contact["release"] is None
    assert abs(run.summary["min_gap"]) <= 1e-12
