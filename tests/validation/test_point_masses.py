"""Masses at points: what they weigh, how they turn, how they ring, beside closed forms."""

import numpy as np
import pytest
from runs import simulate
from scipy.optimize import brentq

import carom

SOFT = {"soft": carom.LinearElastic(young=1e4, poisson=0.0, density=2.0)}
PLATE = carom.Rectangle(corner=[0.0, 0.0], size=[2.0, 1.0], divisions=[4, 2])
VOLUME_MASS = 4.0


def case(bodies, masses, *, time_step=1e-2, end_time=0.1, gravity=None, **given):
    return carom.Scenario(
        dimension=2,
        analysis=carom.Dynamic(
            end_time=end_time,
            time_step=time_step,
            gravity=gravity,
            newton=carom.Newton(tolerance=1e-12),
        ),
        bodies=bodies,
        masses=masses,
        materials=SOFT,
        output=carom.Output(history_every=time_step, fields_every=end_time),
        **given,
    )


@pytest.mark.parametrize("kind", ["deformable", "rigid"])
@pytest.mark.parametrize("place", [{"point": [2.0, 1.0]}, {"on": "right"}])
def test_a_mass_moves_centre_inertia_and_momenta(kind, place):
    """A spinning plate of 2 m × 1 m with 3 kg at a corner or along a side."""
    mass, velocity, spin = 3.0, np.array([0.3, -0.2]), 1e-3
    given = {"name": "plate", "mesh": PLATE, "velocity": velocity, "spin": spin}
    body = (
        carom.RigidBody(density=2.0, **given)
        if kind == "rigid"
        else carom.Body(material="soft", **given)
    )
    history = simulate(case([body], [carom.PointMass(body="plate", mass=mass, **place)])).history
    total = VOLUME_MASS + mass
    points = np.array([[2.0, 1.0]] if "point" in place else [[2.0, 0.0], [2.0, 0.5], [2.0, 1.0]])
    centre = (VOLUME_MASS * np.array([1.0, 0.5]) + mass * points.mean(axis=0)) / total
    assert history["plate.x"][0] == pytest.approx(centre[0], rel=1e-14)
    assert history["plate.y"][0] == pytest.approx(centre[1], rel=1e-14)
    assert history["momentum_x"] == pytest.approx(total * velocity[0], rel=1e-12)
    assert history["translation"] == pytest.approx(0.5 * total * velocity @ velocity, rel=1e-12)
    inertia = VOLUME_MASS * (2.0**2 + 1.0**2) / 12.0
    inertia += VOLUME_MASS * np.sum((np.array([1.0, 0.5]) - centre) ** 2)
    inertia += mass * np.sum((points - centre) ** 2, axis=1).mean()
    assert history["rotation"][0] == pytest.approx(0.5 * inertia * spin**2, rel=1e-10)


def test_a_point_inside_a_rigid_body_need_not_be_a_node():
    """A mass anywhere on a rigid plate, between its nodes or outside them."""
    for point in ([0.37, 0.81], [-0.5, 1.7]):
        body = carom.RigidBody(name="plate", density=2.0, mesh=PLATE, spin=1.0)
        history = simulate(
            case([body], [carom.PointMass(body="plate", point=point, mass=1.0)])
        ).history
        centre = (VOLUME_MASS * np.array([1.0, 0.5]) + np.array(point)) / (VOLUME_MASS + 1.0)
        apart = np.sum((np.array(point) - [1.0, 0.5]) ** 2)
        inertia = VOLUME_MASS * 5.0 / 12.0 + VOLUME_MASS / (VOLUME_MASS + 1.0) * apart
        assert history["plate.x"][0] == pytest.approx(centre[0], rel=1e-13)
        assert history["rotation"][0] == pytest.approx(0.5 * inertia, rel=1e-12)


def test_what_falls_freely_does_not_feel_its_masses():
    masses = [carom.PointMass(body="plate", point=[2.0, 1.0], mass=30.0)]
    body = carom.Body(name="plate", material="soft", mesh=PLATE)
    run = simulate(case([body], masses, gravity=[0.0, -10.0], end_time=0.5))
    history, time = run.history, run.history["time"]
    assert history["plate.v_y"] == pytest.approx(-10.0 * time, abs=1e-12)
    assert history["strain"].max() < 1e-20
    assert history["external"][-1] == pytest.approx(0.5 * 34.0 * 5.0**2, rel=1e-12)
    assert np.abs(history["defect"]).max() < 1e-10


def test_a_bar_with_a_mass_at_its_end_rings_as_it_should():
    """β L tan β L = M/m for a bar that is held at one end and has the mass m at the other."""
    length, mass = 2.0, 3.0
    bar = carom.Body(
        name="bar",
        material="soft",
        mesh=carom.Rectangle(corner=[0.0, 0.0], size=[length, 1.0], divisions=[40, 1]),
    )
    beta = brentq(lambda x: x * np.tan(x) - VOLUME_MASS / mass, 1e-6, 1.5) / length
    period = 2.0 * np.pi / (beta * np.sqrt(1e4 / 2.0))
    push = carom.Force(body="bar", on="right", force=["where(t < 1e-9, 1, 1e-3)", 0.0])
    history = simulate(
        case(
            [bar],
            [carom.PointMass(body="bar", on="right", mass=mass)],
            time_step=period / 400.0,
            end_time=3.02 * period,
            motions=[carom.Fixed(body="bar", on="left")],
            loads=[push],
        )
    ).history
    # The tip swings between none and twice the static displacement; higher tones are a percent.
    x = history["bar.x"] - history["bar.x"][0]
    middle = 0.5 * (x.max() + x.min())
    up = np.flatnonzero((x[:-1] < middle) & (x[1:] >= middle))
    crossing = history["time"][up] + (middle - x[up]) / (x[up + 1] - x[up]) * (period / 400.0)
    assert np.diff(crossing).mean() == pytest.approx(period, rel=2e-3)
