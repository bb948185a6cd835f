"""A bar of two materials hits a wall: what its interface lets through and throws back."""

import numpy as np
import pytest
from composite_bar import (
    CROSSING,
    IMPEDANCES,
    LENGTHS,
    SPEED,
    exact_impulse,
    impulses,
    run,
    scenario,
)
from runs import observed_order

import carom


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_wall_feels_what_the_interface_throws_back(dimension):
    """The pressure Z₁ v becomes Z₁ v (1 − 2 r) with r = (Z₁ − Z₂)/(Z₁ + Z₂), and ends at 6 L/c."""
    done = run(dimension, 40)
    time, impulse = impulses(done, dimension)
    exact = np.array([exact_impulse(t) for t in time])
    assert abs(impulse - exact).max() < 5e-3 * exact[-1]
    first, second = IMPEDANCES
    inside = (time > 2.3 * CROSSING) & (time < 3.7 * CROSSING)
    pressure = np.polyfit(time[inside], impulse[inside], 1)[0]
    thrown_back = 0.5 * (1.0 - pressure / (first * SPEED))
    assert thrown_back == pytest.approx((first - second) / (first + second), rel=1e-2)
    (contact,) = done.summary["contacts"]
    assert contact["release"] == pytest.approx(6 * CROSSING, rel=5e-3)
    assert contact["impact"]["restitution"] == pytest.approx(1.0, abs=5e-3)
    assert done.summary["energy"]["max_defect"] < 1e-11 * done.summary["energy"]["initial"]


def test_the_impulse_of_the_wall_converges_to_that_of_d_alembert():
    errors, sizes = [], (40, 80, 160)
    for cells in sizes:
        _, impulse = impulses(run(2, cells), 2)
        errors.append(abs(impulse[-1] / exact_impulse(8 * CROSSING) - 1.0))
    assert errors[-1] < 5e-4
    assert observed_order([1 / cells for cells in sizes], errors) > 1.2


def test_the_interface_lets_through_twice_the_one_impedance_over_both(tmp_path):
    """When the wave has just crossed both halves, the far one is at −2 Z₁ Z₂ v/(Z₁ + Z₂)."""
    result = carom.run(scenario(2, 80), out=tmp_path)
    first, second = IMPEDANCES
    frame = int(abs(result.fields.times - 2 * CROSSING).argmin())
    stress = result.fields["stress"][frame][:, 0]
    material = result.fields["material"][frame]
    assert (material == 0).sum() / (material == 1).sum() == pytest.approx(LENGTHS[0] / LENGTHS[1])
    for part in (0, 1):
        cells = stress[material == part]
        inner = cells[len(cells) // 5 : -len(cells) // 5]
        expected = -2 * first * second * SPEED / (first + second)
        assert inner.mean() == pytest.approx(expected, rel=1e-2)
