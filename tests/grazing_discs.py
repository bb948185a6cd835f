"""Two discs of triangles that graze one another: what codes of others are held against."""

import numpy as np

import carom

LAW = {"young": 2700.0, "poisson": 0.33, "density": 1.0}
TIME_STEP = 1e-3


def discs(steps=1, condition="gap", friction=0.2, **given):
    """Return the case; obstacles are its own, all else that is `given` is of its contact."""
    obstacles = given.pop("obstacles", ())
    bodies = [
        carom.Body(
            name=name,
            material="elastic",
            mesh=carom.Disc(centre=[x, y], radius=1.0, divisions=4, cell="tri3"),
            velocity=[-2.0 * np.sign(x), -0.5],
        )
        for name, x, y in (("left", -1.01, 0.0), ("right", 1.01, 0.4))
    ]
    return carom.Scenario(
        analysis=carom.Dynamic(
            end_time=steps * TIME_STEP,
            time_step=TIME_STEP,
            scheme=carom.Theta(),
            newton=carom.Newton(tolerance=1e-13),
        ),
        output=carom.Output(history_every=TIME_STEP),
        materials={"elastic": carom.SaintVenantKirchhoff(**LAW)},
        bodies=bodies,
        obstacles=obstacles,
        contact=carom.Contact(condition=condition, friction=friction, **given),
    )
