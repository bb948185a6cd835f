"""Friction that depends on the sliding: masses on springs and blocks, beside closed forms."""

import math

import numpy as np
import pytest
from rigid_bodies import run

import carom

MASS, GRAVITY = 1.0, 10.0
LOAD = MASS * GRAVITY


def on_a_spring(friction, *, stiffness, time_step, start=0.0, velocity=0.0, belt=0.0):
    """A mass on a belt that moves, held by a spring that is slack at x = 0."""

    def energy(u):
        x, y = u[0::2], u[1::2]
        return 0.25 * stiffness * np.sum((x + start) ** 2) + 0.5 * LOAD * np.sum(y)

    def force(u):
        f = np.empty(4)
        f[0::2] = 0.5 * stiffness * (u[0::2] + start)
        f[1::2] = 0.5 * LOAD
        return f

    body = carom.ForeignBody(
        "mass",
        [[0.0, 0.0], [1.0, 0.0]],
        [[0, 1]],
        mass=0.5 * MASS * np.eye(4),
        energy=energy,
        force=force,
        stiffness=lambda _: np.diag([0.5 * stiffness, 0.0] * 2),
        velocity=[velocity, 0.0],
    )
    floor = carom.Plane(name="belt", point=[0, 0], normal=[0, 1], velocity=[belt, 0.0])
    return carom.ForeignRun(
        [body], [floor], time_step=time_step, contact=carom.Contact(friction=friction)
    )


def travelled(simulation, steps, start=0.0):
    """Places of the mass after every step."""
    places = np.full(steps + 1, start)
    for k in range(1, steps + 1):
        simulation.step()
        places[k] = start + simulation.displacement("mass")[0, 0]
    return places


def spells(sticks):
    """Lengths of the spells of sticking and of sliding that begin and end, in steps."""
    turns = np.flatnonzero(np.diff(sticks.astype(int)))
    lengths = np.diff(turns)
    first_is_stuck = bool(sticks[turns[0] + 1])
    return lengths[0 if first_is_stuck else 1 :: 2], lengths[1 if first_is_stuck else 0 :: 2]


STATIC, KINETIC, STIFFNESS, BELT = 0.6, 0.3, 100.0, 0.1
OMEGA = math.sqrt(STIFFNESS / MASS)
EXCESS = (STATIC - KINETIC) * LOAD / STIFFNESS
STICK = 2.0 * EXCESS / BELT
SLIP = 2.0 / OMEGA * (math.pi - math.atan(OMEGA * EXCESS / BELT))
AMPLITUDE = math.hypot(EXCESS, BELT / OMEGA)


def stick_slip(time_step):
    """Relative errors of the times of sticking and sliding, and of the amplitude."""
    law = carom.StaticKinetic(static=STATIC, kinetic=KINETIC)
    simulation = on_a_spring(
        law, stiffness=STIFFNESS, time_step=time_step, velocity=BELT, belt=BELT
    )
    x = travelled(simulation, round((STICK + 3.2 * (STICK + SLIP)) / time_step))
    stuck, slid = spells(np.abs(np.diff(x) - BELT * time_step) < 1e-9 * BELT * time_step)
    centre = KINETIC * LOAD / STIFFNESS
    return (
        abs(stuck[:2].mean() * time_step / STICK - 1.0),
        abs(slid[:2].mean() * time_step / SLIP - 1.0),
        abs((x.max() - centre) / AMPLITUDE - 1.0),
        abs((centre - x[len(x) // 3 :].min()) / AMPLITUDE - 1.0),
    )


def test_stick_slip_on_a_belt_has_the_times_and_the_amplitude_of_the_closed_form():
    """A step more of sticking or sliding is the error: T_stick, T_slip and the amplitude."""
    coarse, fine = stick_slip(4e-3), stick_slip(5e-4)
    assert max(fine) < 5e-3
    for errors, step in ((coarse, 4e-3), (fine, 5e-4)):
        assert max(errors[:2]) < 2.0 * step / SLIP
        assert max(errors[2:]) < 2.0 * step * OMEGA


@pytest.mark.parametrize("law", [0.1, {"static": 0.45, "kinetic": 0.1}])
def test_dry_friction_takes_the_same_of_every_half_cycle_until_the_spring_cannot_move_the_mass(law):
    """The amplitude falls by 2 μ_k N/k; the mass stops where k |x| is at most μ_s N."""
    start, step = 0.1, 1e-4
    friction = law if isinstance(law, float) else carom.StaticKinetic(**law)
    held, kinetic = (law, law) if isinstance(law, float) else (law["static"], law["kinetic"])
    simulation = on_a_spring(friction, stiffness=STIFFNESS, time_step=step, start=start)
    x = travelled(simulation, round(2.0 / step), start)
    fall = 2.0 * kinetic * LOAD / STIFFNESS
    wanted = [start]
    while wanted[-1] > held * LOAD / STIFFNESS:
        wanted.append(abs(wanted[-1] - fall))
    turns = [k for k in range(1, len(x) - 1) if (x[k] - x[k - 1]) * (x[k + 1] - x[k]) < 0.0]
    reached = [0.1, *np.abs(x[turns]), abs(x[-1])][: len(wanted)]
    assert reached == pytest.approx(wanted, abs=1e-6 * start)
    assert np.ptp(x[-100:]) < 1e-12
    assert abs(x[-1]) == pytest.approx(wanted[-1], abs=1e-6 * start)


def test_slip_weakening_takes_its_fracture_energy():
    """Friction takes N (μ_k S + (μ_s − μ_k) D_c/2) over a slip S beyond D_c."""
    critical = 0.02
    law = carom.StaticKinetic(static=0.6, kinetic=0.2, distance=critical)
    simulation = on_a_spring(law, stiffness=2000.0, time_step=1e-4, velocity=BELT, belt=BELT)
    taken, slip, largest = 0.0, 0.0, 0.0
    place = 0.0
    for _ in range(5000):
        step = simulation.step()
        now = simulation.displacement("mass")[0, 0]
        taken += step.friction
        slip += abs(now - place - BELT * 1e-4)
        place = now
        largest = max(largest, abs(step.defect))
        assert step.certificate < 1e-12
    assert slip > 1.5 * critical
    wanted = LOAD * (0.2 * slip + 0.5 * (0.6 - 0.2) * critical)
    assert taken == pytest.approx(wanted, rel=1e-5)
    assert largest < 1e-13


def sliding_block(friction, **given):
    """A rigid block that slides on a floor."""
    step = given.pop("time_step", 1e-3)
    return carom.Scenario(
        dimension=2,
        analysis=carom.Dynamic(
            end_time=given.pop("end_time", 0.3),
            time_step=step,
            scheme=carom.Conserving(),
            gravity=[0.0, -GRAVITY],
        ),
        bodies=[
            carom.RigidBody(
                name="block",
                mass=MASS,
                mesh=carom.Rectangle(corner=[0.0, 0.0], size=[1.0, 0.1], divisions=[1, 1]),
                velocity=[1.0, 0.0],
            )
        ],
        obstacles=[carom.Plane(name="floor", point=[0, 0], normal=[0, 1])],
        contact=carom.Contact(friction=friction, **given),
        output=carom.Output(history_every=step, fields_every=0.1, checkpoint_every=0.1),
    )


@pytest.mark.parametrize("condition", ["midpoint", "gap", "endpoint"])
def test_viscous_friction_slows_a_block_as_an_exponential_does(tmp_path, condition):
    """m v' = −N (μ + c v), for every condition that a law goes with."""
    mu, viscous = 0.1, 0.4
    law = carom.StaticKinetic(kinetic=mu, viscous=viscous)
    result = run(tmp_path, sliding_block(law, condition=condition))
    history, time = result.history, np.asarray(result.history["time"])
    exact = (1.0 + mu / viscous) * np.exp(-GRAVITY * viscous * time) - mu / viscous
    assert result.summary["status"] == "completed"
    # Velocities at the end of a step, friction of its mean velocity: second order.
    worst = np.abs(history["block.v_x"] - np.maximum(exact, 0.0)).max()
    assert worst < (1e-5 if condition != "endpoint" else 2e-3)
    assert history["friction_defect"].max() < 1e-9


def test_a_formula_is_the_law_that_it_writes_out(tmp_path):
    written = carom.StaticKinetic(static=0.4, kinetic=0.1, speed=0.3, viscous=0.05)
    formula = carom.FrictionFormula(formula="0.1 + 0.3*exp(-v/0.3) + 0.05*v")
    one, other = (run(tmp_path, sliding_block(law)) for law in (written, formula))
    for name in ("block.v_x", "friction", "certificate"):
        assert np.asarray(one.history[name]) == pytest.approx(
            np.asarray(other.history[name]), abs=1e-13
        )
    assert one.summary["status"] == other.summary["status"] == "completed"
