"""Pads under a pressure whose friction has a limit of shear, and what stops or holds them."""

from __future__ import annotations

import carom

SHEAR, FRICTION = 2.0, 0.3
"""Limit of shear [Pa]; and μ, where the pressure is low."""

LAW = carom.FrictionFormula(formula=f"min({FRICTION}, {SHEAR}/p)")


def thrown(law, *, width=1.0, time_step=2e-3):
    """A rigid block of 1 kg that slides at 1 m/s under a weight of 10 N."""
    return carom.Scenario(
        dimension=2,
        analysis=carom.Dynamic(
            end_time=0.2,
            time_step=time_step,
            scheme=carom.Conserving(),
            newton=carom.Newton(tolerance=1e-12),
            gravity=[0.0, -10.0],
        ),
        output=carom.Output(history_every=time_step, fields_every=0.2),
        bodies=[
            carom.RigidBody(
                name="block",
                mass=1.0,
                mesh=carom.Rectangle(
                    corner=[0.0, 0.0], size=[width, 0.05 * width], divisions=[1, 1]
                ),
                velocity=[1.0, 0.0],
            )
        ],
        obstacles=[carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0])],
        contact=carom.Contact(friction=law),
    )


def dragged(law, *, discretisation, sources, cells=(6, 10), down=0.02):
    """A pad of rubber that is pressed on a slab and drawn along it until it slides."""
    rubber = carom.NeoHookean(young=100.0, poisson=0.0, density=1.0)
    shapes = {
        "pad": carom.Rectangle(corner=[1.0, 0.0], size=[1.0, 0.5], divisions=[cells[0], 3]),
        "slab": carom.Rectangle(corner=[0.0, -0.5], size=[3.0, 0.5], divisions=[3 * cells[1], 3]),
    }
    press = carom.Table(time=[0.0, 0.5, 1.0], value=[0.0, -down, -down])
    draw = carom.Table(time=[0.0, 0.5, 1.0], value=[0.0, 0.0, 0.2])
    contact = carom.Contact(
        friction=law, discretisation=discretisation, sources=sources, targets="faceted"
    )
    return carom.Scenario(
        dimension=2,
        analysis=carom.Static(end_time=1.0, time_step=0.05),
        output=carom.Output(history_every=0.05, fields_every=1.0),
        materials={"rubber": rubber},
        bodies=[
            carom.Body(name=name, material="rubber", mesh=mesh) for name, mesh in shapes.items()
        ],
        motions=[
            carom.Prescribed(body="pad", on="top", x=draw, y=press),
            carom.Fixed(body="slab", on="bottom"),
        ],
        contact=contact,
    )
