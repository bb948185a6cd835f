"""Platens: rigid bodies that press, driven by a force or along a path."""

import numpy as np
import pytest
from rigid_bodies import run

import carom

WEIGHT = 100.0


def pressed(dimension, *, motion, force=None, analysis=None, condition="gap", friction=0.3):
    """A rigid plate on an elastic block whose bottom is held."""
    sides = dimension - 1
    plan = [-0.25] * sides
    if dimension == 2:
        block = carom.Rectangle(corner=[0.0, 0.0], size=[1.0, 1.0], divisions=[4, 4])
        plate = carom.Rectangle(corner=[*plan, 1.0], size=[1.5, 0.25], divisions=[3, 1])
    else:
        block = carom.Box(corner=[0.0] * 3, size=[1.0] * 3, divisions=[2] * 3)
        plate = carom.Box(corner=[*plan, 1.0], size=[1.5, 1.5, 0.25], divisions=[3, 3, 1])
    return carom.Scenario(
        dimension=dimension,
        analysis=analysis or carom.Static(end_time=1.0, time_step=0.25),
        materials={"elastic": carom.NeoHookean(young=1000.0, poisson=0.3, density=1.0)},
        bodies=[
            carom.Body(name="block", material="elastic", mesh=block),
            carom.RigidBody(name="plate", mass=5.0, mesh=plate),
        ],
        motions=[carom.Fixed(body="block", on="bottom"), *motion],
        loads=[] if force is None else [carom.Resultant(body="plate", force=force)],
        contact=carom.Contact(condition=condition, friction=friction),
    )


def guide(dimension, **free):
    """All of the plate's motion held but for what is given, or left out as None."""
    held = {"x": 0.0, "y": 0.0, "turn_z": 0.0}
    if dimension == 3:
        held |= {"z": 0.0, "turn_x": 0.0, "turn_y": 0.0}
    return carom.Guided(body="plate", **{k: v for k, v in (held | free).items() if v is not None})


def path(history, axis):
    """The path that the plate took."""
    place = np.asarray(history[f"plate.{axis}"])
    return carom.Table(
        time=[float(t) for t in history["time"]], value=[float(y) for y in place - place[0]]
    )


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_plate_under_a_force_does_what_the_same_plate_does_on_its_path(tmp_path, dimension):
    axis = "xyz"[dimension - 1]
    down = [0.0] * (dimension - 1) + [f"-{WEIGHT}*t"]
    case = pressed(dimension, motion=[guide(dimension, **{axis: None})], force=down)
    # Checked from both sides, there are more reactions than it takes, and not one answer.
    values = {"output.history_every": 0.25, "contact.sources": "first"}
    by_force = run(tmp_path, case.with_values(values))
    taken = path(by_force.history, axis)
    case = pressed(dimension, motion=[guide(dimension, **{axis: taken})])
    by_path = run(tmp_path, case.with_values(values))
    moved = by_force.fields["displacement"][-1]
    size = np.abs(moved).max()
    assert 0.05 < size < 0.2
    assert np.abs(moved - by_path.fields["displacement"][-1]).max() < 1e-8 * size
    # What pushes it does the same work, and the guide bears what the force was.
    work = by_force.history["external"][-1]
    assert by_path.history["prescribed"][-1] == pytest.approx(work, rel=1e-8)
    assert by_path.history[f"plate.force_{axis}"][-1] == pytest.approx(-WEIGHT, rel=1e-8)
    place = np.asarray(by_force.history[f"plate.{axis}"])
    pushed = WEIGHT * np.asarray(by_force.history["time"])
    assert work == pytest.approx(np.sum(0.5 * (pushed[1:] + pushed[:-1]) * -np.diff(place)))
    for result in (by_force, by_path):
        assert np.abs(result.history["defect"]).max() < 1e-12 * work


def test_a_plate_that_may_tilt_balances_on_the_block(tmp_path):
    """Without a guide for its turn, a force in the middle presses it down as one with it does."""
    down = [0.0, f"-{WEIGHT}*t"]
    upright = run(tmp_path, pressed(2, motion=[guide(2, y=None)], force=down))
    free = run(tmp_path, pressed(2, motion=[guide(2, y=None, turn_z=None)], force=down))
    alike = upright.fields["displacement"][-1] - free.fields["displacement"][-1]
    assert np.abs(alike).max() < 1e-9


@pytest.mark.parametrize(
    ("free", "force", "message"),
    [
        ({"x": None, "y": None}, ["5*t", f"-{WEIGHT}*t"], "free to slide along x"),
        ({"y": None}, [0.0, f"{WEIGHT}*t"], "free to (move|slide) along y"),
    ],
)
def test_a_plate_that_nothing_holds_is_said_to_be_free(tmp_path, free, force, message):
    case = pressed(2, motion=[guide(2, **free)], force=force, friction=0.0)
    with pytest.raises(carom.ConvergenceError, match=f'body "plate" is not held.*{message}'):
        run(tmp_path, case)


def test_a_plate_that_nothing_keeps_from_turning_is_said_to_be_free(tmp_path):
    case = pressed(2, motion=[guide(2, turn_z=None)])
    apart = carom.Pair(between=("plate", "block"), enabled=False)
    moment = carom.Resultant(body="plate", moment="3*t")
    contact = case.contact.model_copy(update={"pairs": (apart,)})
    case = case.model_copy(update={"loads": (moment,), "contact": contact})
    with pytest.raises(carom.ConvergenceError, match=r'body "plate" is not held.*turn about z'):
        run(tmp_path, case)


def test_a_plate_with_mass_under_a_force_does_what_its_path_makes_it_do(tmp_path):
    """In dynamics: the block feels where the plate is, whatever brings it there."""
    step, steps = 1e-3, 50
    analysis = carom.Dynamic(end_time=steps * step, time_step=step)
    output = {"output.history_every": step, "output.fields_every": steps * step}
    down = [0.0, f"-{WEIGHT}"]
    case = pressed(2, motion=[guide(2, y=None)], force=down, analysis=analysis)
    by_force = run(tmp_path, case.with_values(output))
    taken = path(by_force.history, "y")
    case = pressed(2, motion=[guide(2, y=taken)], analysis=analysis)
    by_path = run(tmp_path, case.with_values(output))
    moved = by_force.fields["displacement"][-1]
    size = np.abs(moved).max()
    assert np.abs(moved - by_path.fields["displacement"][-1]).max() < 1e-8 * size
    for result in (by_force, by_path):
        energy = np.abs(result.history["total"]).max()
        assert np.abs(result.history["defect"]).max() < 1e-12 * energy
    # The force has done the plate's kinetic energy besides, which its path does not know.
    place = np.asarray(by_force.history["plate.y"])
    work = by_force.history["external"][-1]
    assert work == pytest.approx(WEIGHT * (place[0] - place[-1]), rel=1e-12)


def test_a_plate_with_mass_comes_to_rest_where_statics_says(tmp_path):
    """By a scheme that takes all that swings."""
    down = [0.0, f"-{WEIGHT}*min(t, 1)"]
    motion = [guide(2, y=None)]
    static = run(tmp_path, pressed(2, motion=motion, force=down, friction=0.0))
    analysis = carom.Dynamic(end_time=5.0, time_step=2e-2, scheme=carom.Theta(theta=1.0, xi=1.0))
    case = pressed(2, motion=motion, force=down, analysis=analysis, friction=0.0)
    rest = run(tmp_path, case)
    assert rest.history["plate.y"][-1] == pytest.approx(static.history["plate.y"][-1], abs=2e-6)
