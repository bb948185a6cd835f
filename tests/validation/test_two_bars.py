"""Two elastic bars hit head-on: exact solution by d'Alembert, curves of the prototype."""

import bars
import numpy as np
import pytest
from runs import reference


@pytest.fixture
def measured(bars_run):
    return bars.figures(bars_run(elements=100))


QUICK = bars.ELEMENTS[:-1]
"""The finest run takes as long as all others of this file; `make validate` has it."""


@pytest.fixture(scope="module")
def refined(bars_run):
    return [bars.figures(bars_run(elements=elements)) for elements in QUICK]


def test_bars_part_after_the_wave_has_returned(measured):
    assert measured.release == pytest.approx(0.0299, abs=0.0002)
    assert measured.release == pytest.approx(bars.RELEASE, abs=0.0003)


def test_bars_leave_with_reversed_velocity(measured):
    assert measured.late_velocity == pytest.approx(-bars.SPEED, abs=0.01)


def test_contact_point_follows_the_exact_solution(measured):
    assert measured.displacement_error <= 0.01
    assert measured.velocity_error <= 0.08


def test_contact_point_follows_the_reference_curve(bars_run):
    history, curve = bars_run(elements=100).history, reference("bars_gap")
    for column, title, bound in (
        ("C.u_x", "ux_C", 1e-3 * bars.HALF_GAP),
        ("C.vmid_x", "vmid_C", 1e-3 * bars.SPEED),
        ("total", "E_t", 1e-3 * curve["E_t"][0]),
    ):
        at_curve = np.interp(curve["t"], history["time"], history[column])
        np.testing.assert_allclose(at_curve, curve[title], rtol=0.0, atol=bound)


def test_gap_condition_loses_energy_at_the_touch(measured, bars_run):
    run = bars_run(elements=100)
    assert measured.energy_change == pytest.approx(-0.005, abs=0.001)
    assert run.energy("normal_contact") == pytest.approx(-measured.energy_change, abs=4e-13)
    assert run.energy("max_defect") <= 5e-13


def test_gap_condition_never_penetrates(bars_run):
    # Two roundings of positions of 10 m.
    assert bars_run(elements=100).summary["min_gap"] >= -2.0 * np.spacing(10.0)


@pytest.mark.parametrize("quantity", ["displacement_error", "velocity_error", "energy_change"])
def test_errors_fall_with_the_element_size_at_the_prototypes_rate(refined, quantity):
    prototype = [bars.prototype(elements=elements) for elements in QUICK]
    assert bars.order(refined, quantity) == pytest.approx(bars.order(prototype, quantity), abs=0.02)
    for ours, theirs in zip(refined, prototype, strict=True):
        assert getattr(ours, quantity) == pytest.approx(getattr(theirs, quantity), rel=0.01)


def test_midpoint_condition_conserves_energy(bars_run):
    run = bars_run(elements=100, condition="midpoint")
    assert run.energy("max_drift") <= 6e-13


def test_what_midpoint_loses_is_the_contact_solvers_tolerance(bars_run):
    tight = 'contact.solver={kind="gauss-seidel", tolerance=1e-14}'
    run = bars_run(elements=100, condition="midpoint", overrides=(tight,))
    assert run.energy("max_drift") <= 5e-13


def test_midpoint_condition_penetrates_by_less_than_a_step_of_travel(bars_run):
    run = bars_run(elements=100, condition="midpoint")
    closing = 2.0 * bars.SPEED * run.summary["time_step"]
    assert -1.3 * closing <= run.summary["min_gap"] <= 0.0


@pytest.fixture(scope="module")
def massless(bars_run):
    return [
        bars_run(elements=n, condition="massless", overrides=(bars.CONSERVING,))
        for n in bars.ELEMENTS
    ]


def test_massless_nodes_are_quiet_and_keep_energy(massless):
    run = massless[bars.ELEMENTS.index(100)]
    assert run.energy("max_drift") <= 6e-12
    assert bars.figures(run).velocity_error <= 0.06
    assert run.summary["min_gap"] >= -1e-15


def test_massless_nodes_keep_energy_on_every_mesh(massless):
    for run in massless:
        figures = bars.figures(run)
        assert run.energy("max_drift") <= 6e-12
        assert figures.displacement_error <= 0.0035
        assert figures.velocity_error <= 0.06


def test_massless_bars_converge_where_waves_disperse_least(bars_run):
    """The velocity jumps, so half an order is the most that its L2 norm can have."""
    elements = (50, 100, 200)
    done = [
        bars.figures(
            bars_run(
                elements=n,
                condition="massless",
                overrides=(bars.CONSERVING, *bars.least_dispersion(n)),
            )
        )
        for n in elements
    ]
    assert bars.order(done, "displacement_error", elements) > 0.88
    assert bars.order(done, "velocity_error", elements) > 0.4
    crossings = [bars.LENGTH / n / bars.WAVE_SPEED for n in elements]
    for figures, crossing in zip(done, crossings, strict=True):
        assert figures.release == pytest.approx(bars.RELEASE, abs=0.75 * crossing)
    assert [figures.plateau for figures in done] == pytest.approx([1.0, 1.0, 1.0], abs=1e-3)
    assert done[-1].plateau == pytest.approx(1.0, abs=2e-4)


def test_massless_contact_point_follows_the_reference_curve(bars_run):
    """Another distribution of the mass: curves are close where waves do not jump."""
    history = bars_run(elements=100, condition="massless").history
    curve = reference("bars_massless")
    at_curve = np.interp(curve["t"], history["time"], history["C.u_x"])
    np.testing.assert_allclose(at_curve, curve["ux_C"], rtol=0.0, atol=0.03 * bars.HALF_GAP)
