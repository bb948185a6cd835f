"""Springs and dampers, beside closed forms: oscillators, dry friction, stick–slip, exact books."""

import numpy as np
import pytest
from runs import simulate
from springs import (
    AMPLITUDE,
    BLOCK,
    DAMPING,
    FLOOR,
    LENGTH,
    MASS,
    OMEGA,
    SLIP,
    SPEED,
    STIFFNESS,
    WALL,
    WEIGHT,
    block,
    decrements,
    oscillator,
    rubbed,
    scenario,
    stick_slip,
    swing,
)

import carom

SCHEMES = {
    "conserving": carom.Conserving(),
    "midpoint rule": carom.Theta(theta=0.5, xi=0.5),
    "theta": carom.Theta(theta=0.6, xi=0.7),
}


def largest_defect(run, size):
    return np.abs(run.history["defect"]).max() / size


def test_an_oscillator_turns_in_its_phase_plane_and_keeps_its_energy():
    places, _, drift = swing(oscillator(steps_per_period=40, periods=100.0))
    assert places < 1e-10
    assert drift < 1e-12


def test_its_period_converges_with_the_square_of_the_step():
    coarse, fine = (swing(oscillator(steps_per_period=n, periods=3.0))[1] for n in (40, 80))
    assert coarse / fine == pytest.approx(4.0, rel=0.02)


def test_a_damped_oscillator_has_its_logarithmic_decrement():
    errors, order = decrements()
    assert errors[-1] < 5e-4
    assert order > 1.9


@pytest.mark.parametrize("scheme", SCHEMES)
def test_dampers_take_what_their_ledger_says(scheme):
    run = oscillator(steps_per_period=40, periods=3.0, damping=DAMPING, scheme=SCHEMES[scheme])
    taken = run.history["dampers"]
    assert taken[-1] > 0.4 * run.summary["energy"]["initial"]
    assert np.diff(taken).min() >= 0.0
    assert largest_defect(run, run.summary["energy"]["initial"]) < 1e-12
    # The body received what the spring stores, its damper took and the scheme did, but for signs.
    body = run.summary["bodies"][0]
    assert body["connections"] < 0.0
    assert body["contact"] == 0.0


def test_dry_friction_takes_its_part_of_the_amplitude_in_every_half_cycle():
    reached, wanted, history = rubbed()
    assert reached == pytest.approx(wanted, abs=1e-6 * wanted[0])
    assert len(wanted) >= 5
    assert abs(wanted[-1]) <= 0.1 * WEIGHT / STIFFNESS, "it stops where the spring is too weak"
    assert np.abs(history["defect"]).max() < 1e-11


def test_stick_slip_on_a_belt_is_that_of_the_closed_form():
    step = 1e-3
    errors = stick_slip(step)
    assert max(errors[:2]) < 2.0 * step / SLIP
    assert max(errors[2:]) < 2.0 * step * OMEGA
    assert AMPLITUDE > 0.0


BAR = {
    "name": "bar",
    "material": "soft",
    "mesh": carom.Rectangle(corner=[1.2, -0.3], size=[0.9, 0.5], divisions=[3, 2]),
    "velocity": [-0.4, 0.6],
}
SOFT = {"soft": carom.NeoHookean(young=2e3, poisson=0.3, density=2.0)}


def pair(*, scheme=None, damping=0.0, stiffness=30.0, free_length=0.4):
    """A rigid block and a soft bar that fly, joined by a spring between a corner and a side."""
    bodies = [block(velocity=[0.5, -0.2], spin=1.5), carom.Body(**BAR)]
    ends = (
        carom.Place(body="block", point=[0.4, 0.3]),
        carom.Place(body="bar", on="left"),
    )
    joint = carom.Spring(
        name="joint", between=ends, stiffness=stiffness, damping=damping, free_length=free_length
    )
    return scenario(bodies, [joint], time_step=5e-3, end_time=1.5, scheme=scheme, materials=SOFT)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_two_free_bodies_on_a_spring_keep_their_momenta(scheme):
    run = simulate(pair(scheme=SCHEMES[scheme], damping=0.3))
    history, initial = run.history, run.summary["energy"]["initial"]
    assert np.ptp(history["joint.length"]) > 0.5, "they swing"
    for column in ("momentum_x", "momentum_y"):
        assert np.ptp(history[column]) < 1e-12
    if scheme == "conserving":
        assert np.ptp(history["angular_momentum"]) < 1e-11
        assert largest_defect(run, initial) < 1e-11


def test_energy_stays_whatever_a_spring_is_stiff():
    """Up to a thousand times as stiff as a cell, and as much again."""
    # The round-off of places, times the stiffness, is what is left. Measured: 2.8e-11 and 3.6e-8.
    for stiffness, drift in ((1.0, 1e-12), (1e3, 1e-12), (2e6, 1e-10), (2e9, 1e-7)):
        run = simulate(pair(stiffness=stiffness, free_length=None))
        assert np.abs(run.curve("total") - 1.0).max() < drift, stiffness
        if stiffness < 1e9:
            assert run.history["retried_steps"].max() == 0.0, stiffness
            assert run.history["newton_iterations"].max() < 15.0, stiffness


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_motion_does_not_depend_on_the_frame(dimension):
    """The same masses on a rope, turned and flying by: lengths are the same."""
    rope = carom.ForceTable(elongation=[-1.0, 0.0, 0.2, 1.0], force=[0.0, 0.0, 4.0, 60.0])
    lengths = []
    angle = np.radians(37.0)
    for turn, wind in ((np.eye(dimension), 0.0), (_turn(dimension, angle), 3.0)):
        drift = wind * np.arange(1.0, dimension + 1.0)
        bodies, places = [], []
        for name, centre, velocity in (
            ("one", [0.0] * dimension, [0.2, 0.5, 0.1][:dimension]),
            ("two", [2.0, 0.5, -0.3][:dimension], [0.9, -0.4, 0.0][:dimension]),
        ):
            at = turn @ np.array(centre)
            kind = {"kind": "disc"} if dimension == 2 else {"kind": "ball"}
            mesh = {**kind, "centre": at.tolist(), "radius": 0.2, "divisions": 4}
            bodies.append(
                {
                    "kind": "rigid",
                    "name": name,
                    "mass": 1.5,
                    "mesh": mesh,
                    "velocity": (turn @ np.array(velocity) + drift).tolist(),
                }
            )
            places.append({"body": name, "point": at.tolist()})
        case = carom.Scenario(
            dimension=dimension,
            analysis={"end_time": 4.0, "time_step": 0.01, "newton": {"tolerance": 1e-12}},
            bodies=bodies,
            springs=[{"name": "rope", "between": places, "force": rope, "damping": 0.1}],
            output={"history_every": 0.01, "fields_every": 1.0},
        )
        lengths.append(simulate(case).history["rope.length"])
    assert np.ptp(lengths[0]) > 0.2
    assert lengths[1] == pytest.approx(lengths[0], rel=1e-11)


def _turn(dimension, angle):
    """A rotation, in space about an oblique axis."""
    if dimension == 2:
        c, s = np.cos(angle), np.sin(angle)
        return np.array([[c, -s], [s, c]])
    x, y, z = np.array([1.0, 2.0, 2.0]) / 3.0
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def test_units_do_not_matter():
    """Metres and kilograms against millimetres and tonnes, of lengths over the first."""
    lengths = []
    for metre, kilogram in ((1.0, 1.0), (1e3, 1e-3)):
        mesh = BLOCK.model_copy(
            update={"corner": (-0.5 * metre, -0.5 * metre), "size": (metre, metre)}
        )
        case = scenario(
            [
                carom.RigidBody(
                    name="block", mass=MASS * kilogram, mesh=mesh, velocity=[SPEED * metre, metre]
                )
            ],
            [
                carom.Spring(
                    name="spring",
                    between=(
                        carom.Place(point=[-LENGTH * metre, 0.0]),
                        carom.Place(body="block", point=[0.1 * metre, 0.2 * metre]),
                    ),
                    stiffness=STIFFNESS * kilogram,
                )
            ],
            time_step=0.01,
            end_time=2.0,
        )
        lengths.append(simulate(case).history["spring.length"] / metre)
    assert lengths[1] == pytest.approx(lengths[0], rel=1e-12)


def test_a_rope_is_slack_until_it_pulls():
    rope = carom.ForceTable(elongation=[-1.0, 0.0, 1.0], force=[0.0, 0.0, STIFFNESS])
    case = scenario(
        [block(velocity=[SPEED, 0.0])],
        [
            carom.Spring(
                name="rope",
                between=(WALL, carom.Place(body="block", point=[0, 0])),
                force=rope,
                free_length=LENGTH + 0.2,
            )
        ],
        time_step=2e-3,
        end_time=0.4 + np.pi / OMEGA + 0.4,
    )
    run = simulate(case)
    time, x = run.history["time"], run.history["block.x"]
    early = time < 0.4
    assert x[early] == pytest.approx(SPEED * time[early], abs=1e-12)
    assert run.history["rope.force"][early].max() == 0.0
    assert x.max() == pytest.approx(0.2 + SPEED / OMEGA, rel=1e-4)
    # It comes back as fast as it went.
    assert run.history["block.v_x"][-1] == pytest.approx(-SPEED, rel=1e-12)


def hanging(springs, law, *, cells, weight, time_step):
    """A block of 1 m and 1 kg that its weight pulls down, in load steps."""
    block = carom.Rectangle(corner=[-0.5, -0.5], size=[1.0, 1.0], divisions=[cells, cells])
    return carom.Scenario(
        dimension=2,
        analysis=carom.Static(end_time=1.0, time_step=time_step, gravity=[0.0, -weight]),
        bodies=[carom.Body(name="block", material="soft", mesh=block)],
        materials={"soft": law},
        springs=springs,
        output=carom.Output(history_every=time_step, fields_every=1.0),
    )


def test_springs_bear_a_load_in_statics():
    """A block hangs from two springs side by side, and its weight stretches them by m g/2k."""
    posts = [
        carom.Spring(
            name=name,
            between=(carom.Place(body="block", point=[x, 0.5]), carom.Place(point=[x, 2.0])),
            stiffness=STIFFNESS,
        )
        for name, x in (("left", -0.5), ("right", 0.5))
    ]
    soft = carom.LinearElastic(young=1e4, poisson=0.0, density=1.0)
    run = simulate(hanging(posts, soft, cells=2, weight=10.0, time_step=0.25))
    for post in ("left", "right"):
        assert run.history[f"{post}.force"][-1] == pytest.approx(5.0, rel=1e-6)
        assert run.history[f"{post}.length"][-1] == pytest.approx(1.6, rel=1e-6)


@pytest.mark.parametrize("stiffness", [1e-2, 1.0, 1e3, 1e7, 1e9])
def test_a_block_on_three_springs_bears_its_weight_however_stiff_they_are(stiffness):
    """From a millionth of what a cell resists with to a hundred thousand times as much."""
    weight = min(1.0, 0.1 * stiffness)
    joints = [
        carom.Spring(
            name=name,
            between=(carom.Place(body="block", point=at), carom.Place(point=to)),
            stiffness=stiffness,
        )
        for name, at, to in (
            ("left", [-0.5, 0.5], [-0.5, 2.0]),
            ("right", [0.5, 0.5], [0.5, 2.0]),
            ("side", [0.5, 0.5], [2.0, 0.5]),
        )
    ]
    soft = carom.NeoHookean(young=1e4, poisson=0.3, density=1.0)
    run = simulate(hanging(joints, soft, cells=3, weight=weight, time_step=0.5))
    borne = run.history["left.force"][-1] + run.history["right.force"][-1]
    assert borne == pytest.approx(weight, rel=1e-2)
    assert run.history["retried_steps"].max() == 0.0
    assert run.history["newton_iterations"].max() < 20.0
    assert np.abs(run.history["defect"]).max() < 1e-11 * np.abs(run.history["external"]).max()


def test_a_spring_pulls_a_block_along_a_floor():
    """Load steps: it sticks until the spring pulls with μ N, and follows it then."""
    hand = carom.Plane(
        name="hand", point=[3.0, 0.0], normal=[-1.0, 0.0], motion=carom.Displacement(x="0.2*t")
    )
    case = carom.Scenario(
        dimension=2,
        analysis=carom.Static(end_time=1.0, time_step=0.1, gravity=[0.0, -10.0]),
        bodies=[
            carom.Body(
                name="block",
                material="soft",
                mesh=carom.Rectangle(corner=[-0.5, -0.5], size=[1.0, 1.0], divisions=[3, 3]),
            )
        ],
        materials={"soft": carom.NeoHookean(young=1e4, poisson=0.3, density=1.0)},
        springs=[
            carom.Spring(
                name="rope",
                between=(
                    carom.Place(body="block", on="right"),
                    carom.Place(obstacle="hand", point=[2.0, 0.0]),
                ),
                stiffness=100.0,
            )
        ],
        obstacles=[FLOOR, hand],
        contact=carom.Contact(friction=0.3),
        output=carom.Output(history_every=0.1, fields_every=1.0),
    )
    history = simulate(case).history
    # It sticks, and gives way a little.
    assert history["rope.force"][1] == pytest.approx(2.0, rel=5e-2)
    # It slides, and leans into the pull: the line of the rope tilts by as much.
    assert history["rope.force"][-1] == pytest.approx(3.0, rel=5e-4)
    assert np.abs(history["defect"]).max() < 1e-12 * history["prescribed"][-1]
