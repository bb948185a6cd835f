"""Bodies at rest, by hand and over a restart."""

from __future__ import annotations

import pytest

import carom


def stack(divisions: int) -> carom.Scenario:
    """Return two squares that come to rest on a floor."""
    law = carom.SaintVenantKirchhoff(
        young=1e8, poisson=0.3, density=1e3, damping=carom.Damping(mass=100.0, stiffness=1e-4)
    )
    squares = [
        carom.Body(
            name=name,
            material="rubber",
            mesh=carom.Rectangle(corner=corner, size=[1.0, 1.0], divisions=[divisions, divisions]),
        )
        for name, corner in [("lower", [0.0, 0.0]), ("upper", [0.1, 1.0])]
    ]
    return carom.Scenario(
        analysis=carom.Dynamic(gravity=(0.0, -9.81), end_time=1.0, time_step=1e-3),
        materials={"rubber": law},
        bodies=squares,
        obstacles=[carom.Plane(name="floor", point=(0.0, 0.0), normal=(0.0, 1.0))],
        contact=carom.Contact(friction=0.5),
    )


@pytest.mark.parametrize("divisions", [2, 5], ids=["with mass", "massless"])
def test_bodies_that_rest_are_named_and_take_no_iterations(divisions: int) -> None:
    simulation = carom.Simulation(stack(divisions))
    assert simulation.resting == []
    simulation.advance(0.9)
    assert simulation.resting == ["lower", "upper"]
    step = simulation.step()
    assert step.iterations == 0
    assert step.contacts > 0
    assert abs(step.normal_force - 3.0 * 9.81e3) < 1.0
