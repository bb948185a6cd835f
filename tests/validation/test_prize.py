"""The default of case files: energy to round-off, quiet and never penetrating, all in one run."""

import cylinders
import pytest

FAST = ("bodies.0.velocity=[4.0, -8.0]",)


@pytest.fixture
def frictionless(cylinders_run):
    return cylinders_run(friction=0.0, condition="massless", overrides=cylinders.PRIZE)


@pytest.fixture
def frictional(cylinders_run):
    return cylinders_run(friction=0.2, condition="massless", overrides=cylinders.PRIZE)


@pytest.fixture
def fine(cylinders_run):
    """Half the time step, until the cylinders have met and before anything touches a wall again."""
    overrides = (*cylinders.PRIZE, "analysis.time_step=5e-4")
    return cylinders_run(friction=0.0, condition="massless", end_time=3.4, overrides=overrides)


@pytest.fixture
def fast(cylinders_run):
    overrides = (*cylinders.PRIZE, *FAST)
    return cylinders_run(friction=0.2, condition="massless", end_time=3.75, overrides=overrides)


def test_frictionless_impacts_conserve_energy(frictionless, fine):
    for run in (frictionless, fine):
        assert run.energy("max_drift") <= 2e-11


def test_nothing_penetrates(frictionless, frictional, fine, fast):
    for run in (frictionless, frictional, fine, fast):
        assert run.summary["min_gap"] >= -5e-13


def test_contact_force_does_not_chatter(frictionless, fine):
    for run in (frictionless, fine):
        assert cylinders.total_variation(run) <= 1.1 * cylinders.QUIET


def test_momenta_are_constant_between_wall_contacts(frictionless, fine):
    for run in (frictionless, fine):
        assert max(cylinders.momentum_spread(run).values()) <= 5e-12


def test_books_close_with_friction(frictional, fast):
    for run in (frictional, fast):
        assert run.energy("friction") > 0.15
        assert run.energy("max_defect") <= 1e-11


def test_friction_does_no_work_in_any_step(frictional, fast):
    for run in (frictional, fast):
        assert run.summary["least_friction"] >= 0.0
        assert run.summary["max_blend"] <= 0.5


def test_cylinders_meet_when_the_other_conditions_say(frictionless, frictional):
    assert cylinders.onset(frictionless, "left", "right") == pytest.approx(2.49, abs=0.03)
    assert cylinders.onset(frictional, "left", "right") == pytest.approx(2.83, abs=0.03)


def test_coulombs_law_holds_in_every_step(frictionless, frictional):
    for run in (frictionless, frictional):
        assert run.summary["certificate"]["max_joule"] <= 1.5e-11
