"""Bodies of another code in carom's step: their energy is kept without knowing their law."""

import re

import numpy as np
import pytest

import carom
from carom.building.build import build
from grazing_discs import LAW, TIME_STEP, discs
from plain_fem import Triangles, outer_edges


def foreign(case, **kwargs):
    """The bodies of a case by a code of another's, each with unknowns in an order of its own."""
    mesh = build(case).mesh()
    cells = mesh["connectivity"].reshape(-1, 3)
    bodies, codes = [], []
    for index, body in enumerate(case.bodies):
        own = cells[mesh["body"] == index]
        first = own.min()
        points = mesh["points"][first : own.max() + 1]
        fem = Triangles(points, own - first, **LAW)
        order = np.random.default_rng(index).permutation(fem.count)
        back = np.argsort(order)
        bodies.append(
            carom.ForeignBody(
                body.name,
                points,
                outer_edges(own - first),
                mass=fem.mass[back][:, back],
                energy=lambda q, fem=fem, order=order: fem.energy(q[order]),
                force=lambda q, fem=fem, order=order, back=back: fem.force(q[order])[back],
                stiffness=lambda q, fem=fem, order=order, back=back: fem.stiffness(q[order])[back][
                    :, back
                ],
                velocity=body.velocity,
                dofs=order.reshape(points.shape),
            )
        )
        codes.append(fem)
    run = carom.ForeignRun(
        bodies,
        case.obstacles,
        time_step=TIME_STEP,
        contact=case.contact,
        newton=case.analysis.newton,
        **kwargs,
    )
    return run, codes


def momenta(run, codes, bodies):
    """Linear and angular momentum of all bodies."""
    linear, angular = np.zeros(2), 0.0
    for fem, body in zip(codes, bodies, strict=True):
        momentum = (fem.mass @ run.velocity(body).ravel()).reshape(-1, 2)
        x = fem.points + run.displacement(body)
        linear += momentum.sum(axis=0)
        angular += float(np.sum(x[:, 0] * momentum[:, 1] - x[:, 1] * momentum[:, 0]))
    return np.array([*linear, angular])


def test_by_the_same_scheme_they_move_as_bodies_of_carom_do(tmp_path):
    """With the paper's scheme nothing but the code that assembles forces is another."""
    case = discs(150)
    history = carom.run(case, out=tmp_path).history
    run, _ = foreign(case, scheme=carom.Theta())
    initial, friction = run.energy, 0.0
    for row in range(1, 151):
        friction += run.step().friction
        # Measured: 9e-14.
        assert abs(run.kinetic - history["kinetic"][row]) < 9e-13 * initial
        assert abs(run.strain - history["strain"][row]) < 9e-13 * initial
        assert abs(friction - history["friction"][row]) < 9e-13 * initial
    assert friction > 0.001 * initial


def test_energy_and_momenta_of_a_collision_are_kept():
    """With the scheme `conserving` and landings that give back what they take."""
    run, codes = foreign(discs(condition="midpoint", friction=0.0))
    names = ["left", "right"]
    initial, start = run.energy, momenta(run, codes, names)
    size = np.abs(start).max()
    for _ in range(200):
        step = run.step()
        assert abs(run.energy - initial) < 2e-13 * initial
        assert abs(step.defect) < 2e-13 * initial
        assert np.abs(momenta(run, codes, names) - start).max() < 1e-12 * size
    assert run.strain > 1e-3 * initial, "they still vibrate"


def test_the_books_close_with_friction():
    run, _ = foreign(discs(condition="midpoint"))
    initial, friction, given = run.energy, 0.0, 0.0
    for _ in range(200):
        step = run.step()
        friction, given = friction + step.friction, given + step.normal_contact
        assert abs(run.energy + friction + given - initial) < 1e-12 * initial
    assert friction > 0.001 * initial
    assert run.law_time > 0.0


def spring(**kwargs):
    """Four masses of a square on springs to their places."""
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    arguments = {
        "mass": np.eye(8),
        "energy": lambda u: 50.0 * u @ u,
        "force": lambda u: 100.0 * u,
        "stiffness": lambda u: 100.0 * np.eye(8),
        "velocity": [0.0, -1.0],
    }
    return carom.ForeignBody(
        "square", corners, [[0, 1], [1, 2], [2, 3], [3, 0]], **(arguments | kwargs)
    )


def test_a_mass_on_a_spring_swings_as_the_scheme_says():
    """Closed form: the trapezoidal rule swings with ω̂ = (2/Δt) arctan(ωΔt/2)."""
    run = carom.ForeignRun([spring()], time_step=1e-2, scheme=carom.Theta())
    frequency = 2.0 / 1e-2 * np.arctan(0.5 * 10.0 * 1e-2)
    for _ in range(200):
        run.step()
        expected = -np.sin(frequency * run.time) / 10.0
        assert np.abs(run.displacement("square") - [0.0, expected]).max() < 1e-12


def test_a_floor_bears_what_a_body_presses_that_is_held_from_above():
    """Closed form: two masses on springs swing, and the floor turns them half way down."""
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    fixed = corners[:, 1:] > 0.5
    fixed = np.column_stack([np.ones(4, dtype=bool), fixed[:, 0]])
    body = spring(fixed=fixed, velocity=[3.0, -1.0])
    floor = carom.Plane(name="floor", point=[0.0, -0.05], normal=[0.0, 1.0])
    contact = carom.Contact(condition="midpoint")
    run = carom.ForeignRun([body], [floor], time_step=1e-2, contact=contact)
    assert run.energy == pytest.approx(1.0, rel=1e-14), "what is held does not move"
    turns, before = 0, -1.0
    for _ in range(300):
        step = run.step()
        assert abs(run.energy - 1.0) < 1e-12
        assert abs(step.defect) < 1e-13
        assert run.displacement("square")[:2, 1].min() > -0.05 - 1e-14
        moved = run.displacement("square")
        assert (moved[:, 0] == 0.0).all()
        assert (moved[2:] == 0.0).all()
        velocity = run.velocity("square")[0, 1]
        turns += before < 0.0 < velocity and moved[0, 1] < -0.04
        before = velocity
    # It swings with ω = 10 from floor to 0.1 and back: two thirds of a period.
    assert abs(turns - 3.0 / (2.0 / 3.0 * 2.0 * np.pi / 10.0)) < 1.5


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"mass": np.eye(7)}, "bodies.square.mass: has shape [7, 7]; must be [8, 8], 2 unknowns"),
        ({"mass": -np.eye(8)}, "bodies.square.mass: the mass of body"),
        ({"velocity": [1.0]}, "bodies.square.velocity: has shape [1]; must be [4, 2] or [2]"),
        ({"fixed": [True]}, "bodies.square.fixed: has shape [1] and type bool; must be true or"),
        ({"dofs": np.zeros((4, 2), int)}, "bodies.square.dofs: must have shape [4, 2] and every"),
        ({"energy": lambda u: u}, "bodies.square.energy: returned [0.0, 0.0"),
        ({"energy": lambda u: np.nan}, "bodies.square.energy: returned nan; must be one finite"),
        ({"force": lambda u: u[1:]}, "bodies.square.force: returned shape [7]; must be [8]"),
        ({"force": lambda u: u + np.inf}, "bodies.square.force: returned inf at [0]; must be"),
        (
            {"velocity": [1e200, 0.0]},
            "bodies: the initial energy is not finite; check velocities, energy and force at rest",
        ),
    ],
)
def test_what_is_no_body_is_refused_at_the_start(wrong, message):
    with pytest.raises(carom.InputError, match=re.escape(message)):
        carom.ForeignRun([spring(**wrong)], time_step=1e-2)


def test_what_is_no_answer_in_a_step_is_refused_there():
    run = carom.ForeignRun([spring(stiffness=lambda u: np.eye(3))], time_step=1e-2)
    message = "bodies.square.stiffness: has shape [3, 3]; must be [8, 8]"
    with pytest.raises(carom.InputError, match=re.escape(message)):
        run.step()

    def fails(u):
        raise RuntimeError("no convergence of the plastic strain")

    run = carom.ForeignRun([spring(stiffness=fails)], time_step=1e-2)
    with pytest.raises(RuntimeError, match="no convergence of the plastic strain"):
        run.step()
    assert run.time == 0.0


def test_values_of_a_run_are_checked():
    with pytest.raises(carom.InputError, match="time_step = 0: must be greater than 0"):
        carom.ForeignRun([spring()], time_step=0.0)
    with pytest.raises(carom.InputError, match="'disc': there is no such body; known: square"):
        carom.ForeignRun([spring()], time_step=1e-2).velocity("disc")
    corners = np.vstack([np.zeros(3), np.eye(3)])
    sides = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]
    laws = {"energy": lambda u: 0.0, "force": lambda u: 0 * u, "stiffness": lambda u: np.eye(12)}
    solid = carom.ForeignBody("solid", corners, sides, mass=np.eye(12), **laws)
    with pytest.raises(carom.InputError, match="some are in the plane and some in space"):
        carom.ForeignRun([spring(), solid], time_step=1e-2)
    with pytest.raises(carom.InputError, match=re.escape("must be [point_count, 2] or")):
        carom.ForeignBody("line", np.zeros((4, 1)), [[0, 1]], mass=np.eye(4), **laws)
