"""What cannot be is refused with its place, its value and what to do."""

import json
import re

import numpy as np
import pytest

import carom
from carom import InputError, _carom, contact

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
EDGES = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
FLOOR = carom.Plane(name="floor", point=[0.0, -0.01], normal=[0.0, 1.0])


def model(**kwargs):
    arguments = {
        "points": SQUARE,
        "surfaces": [contact.Surface("square", EDGES)],
        "obstacles": [FLOOR],
    }
    return contact.ContactModel(**(arguments | kwargs))


def refuses(message):
    return pytest.raises(InputError, match=re.escape(message))


def test_facets_that_are_no_surface():
    with refuses("surfaces.square.facets: has shape [8] and type int64; must be integers of shape"):
        contact.Surface("square", EDGES.ravel())
    with refuses("surfaces.square.facets: has shape [4, 2] and type float64; must be integers"):
        contact.Surface("square", EDGES.astype(float))
    with refuses("surfaces.square.facets: facet 1 has node -2; nodes are numbered from 0"):
        contact.Surface("square", [[0, 1], [1, -2]])
    with refuses("surfaces.square.facets: there are none; give one at least"):
        contact.Surface("square", np.empty((0, 2), dtype=int))
    for facets, message in (
        (EDGES + 1, "facet 2 has node 4, and there are 4 points; nodes are numbered from 0"),
        ([[0, 1, 2, 3]], "facet 0 has 4 nodes; in the plane it has 2 or 3"),
        ([[0, 1], [2, 2]], "facet 1 has node 2 twice; leave facets without area out"),
        ([[0, 1], [1, 0]], "facet 1 has the nodes of facet 0; give every facet once"),
    ):
        with refuses(f"surfaces.square.facets: {message}"):
            model(surfaces=[contact.Surface("square", facets)])
    with refuses("in space it has 3, 4, 6, 8 or 9"):
        contact.ContactModel(np.eye(3), [contact.Surface("line", [[0, 1]])])
    triangles = [[0, 1, 2], [1, 2, 3], [2, 3, 4], [3, 4, 0], [4, 0, 1]]
    with refuses("the facets around facet"):
        points = np.random.default_rng(0).standard_normal((5, 3))
        contact.ContactModel(points, [contact.Surface("band", triangles)])


def test_surfaces_share_neither_nodes_nor_names():
    halves = [contact.Surface("lower", EDGES[:2]), contact.Surface("upper", EDGES[2:])]
    with refuses(
        'surfaces.upper.facets: node 0 is one of surface "lower" too; give each body one surface'
    ):
        model(surfaces=halves)
    with refuses("'floor' is the name of two surfaces or obstacles"):
        model(surfaces=[contact.Surface("floor", EDGES)])
    with refuses("surfaces: there is none; give the boundary of one body at least"):
        model(surfaces=[])


def test_arrays_that_do_not_fit():
    with refuses("points has shape [4]; must be [point_count, 2] or [point_count, 3]"):
        model(points=np.zeros(4))
    with refuses("points[1, 0] = nan: must be finite"):
        model(points=np.where(SQUARE == 1.0, np.nan, SQUARE))
    with refuses("dofs has shape [8] and type int64; must be integers of shape [4, 2]"):
        model(dofs=np.arange(8))
    with refuses("dof_count = 3: dofs has 7; must be at least 8"):
        model(dof_count=3)
    touch = model()
    with refuses("points has shape [3, 2]; must be [4, 2], one row for each point"):
        touch.search(SQUARE[:3], reach=0.1)
    with refuses("velocity[0, 0] = inf: must be finite"):
        touch.search(SQUARE, velocity=np.full((4, 2), np.inf), time_step=1.0)


def test_values_out_of_range():
    with refuses('condition = "gaps"'):
        model(condition="gaps")
    with refuses('"massless" changes the mass of the bodies, which are not carom\'s'):
        model(condition="massless")
    with refuses('load steps without inertia rule the gap at their end; write condition = "gap"'):
        model(condition="midpoint", theta=None)
    with refuses("theta must be greater than 0 and at most 1"):
        model(theta=0.0)
    with refuses("pairs.0.between: 'flor': did you mean \"floor\"?"):
        model(pairs=[carom.Pair(between=["square", "flor"])])
    with refuses("pairs.0.interference: only runs of carom have it; leave it out"):
        model(pairs=[carom.Pair(between=["square", "floor"], interference=1e-3)])


def test_how_far_to_look_has_to_be_known():
    touch = model()
    with refuses(
        "velocity is missing: give it with time_step, so that it is known how far to look"
    ):
        touch.search(SQUARE)
    with refuses("time_step is missing, and there is a velocity"):
        touch.search(SQUARE, velocity=np.zeros((4, 2)))
    with refuses("reach = -1: must be greater than 0"):
        touch.search(SQUARE, reach=-1.0)
    falling = carom.Plane(name="floor", point=[0.0, -0.01], normal=[0.0, 1.0], velocity=[0.0, 1.0])
    with refuses("time_step is missing, and obstacle 'floor' moves"):
        model(obstacles=[falling]).search(SQUARE, reach=0.1)
    with refuses(
        "velocity is missing: give it with time_step, so that it is known what the condition rules"
    ):
        model(condition="endpoint").search(SQUARE, reach=0.1)


def test_a_step_has_an_order():
    touch = model()
    with refuses("nothing was evaluated in this step: search and evaluate first"):
        touch.missed(SQUARE)
    old = touch.search(SQUARE, reach=0.1)
    candidates = touch.search(SQUARE, reach=0.1)
    with refuses("candidates are of search 1, and the last is 2: search at the start of each step"):
        touch.evaluate(old, SQUARE)
    stale = touch.evaluate(candidates, SQUARE)
    contacts = touch.evaluate(candidates, SQUARE)
    with refuses("contacts are not those that were last evaluated: evaluate, then solve"):
        contact.solve(stale, lambda b: b, free=np.zeros(8))
    with refuses("the contacts have no reactions: solve first, or give reactions"):
        touch.accept(SQUARE)
    with refuses("free has shape [7]; must be [8], one number for each unknown"):
        contact.solve(contacts, lambda b: b, free=np.zeros(7))
    with refuses(
        "solver: a force along the normal of contact 0 moves it by -1 m/N; K̄ must be positive"
    ):
        contact.solve(contacts, lambda b: -b, free=np.zeros(8))
    with refuses("solver: its answer is nan at [0, 0]; K̄ must be regular"):
        contact.solve(contacts, lambda b: b * np.nan, free=np.zeros(8))
    contact.solve(contacts, lambda b: b, free=np.zeros(8))
    touch.accept(SQUARE)
    with refuses("nothing was evaluated in this step"):
        touch.accept(SQUARE)


def test_a_problem_without_a_solution_is_told_with_the_problem():
    touch = model(
        solver=carom.FrictionSolver(max_iterations=1, kind="gauss-seidel", tolerance=1e-15),
        friction=0.3,
    )
    candidates = touch.search(SQUARE, reach=0.1)
    contacts = touch.evaluate(candidates, SQUARE - [0.0, 0.02])
    stiffness = np.random.default_rng(1).standard_normal((8, 8))
    inverse = np.linalg.inv(stiffness @ stiffness.T + np.eye(8))
    with pytest.raises(
        carom.ConvergenceError, match="the contact problem of 2 contacts ended as"
    ) as refused:
        contact.solve(contacts, lambda b: inverse @ b, free=np.full(8, -0.02))
    assert len(refused.value.problem.mu) == 2
    assert refused.value.report["friction"]["status"] == "iteration-limit"
    with refuses("the contacts have no reactions: solve first, or give reactions"):
        touch.accept(SQUARE)


def test_what_passes_python_by_is_refused_by_the_core():
    spec = json.dumps({"obstacles": [], "contact": contact_data(), "theta": 0.5})
    held = np.zeros((4, 2), dtype=bool)

    def native(spec=spec, facets=EDGES):
        return _carom.PlantedContact(spec, SQUARE, [("square", [facets], False)], held, None)

    with pytest.raises(ValueError, match="-1 is no node"):
        native(facets=EDGES - 1)
    with pytest.raises(ValueError, match="no contact: missing field"):
        native(spec="{}")
    planted = native()
    planted.search(SQUARE, np.zeros((4, 2)), 1.0, 0.1)
    planted.evaluate(SQUARE)
    with pytest.raises(ValueError, match=r"W has shape \(2, 2\)"):
        planted.solve(np.eye(2), np.zeros((0, 2)))
    with pytest.raises(ValueError, match=r"shape \(1, 2\) instead of \(0, 2\)"):
        planted.set_reactions(np.zeros((1, 2)))


def contact_data():
    return carom.Contact(condition="gap").model_dump(mode="json")


def test_a_row_of_a_mass_that_sums_to_less_than_zero_is_one_of_second_order():
    # The rows of corners of a consistent mass of second order do.
    mass = np.eye(8)
    mass[:4, 4:] = mass[4:, :4] = -1.1 * np.eye(4)
    mass[4:, 4:] = 2.0 * np.eye(4)
    assert mass.sum(axis=1).min() < 0.0
    assert stepped(model(mass=mass, condition="midpoint"), velocity=np.zeros((4, 2)))


def test_masses_that_are_none():
    with refuses("mass has shape [7]; must be [8], one row for each unknown"):
        model(mass=np.ones(7))
    with refuses("mass has shape [8, 7]; must be [8, 8], one row for each unknown"):
        model(mass=np.ones((8, 7)))
    with refuses("mass: node 0 has -1 kg; must be greater than 0, so give what"):
        model(mass=-np.ones(8))
    with refuses("mass: node 0 has -1 kg; must be greater than 0, so give what touches a mass"):
        model(mass=-np.eye(8))
    with refuses("velocity and mass go together: give the model a mass, and accept the velocity"):
        stepped(model(), velocity=-np.ones((4, 2)))
    with refuses("velocity and mass go together: give the model a mass, and accept the velocity"):
        stepped(model(mass=np.ones(8), condition="midpoint"))


def stepped(touch, **given):
    """A square falls 2 cm, where 1 cm is room, by the midpoint rule."""
    velocity, count = np.tile([0.0, -1.0], (4, 1)), touch.dof_count
    fall = -0.02 * (np.arange(count) % 2)
    candidates = touch.search(SQUARE, velocity=velocity, time_step=0.02)
    contacts = touch.evaluate(candidates, SQUARE + 0.02 * velocity)
    found = contact.solve(contacts, lambda b: b / 5e3, free=fall)
    return touch.accept(SQUARE + found.motion[:8].reshape(4, 2), **given)


def test_masses_that_no_impulse_can_be_solved_with():
    new = np.tile([0.0, -1.0], (4, 1))
    turning = np.roll(np.eye(8), 3, axis=0)
    touch = model(mass=lambda vector: turning @ vector, condition="midpoint")
    with refuses("mass: M v = p is solved to"):
        stepped(touch, velocity=new)


def test_a_mass_that_couples_surfaces_is_refused():
    points = np.vstack([SQUARE, SQUARE + np.array([5.0, 0.0])])
    surfaces = [contact.Surface("left", EDGES), contact.Surface("right", EDGES + 4)]
    mass = np.eye(16) + 0.1 * np.roll(np.eye(16), 8, axis=0)
    touch = contact.ContactModel(points, surfaces, [FLOOR], condition="midpoint", mass=mass)
    velocity = np.tile([0.0, -1.0], (8, 1))
    candidates = touch.search(points, velocity=velocity, time_step=0.02)
    contacts = touch.evaluate(candidates, points + 0.02 * velocity)
    found = contact.solve(contacts, lambda b: b / 5e3, free=0.02 * velocity.ravel())
    with refuses("mass: an impulse on surface 'left' moves 'right'; impulses of landing want"):
        touch.accept(points + found.motion.reshape(8, 2), velocity=velocity)


def test_a_square_that_lands_gets_its_energy_back():
    """It falls with 1 m/s, is stopped half way, and flies off with 1 m/s (restitution 1)."""
    touch = model(mass=np.ones(8), condition="midpoint")
    step = stepped(touch, velocity=np.tile([0.0, 0.0], (4, 1)))
    change = step.velocity_change.reshape(4, 2)
    assert np.allclose(change[2:], 0.0) and np.allclose(change[:, 0], 0.0)
    # The lower nodes are stopped by reactions that take 0.5 kg (1 m/s)² each, and get that back.
    given = 0.5 * change[:2, 1] ** 2
    assert abs(step.work.normal_contact) < 1e-12 and (given > 0.1).all()
