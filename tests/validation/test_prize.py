"""The default of case files: energy to round-off, quiet and never penetrating, all in one run."""

import cylinders
import numpy as np
import pytest

import carom
from carom.results.result import Result

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


def test_nodes_that_pass_one_another_stay_outside(cylinders_run):
    """Symptom guarded against: one of two was left out as it started on the other, and sank in."""
    overrides = (*cylinders.PRIZE, 'contact.sources="both"')
    run = cylinders_run(friction=0.0, condition="massless", end_time=2.6, overrides=overrides)
    assert run.summary["min_gap"] >= -1e-12


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
        assert run.summary["max_blend"] <= 2.0


def test_cylinders_meet_when_the_other_conditions_say(frictionless, frictional):
    assert cylinders.onset(frictionless, "left", "right") == pytest.approx(2.49, abs=0.03)
    assert cylinders.onset(frictional, "left", "right") == pytest.approx(2.83, abs=0.03)


def test_coulombs_law_holds_in_every_step(frictionless, frictional):
    for run in (frictionless, frictional):
        assert run.summary["certificate"]["max_joule"] <= 1.5e-11


@pytest.mark.parametrize("scheme", ["conserving", "theta"])
def test_a_body_falls_without_strain(tmp_path, scheme):
    """Symptom guarded against: what steadies massless nodes resisted free fall.

    It strained the body by 1e-4 of the work of gravity, and steps took 5 to 41 iterations.
    """
    scenario = carom.Scenario(
        analysis=carom.Dynamic(
            end_time=0.5, time_step=0.01, gravity=[0.0, -9.81], scheme={"kind": scheme}
        ),
        materials={"m": carom.NeoHookean(young=1e5, poisson=0.3, density=1000.0)},
        bodies=[
            carom.Body(
                name="disc",
                material="m",
                mesh=carom.Disc(centre=[0.0, 2.0], radius=0.5, divisions=6),
                velocity=[0.3, 0.0],
            )
        ],
        obstacles=[carom.Plane(name="floor", point=[0.0, -5.0], normal=[0.0, 1.0])],
        contact=carom.Contact(condition="massless"),
        output=carom.Output(history_every=0.01),
    )
    carom.run(scenario, out=tmp_path)
    history = Result.open(tmp_path).history
    assert history["strain"].max() <= 1e-27 * history["external"][-1]
    assert history["newton_iterations"][1] <= 7
    assert history["newton_iterations"][2:].max() <= 2
    assert np.abs(history["defect"]).max() <= 1e-13 * history["kinetic"].max()
    fallen = 2.0 - 0.5 * 9.81 * history["time"] ** 2
    assert history["disc.y"] == pytest.approx(fallen, abs=1e-13)
