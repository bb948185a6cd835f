"""Massless contact where damping takes the motion: in flight, and as bodies turn round.

The bounds are within ten times of what is measured; defects are of the work of gravity.
"""

import pytest

import carom

STEP = 5e-4
HEIGHT = 1e-4


def disc(steps, *, mass=60.0, stiffness=2e-4, above=HEIGHT):
    """Return the simulation of a damped disc that falls on a floor from so high above it [m]."""
    rubber = carom.SaintVenantKirchhoff(
        young=5e6,
        poisson=0.3,
        density=1100.0,
        damping=carom.Damping(mass=mass, stiffness=stiffness),
    )
    mesh = carom.Disc(centre=(0.0, 0.05 + above), radius=0.05, divisions=4)
    case = carom.Scenario(
        analysis=carom.Dynamic(gravity=(0.0, -9.81), end_time=steps * STEP, time_step=STEP),
        materials={"rubber": rubber},
        bodies=[carom.Body(name="disc", material="rubber", mesh=mesh)],
        obstacles=[carom.Plane(name="floor", point=(0.0, 0.0), normal=(0.0, 1.0))],
        contact=carom.Contact(friction=0.3),
    )
    assert case.contact.condition == "massless"
    return carom.Simulation(case)


@pytest.mark.parametrize("mass", [0.0, 60.0])
@pytest.mark.parametrize("stiffness", [0.0, 2e-4])
def test_a_damped_body_falls_as_a_rigid_one(mass, stiffness):
    """Symptom guarded against: it did not converge from rest, as its damping was not foreseen."""
    simulation = disc(20, mass=mass, stiffness=stiffness, above=1.0)
    steps = [simulation.step() for _ in range(20)]
    assert max(step.substeps for step in steps) == 1
    assert max(step.iterations for step in steps) <= 3
    assert simulation.energy.strain < 1e-15 * simulation.energy.kinetic


def test_books_close_where_a_damped_body_turns_round():
    """Symptom guarded against: no blend closes them there, and 3e-5 of the energy waited."""
    simulation = disc(300)
    defects, work = [], 0.0
    for _ in range(300):
        simulation.step()
        defects.append(abs(simulation.ledger.defect))
        work = max(work, abs(simulation.ledger.external))
    assert work > 5e-3
    assert max(defects) < 1e-9 * work
