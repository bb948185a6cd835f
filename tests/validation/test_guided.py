"""Rigid bodies of which a part of the motion is given."""

import math

import numpy as np
import pytest
from rigid_bodies import flying, run, spin

import carom

SQUARE = carom.Rectangle(corner=[-0.5, -0.5], size=[1.0, 1.0], divisions=[1, 1])
CUBE = carom.Box(corner=[-0.5] * 3, size=[1.0] * 3, divisions=[1] * 3)


def test_a_body_goes_and_turns_as_it_is_told(tmp_path):
    body = carom.RigidBody(name="b", mass=2.0, inertia=0.5, mesh=SQUARE)
    motion = carom.Guided(body="b", x="0.3*sin(2*t)", y="t^2", turn_z="3*t")
    case = flying(body, dimension=2, end_time=1.0, time_step=0.01, motions=[motion])
    result = run(tmp_path, case)
    history, time = result.history, np.asarray(result.history["time"])
    assert result.summary["dofs"] == 0
    assert np.abs(history["b.x"] - 0.3 * np.sin(2.0 * time)).max() < 1e-15
    assert np.abs(history["b.y"] - time**2).max() < 1e-14
    assert np.abs(history["b.v_x"] - 0.6 * np.cos(2.0 * time)).max() < 1e-13
    assert np.abs(history["b.spin"] - 3.0).max() < 1e-13
    # A corner is where three radians put it.
    corner = np.array([-0.5, -0.5])
    cosine, sine = math.cos(3.0), math.sin(3.0)
    turned = np.array([[cosine, -sine], [sine, cosine]]) @ corner
    wanted = turned + np.array([0.3 * math.sin(2.0), 1.0])
    reached = (result.fields.points + result.fields["displacement"][-1])[0]
    assert result.fields.points[0] == pytest.approx(corner)
    assert reached == pytest.approx(wanted, abs=1e-13)
    # All that it has, it has from what guides it.
    gained = history["kinetic"][-1] - history["kinetic"][0]
    assert history["prescribed"][-1] == pytest.approx(gained, rel=1e-12)
    assert np.abs(history["defect"]).max() < 1e-13


def test_what_guides_a_body_bears_its_inertia(tmp_path):
    """Closed form: m a, in the mean of every step."""
    step = 0.01
    body = carom.RigidBody(name="b", mass=2.0, mesh=SQUARE)
    motion = carom.Guided(body="b", x="0.5*t^2", y=0.0, turn_z=0.0)
    case = flying(
        body, dimension=2, end_time=0.5, time_step=step, motions=[motion], gravity=[0.0, -10.0]
    )
    history = run(tmp_path, case).history
    assert history["b.force_x"][-1] == pytest.approx(2.0, rel=1e-11)
    assert history["b.force_y"][-1] == pytest.approx(20.0, rel=1e-11)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_wheel_on_a_fixed_axle_spins_up_under_a_moment(tmp_path, dimension):
    """Closed form: φ'' = M/J."""
    inertia, moment = 0.4, 0.7
    if dimension == 2:
        body = carom.RigidBody(name="b", mass=2.0, inertia=inertia, mesh=SQUARE)
        motion = carom.Guided(body="b", x=0.0, y=0.0)
    else:
        body = carom.RigidBody(name="b", mass=2.0, inertia=[1.0, 1.2, inertia], mesh=CUBE)
        motion = carom.Guided(body="b", x=0.0, y=0.0, z=0.0, turn_x=0.0, turn_y=0.0)
    load = carom.Resultant(body="b", moment=moment if dimension == 2 else [0.0, 0.0, moment])
    case = flying(
        body, dimension=dimension, end_time=1.0, time_step=0.01, motions=[motion], loads=[load]
    )
    result = run(tmp_path, case)
    rate = result.history["b.spin"] if dimension == 2 else spin(result.history, "b")[:, 2]
    assert result.summary["dofs"] == 1
    assert rate[-1] == pytest.approx(moment / inertia, rel=1e-12)
    assert result.history["external"][-1] == pytest.approx(result.history["kinetic"][-1], rel=1e-12)


def test_a_free_fall_beside_a_guide(tmp_path):
    """What is not guided is free: along y it falls, along x it goes as told."""
    body = carom.RigidBody(name="b", mass=2.0, mesh=SQUARE, velocity=[9.0, 1.0], spin=2.0)
    case = flying(
        body,
        dimension=2,
        end_time=1.0,
        time_step=0.01,
        motions=[carom.Guided(body="b", x="0.25*t")],
        gravity=[0.0, -10.0],
    )
    history = run(tmp_path, case).history
    assert history["b.v_x"][0] == pytest.approx(0.25, rel=1e-14)
    assert history["b.x"][-1] == pytest.approx(0.25, rel=1e-13)
    assert history["b.y"][-1] == pytest.approx(1.0 - 5.0, rel=1e-13)
    assert history["b.spin"][-1] == pytest.approx(2.0, rel=1e-12)
    assert np.abs(history["prescribed"]).max() < 1e-14 * history["kinetic"][-1]


def test_a_turning_drum_drags_what_it_presses(tmp_path):
    """A rigid disc that turns on a block that slides on the floor: friction does the work."""
    friction, weight, gravity, rate = 0.2, 3.0, 10.0, 1.0
    disc = carom.RigidBody(
        name="drum", mass=weight, mesh=carom.Disc(centre=[0.0, 1.0], radius=1.0, divisions=2)
    )
    block = carom.RigidBody(
        name="block",
        mass=1.0,
        mesh=carom.Rectangle(corner=[-4.0, -0.5], size=[8.0, 0.5], divisions=[8, 1]),
    )
    ground = carom.Plane(name="ground", point=[0.0, -0.5], normal=[0.0, 1.0])
    end = 1e-3
    case = carom.Scenario(
        analysis=carom.Dynamic(end_time=end, time_step=1e-5, gravity=[0.0, -gravity]),
        bodies=[disc, block],
        obstacles=[ground],
        motions=[carom.Guided(body="drum", x=0.0, turn_z=f"{rate}*t")],
        contact=carom.Contact(
            condition="endpoint",
            friction=friction,
            pairs=[carom.Pair(between=("block", "ground"), friction=0.0)],
        ),
        output=carom.Output(history_every=end, fields_every=end),
    )
    history = run(tmp_path, case).history
    # What presses is its weight, less what lets its centre follow the corner that it
    # turns on, but for half a step at the start.
    pressing = weight * (gravity - rate**2)
    assert history["block.v_x"][-1] == pytest.approx(friction * pressing * end, rel=1e-3)


@pytest.mark.parametrize("condition", ["midpoint", "gap", "endpoint"])
@pytest.mark.parametrize(
    "guide",
    [
        {"x": "0.1*t"},
        {"x": "0.1*t", "turn_z": "2*t"},
    ],
)
def test_what_guides_a_body_that_lands_is_in_the_books(tmp_path, condition, guide):
    """Friction on landing pulls at what moves as told: the work of that is of the guide."""
    body = carom.RigidBody(
        name="b",
        mass=2.0,
        mesh=carom.Box(corner=[0.1, 0.2, 0.05], size=[0.4, 0.3, 0.2], divisions=[1, 1, 1]),
    )
    case = flying(
        body,
        dimension=3,
        end_time=0.2,
        time_step=2e-3,
        motions=[carom.Guided(body="b", **guide)],
        gravity=[0.0, 0.0, -9.81],
        obstacles=[carom.Plane(name="floor", point=[0.0] * 3, normal=[0.0, 0.0, 1.0])],
        contact=carom.Contact(condition=condition, friction=0.3),
    )
    result = run(tmp_path, case)
    history = result.history
    assert history["friction"][-1] > 1e-3
    assert np.abs(history["defect"]).max() < 1e-12 * np.max(history["total"])


@pytest.mark.parametrize(
    ("motion", "message"),
    [
        ({"kind": "fixed", "body": "b", "on": "left"}, "its nodes move as one; choose"),
        ({"kind": "guided", "body": "soft", "x": 0.0}, "deforms and is guided by none"),
        ({"kind": "guided", "body": "b"}, "give one of x, y, z, turn_x, turn_y, turn_z"),
        ({"kind": "guided", "body": "b", "turn_x": 0.0}, "a body of the plane turns about z"),
        ({"kind": "guided", "body": "b", "z": 0.0}, "there are 2 dimensions; leave it out"),
        ({"kind": "guided", "body": "b", "x": 1.0}, "where the run starts from none"),
        ({"kind": "guided", "body": "round", "x": 0.0}, "moves along y alone"),
    ],
)
def test_what_cannot_be_guided_is_refused(tmp_path, motion, message):
    with pytest.raises(carom.InputError, match=message):
        run(tmp_path, carom.Scenario.from_dict(three(motions=[motion])))


def test_a_body_is_guided_once(tmp_path):
    motions = [{"kind": "guided", "body": "b", axis: 0.0} for axis in ("x", "y")]
    with pytest.raises(carom.InputError, match=r"is guided by motions\.0 already"):
        run(tmp_path, carom.Scenario.from_dict(three(motions=motions)))


@pytest.mark.parametrize(
    ("load", "message"),
    [
        ({"body": "soft", "force": [0.0, 1.0]}, "a resultant acts on a rigid body"),
        ({"body": "b"}, "give a force or a moment"),
        ({"body": "b", "moment": [0.0, 0.0, 1.0]}, "a moment in 2D is a number"),
    ],
)
def test_a_resultant_that_cannot_act_is_refused(tmp_path, load, message):
    load = {"kind": "resultant", **load}
    with pytest.raises(carom.InputError, match=message):
        run(tmp_path, carom.Scenario.from_dict(three(loads=[load])))


def three(**given):
    """A rigid body, one of revolution, and one that deforms."""
    square = {"kind": "rectangle", "corner": [0.0, 0.0], "size": [1.0, 1.0], "divisions": [1, 1]}
    elastic = {"kind": "linear-elastic", "young": 1.0, "poisson": 0.3, "density": 1.0}
    return {
        "analysis": {"end_time": 1e-3, "time_step": 1e-3},
        "materials": {"elastic": elastic},
        "bodies": [
            {"kind": "rigid", "name": "b", "density": 1.0, "mesh": square},
            {
                "kind": "rigid",
                "name": "round",
                "density": 1.0,
                "hypothesis": "axisymmetric",
                "mesh": {**square, "corner": [0.0, 2.0]},
            },
            {"name": "soft", "material": "elastic", "mesh": {**square, "corner": [3.0, 0.0]}},
        ],
        "contact": {
            "pairs": [{"between": ["round", of], "enabled": False} for of in ("b", "soft")]
        },
        **given,
    }
