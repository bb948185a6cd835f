"""How far a boundary has slid, in `surface.vtkhdf`."""

import numpy as np
import pytest

import carom
from carom.io.frames import Frames

SPEED, GRAVITY, FRICTION, END = 1.0, 10.0, 0.05, 0.2


def sliding_block(*, friction):
    """A stiff block that slides along a floor under its own weight."""
    return carom.Scenario(
        title="block",
        analysis=carom.Dynamic(
            end_time=END, time_step=1e-3, gravity=[0.0, -GRAVITY], scheme=carom.Theta(theta=1, xi=1)
        ),
        materials={"stiff": carom.LinearElastic(young=1e6, poisson=0.2, density=1e3)},
        bodies=[
            carom.Body(
                name="block",
                material="stiff",
                mesh=carom.Rectangle(corner=[0, 0], size=[2, 0.5], divisions=[4, 1]),
                velocity=[SPEED, 0.0],
            )
        ],
        obstacles=[carom.Plane(name="floor", point=[0, 0], normal=[0, 1])],
        contact=carom.Contact(condition="gap", friction=friction),
    )


@pytest.mark.parametrize("friction", [0.0, FRICTION])
def test_a_block_slides_as_far_as_it_travels(tmp_path, friction):
    carom.run(sliding_block(friction=friction), out=tmp_path)
    frames = Frames(tmp_path / "surface.vtkhdf")
    slip = frames.field("slip", frames.nearest(None)).reshape(-1)
    ends = frames.points[frames.connectivity.reshape(-1, 2)]
    bottom = np.all(ends[:, :, 1] == 0.0, axis=1)
    travelled = SPEED * END - friction * GRAVITY * END**2 / 2
    np.testing.assert_allclose(slip[bottom], travelled, rtol=0.02)
    top = np.all(ends[:, :, 1] == 0.5, axis=1)
    np.testing.assert_array_equal(slip[top], 0.0)
