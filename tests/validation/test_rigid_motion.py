"""Rigid bodies that nothing touches, against closed forms."""

import math

import numpy as np
import pytest
from rigid_bodies import angular_momentum, column, flying, run, spin

import carom

CUBOID = carom.Box(corner=[-0.5, -0.3, -0.2], size=[1.0, 0.6, 0.4], divisions=[1, 1, 1])
DENSITY = 1000.0


def cuboid_inertia():
    """Principal moments of the cuboid [kg m²]."""
    mass, (a, b, c) = DENSITY * 0.24, (1.0, 0.6, 0.4)
    return mass, mass / 12.0 * np.array([b * b + c * c, a * a + c * c, a * a + b * b])


def test_an_asymmetric_top_without_torque_keeps_energy_and_angular_momentum(tmp_path):
    """It spins about its middle axis, which is unstable: it turns over and over."""
    top = carom.RigidBody(name="top", density=DENSITY, mesh=CUBOID, spin=[0.01, 5.0, 0.02])
    case = flying(top, dimension=3, end_time=10.0, time_step=2e-3, rows=500, track=[0.5, 0.3, 0.2])
    history = run(tmp_path, case).history
    # The corner's distance along the angular momentum changes sides.
    side = 0.3 + np.asarray(history["tip.u_y"])
    assert side.max() > 0.25
    assert side.min() < -0.25
    assert np.ptp(history["total"]) < 5e-13 * history["total"][0]
    momentum = angular_momentum(history)
    drift = np.abs(momentum - momentum[0]).max()
    assert drift < 5e-13 * np.linalg.norm(momentum[0])


def test_cells_make_mass_and_inertia(tmp_path):
    """The energy of a spin about each axis is half the moment about it, that of a cuboid."""
    mass, moments = cuboid_inertia()
    for axis in range(3):
        rate = np.eye(3)[axis] * 2.0
        body = carom.RigidBody(
            name="b", density=DENSITY, mesh=CUBOID, spin=list(rate), velocity=[1.0, 2.0, 3.0]
        )
        history = run(tmp_path, flying(body, dimension=3, end_time=1e-3, time_step=1e-3)).history
        expected = 0.5 * mass * 14.0 + 2.0 * moments[axis]
        assert history["kinetic"][0] == pytest.approx(expected, rel=1e-14)
        assert angular_momentum(history)[0] == pytest.approx(moments * rate, abs=1e-13 * mass)


def test_given_mass_and_inertia_count(tmp_path):
    inertia = [[2.0, 0.3, 0.0], [0.3, 3.0, -0.2], [0.0, -0.2, 4.0]]
    rate = [1.0, -2.0, 0.5]
    body = carom.RigidBody(name="b", mass=7.0, inertia=inertia, mesh=CUBOID, spin=rate)
    history = run(tmp_path, flying(body, dimension=3, end_time=1e-3, time_step=1e-3)).history
    momentum = np.array(inertia) @ rate
    assert history["kinetic"][0] == pytest.approx(0.5 * momentum @ rate, rel=1e-14)
    assert angular_momentum(history)[0] == pytest.approx(momentum, rel=1e-13)


def test_a_symmetric_top_precesses_as_poinsot_says(tmp_path):
    """Closed form: in space the spin turns about the angular momentum at |L|/J₁."""
    across, along, rate = 2.0, 3.0, np.array([1.0, 0.0, 4.0])
    body = carom.RigidBody(
        name="top", mass=1.0, inertia=[across, across, along], mesh=CUBOID, spin=list(rate)
    )
    momentum = np.array([across, across, along]) * rate
    size = np.linalg.norm(momentum)
    axis, end = momentum / size, 0.5
    angle = size / across * end
    exact = (
        rate * math.cos(angle)
        + np.cross(axis, rate) * math.sin(angle)
        + axis * (axis @ rate) * (1.0 - math.cos(angle))
    )
    errors = []
    for steps in (100, 200):
        case = flying(body, dimension=3, end_time=end, time_step=end / steps)
        errors.append(np.linalg.norm(spin(run(tmp_path, case).history, "top")[-1] - exact))
    assert errors[1] < 2e-5 * np.linalg.norm(rate)
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.02)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_thrown_body_follows_its_parabola_and_turns_on(tmp_path, dimension):
    """The scheme is exact for a constant force."""
    mesh = (
        carom.Rectangle(corner=[0.0, 0.0], size=[2.0, 1.0], divisions=[2, 1])
        if dimension == 2
        else CUBOID
    )
    down = np.eye(dimension)[-1] * -9.81
    velocity = np.arange(1.0, dimension + 1.0)
    body = carom.RigidBody(
        name="b",
        density=2.0,
        mesh=mesh,
        velocity=list(velocity),
        spin=3.0 if dimension == 2 else [0.0, 0.0, 3.0],
    )
    case = flying(body, dimension=dimension, end_time=1.0, time_step=0.01, gravity=list(down))
    result = run(tmp_path, case)
    history, names = result.history, "xyz"[:dimension]
    centre = column(history, *(f"b.{axis}" for axis in names))
    time = np.asarray(history["time"])[:, None]
    exact = centre[0] + velocity * time + 0.5 * down * time**2
    assert np.abs(centre - exact).max() < 1e-13 * 10.0
    rate = history["b.spin"] if dimension == 2 else history["b.spin_z"]
    assert np.ptp(rate) < 1e-12
    assert np.abs(history["defect"]).max() < 1e-12 * history["total"][0]
    # The points stay where the body has them: by 2 arctan(½ ω Δt) in every step.
    angle = 100 * 2.0 * math.atan(0.5 * 3.0 * 0.01)
    points = result.fields.points[:, :dimension]
    turn = np.eye(dimension)
    turn[:2, :2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
    expected = centre[-1] + (points - centre[0]) @ turn.T
    moved = points + result.fields["displacement"][-1][:, :dimension]
    assert np.abs(moved - expected).max() < 1e-12


@pytest.mark.parametrize("scheme", [carom.Theta(theta=0.8, xi=0.6), carom.Theta(theta=1.0, xi=1.0)])
def test_what_a_damped_scheme_takes_of_a_spin_is_in_the_ledger(tmp_path, scheme):
    """Rotation loses as translation does: (θ − ½)(m|Δv|² + ΔΩ·JΔΩ) in a step; momenta stay."""
    top = carom.RigidBody(name="top", density=DENSITY, mesh=CUBOID, spin=[0.5, 5.0, 0.2])
    case = flying(top, dimension=3, end_time=1.0, time_step=2e-3, scheme=scheme)
    history = run(tmp_path, case).history
    energy = np.asarray(history["total"])
    assert energy[-1] < 0.9999 * energy[0]
    assert history["scheme"][-1] == pytest.approx(energy[0] - energy[-1], abs=1e-13 * energy[0])
    momentum = angular_momentum(history)
    assert np.abs(momentum - momentum[0]).max() < 1e-13 * np.linalg.norm(momentum[0])


def test_a_force_beside_the_centre_pushes_and_turns(tmp_path):
    """Closed form in the plane: a force that stays with a moment that stays."""
    mass, inertia, force, moment = 2.0, 0.5, 3.0, 0.7
    body = carom.RigidBody(
        name="b",
        mass=mass,
        inertia=inertia,
        mesh=carom.Rectangle(corner=[0.0, 0.0], size=[1.0, 1.0], divisions=[1, 1]),
    )
    loads = [
        carom.Resultant(body="b", force=[0.0, force]),
        carom.Resultant(body="b", moment=moment),
    ]
    case = flying(body, dimension=2, end_time=2.0, time_step=0.01, loads=loads)
    history = run(tmp_path, case).history
    assert history["b.v_y"][-1] == pytest.approx(force / mass * 2.0, rel=1e-12)
    assert history["b.spin"][-1] == pytest.approx(moment / inertia * 2.0, rel=1e-12)
    assert history["external"][-1] == pytest.approx(history["kinetic"][-1], rel=1e-13)
    assert np.abs(history["defect"]).max() < 1e-13 * history["kinetic"][-1]


def test_a_pendulum_on_its_own_force_swings_at_its_frequency(tmp_path):
    """A body whose centre is guided, pulled at a point beside it: J φ'' = -F r sin φ."""
    inertia, force, arm, steps = 0.5, 8.0, 0.25, 200
    body = carom.RigidBody(
        name="b",
        mass=2.0,
        inertia=inertia,
        mesh=carom.Rectangle(corner=[-0.5, -0.5], size=[1.0, 1.0], divisions=[1, 1]),
        spin=0.1,
    )
    period = 2.0 * math.pi * math.sqrt(inertia / (force * arm))
    case = flying(
        body,
        dimension=2,
        end_time=period,
        time_step=period / steps,
        loads=[carom.Resultant(body="b", force=[0.0, -force], point=[0.0, -arm])],
        motions=[carom.Guided(body="b", x=0.0, y=0.0)],
    )
    history = run(tmp_path, case).history
    assert history["b.spin"][-1] == pytest.approx(0.1, rel=1e-5)
    assert min(history["b.spin"]) == pytest.approx(-0.1, rel=1e-3)
    assert np.abs(history["defect"]).max() < 1e-13 * history["kinetic"][0]


def test_a_body_of_revolution_falls_along_its_axis(tmp_path):
    body = carom.RigidBody(
        name="b",
        density=3.0,
        hypothesis="axisymmetric",
        mesh=carom.Rectangle(corner=[0.0, 0.0], size=[2.0, 1.0], divisions=[2, 1]),
    )
    case = flying(body, dimension=2, end_time=1.0, time_step=0.1, gravity=[0.0, -2.0])
    history = run(tmp_path, case).history
    assert history["b.y"][-1] - history["b.y"][0] == pytest.approx(-1.0, rel=1e-13)
    mass = 3.0 * math.pi * 4.0
    assert history["kinetic"][-1] == pytest.approx(0.5 * mass * 4.0, rel=1e-13)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"density": None}, "bodies.0.density: required key is missing; give it, or the mass"),
        ({"mass": 1.0}, "a density or a mass, not both"),
        ({"inertia": [1.0, 1.0, 3.0]}, "principal moments"),
        ({"inertia": 1.0}, "an inertia in 3D is three numbers, or three rows of three"),
        ({"inertia": [[1.0, 0.1, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]}, "must be symmetric"),
    ],
)
def test_a_body_that_no_mass_makes_is_refused(tmp_path, change, message):
    entry = {"kind": "rigid", "name": "b", "density": 1.0, "mesh": CUBOID.model_dump()} | change
    with pytest.raises(carom.InputError, match=message):
        scenario = carom.Scenario.from_dict(
            {
                "dimension": 3,
                "analysis": {"end_time": 1.0, "time_step": 0.1},
                "bodies": [{k: v for k, v in entry.items() if v is not None}],
            }
        )
        run(tmp_path, scenario)


def test_a_rigid_body_is_not_periodic():
    mesh = carom.Rectangle(corner=[0.0, 0.0], size=[1.0, 1.0], divisions=[3, 3], periodic=True)
    with pytest.raises(carom.InputError, match="a rigid body cannot be periodic"):
        carom.RigidBody(name="b", density=1.0, mesh=mesh)
