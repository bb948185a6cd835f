"""A ball or disc that rolls on a plane, of the tests and ``benchmarks/rigid_bodies.py``."""

import carom


def floor(dimension):
    return carom.Plane(
        name="floor", point=[0.0] * dimension, normal=[0.0] * (dimension - 1) + [1.0]
    )


def rolling(dimension, *, length, condition, slip=0.0, friction=0.5):
    """A ball or a disc on a plane that sets out with so much slip [m/s]."""
    radius, speed, step = 0.1, 2.0, 2e-3
    rate = (speed - slip) / radius
    if dimension == 2:
        mesh = carom.Disc(centre=[0.0, radius], radius=radius, divisions=1, rings=1, cell="tri3")
        about = -rate
    else:
        mesh = carom.Ball(
            centre=[0.0, 0.0, radius], radius=radius, divisions=1, rings=1, cell="tet4"
        )
        about = [0.0, rate, 0.0]
    end = length / speed
    return carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(
            end_time=end, time_step=step, gravity=[0.0] * (dimension - 1) + [-9.81]
        ),
        bodies=[
            carom.RigidBody(
                name="b",
                density=250.0,
                mesh=mesh,
                round=True,
                velocity=[speed] + [0.0] * (dimension - 1),
                spin=about,
            )
        ],
        obstacles=[floor(dimension)],
        contact=carom.Contact(condition=condition, friction=friction),
        output=carom.Output(history_every=end / 20, fields_every=end),
    )
