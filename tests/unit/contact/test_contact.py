"""Contact for codes of other people: blocks that cannot turn, whose unknowns are a shift."""

import numpy as np
import pytest

import carom
from carom import contact

GRAVITY, MASS, FRICTION, TIME_STEP = 10.0, 2.0, 0.25, 1e-2


def cuboid(dimension):
    """Corners and sides of a unit square or cube."""
    if dimension == 2:
        return np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), [
            [0, 1],
            [1, 2],
            [2, 3],
            [3, 0],
        ]
    corners = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
    # Turned as they come.
    sides = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]]
    return corners, sides


def block(dimension, **floor):
    corners, sides = cuboid(dimension)
    up = np.eye(dimension)[-1]
    return corners, contact.ContactModel(
        corners,
        [contact.Surface("block", sides)],
        [carom.Plane(name="floor", point=[0.0] * dimension, normal=up, **floor)],
        friction=FRICTION,
        dofs=np.tile(np.arange(dimension), (len(corners), 1)),
    )


def slide(dimension, start, steps, **floor):
    """A block on the floor by the midpoint rule; its velocities and the books."""
    corners, touch = block(dimension, **floor)
    u, v, ledger = np.zeros(dimension), np.array(start, dtype=float), contact.Ledger()
    weight = -MASS * GRAVITY * np.eye(dimension)[-1]
    stiffness = 2 * MASS / TIME_STEP**2
    velocities = [v]
    for _ in range(steps):
        moving = np.tile(v, (len(corners), 1))
        candidates = touch.search(corners + u, velocity=moving, time_step=TIME_STEP)
        free = TIME_STEP * v + weight / stiffness
        contacts = touch.evaluate(candidates, corners + u + TIME_STEP * v)
        assert len(contacts) == 2 ** (dimension - 1), "the nodes at the bottom"
        found = contact.solve(contacts, lambda b: b / stiffness, free=free)
        assert touch.missed(corners + u + found.motion) is None
        ledger.add(touch.accept(corners + u + found.motion))
        u, v = u + found.motion, 2 * found.motion / TIME_STEP - v
        velocities.append(v)
    return np.array(velocities), ledger


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_block_slides_to_rest_as_coulomb_says(dimension):
    """Closed form: it loses μ g Δt in every step, and friction takes what it had."""
    steps = 20
    speed = FRICTION * GRAVITY * steps * TIME_STEP
    along = np.array([1.0, 0.0] if dimension == 2 else [0.6, 0.8, 0.0])
    velocities, ledger = slide(dimension, speed * along, steps)
    expected = np.linspace(speed, 0.0, steps + 1)[:, None] * along
    assert np.abs(velocities - expected).max() < 1e-12 * speed
    assert ledger.friction == pytest.approx(0.5 * MASS * speed**2, rel=1e-11)
    assert abs(ledger.normal_contact) < 1e-12 * ledger.friction
    assert ledger.prescribed == 0.0
    assert abs(ledger.min_gap) < 1e-15
    assert ledger.pairs["block", "floor"].friction == ledger.friction


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_floor_that_moves_drags_a_block_along(dimension):
    """Closed form: v = μ g t, and half of what the floor gives becomes motion."""
    steps, along = 20, np.eye(dimension)[0]
    speed = FRICTION * GRAVITY * steps * TIME_STEP
    velocities, ledger = slide(dimension, np.zeros(dimension), steps, velocity=list(speed * along))
    assert np.abs(velocities[-1] - speed * along).max() < 1e-12 * speed
    assert ledger.prescribed == pytest.approx(MASS * speed**2, rel=1e-11)
    assert ledger.friction == pytest.approx(0.5 * MASS * speed**2, rel=1e-11)


def test_reactions_of_your_own_are_booked_as_those_of_carom():
    corners, touch = block(2)
    candidates = touch.search(corners, velocity=np.tile([1.0, 0.0], (4, 1)), time_step=TIME_STEP)
    contacts = touch.evaluate(candidates, corners)
    assert np.abs(contacts.H.toarray()) == pytest.approx(np.array([[0, 1, 0, 1], [1, 0, 1, 0]]))
    # Two reactions of 3 N with 1 N against the way of 0.01 m.
    tangent = contacts.frame[:, 1, 0]
    reactions = np.column_stack([np.full(2, 3.0), -tangent])
    step = touch.accept(corners + np.array([0.01, 0.0]), reactions=reactions)
    assert step.work.friction == pytest.approx(0.02, rel=1e-12)
    assert step.pressing == 2


def test_what_is_prescribed_has_no_row_and_does_work():
    """A block is pressed on the floor and driven along it: friction takes what the drive does."""
    corners, _ = cuboid(2)
    dofs = np.column_stack([np.full(4, -1), np.zeros(4, dtype=int)])
    touch = contact.ContactModel(
        corners,
        [contact.Surface("block", cuboid(2)[1])],
        [carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0])],
        friction=FRICTION,
        dofs=dofs,
    )
    moved = corners + np.array([1e-3, 0.0])
    candidates = touch.search(corners, velocity=np.tile([0.1, 0.0], (4, 1)), time_step=TIME_STEP)
    contacts = touch.evaluate(candidates, moved)
    assert contacts.H.shape == (1, 4)
    found = contact.solve(contacts, lambda b: b / 1e3, free=np.array([-0.02]))
    assert found.force[0] == pytest.approx(20.0, rel=1e-9)
    assert found.motion[0] == pytest.approx(0.0, abs=1e-12)
    step = touch.accept(moved + np.array([0.0, found.motion[0]]))
    assert step.work.friction == pytest.approx(FRICTION * 20.0 * 1e-3, rel=1e-6)
    assert step.work.prescribed == pytest.approx(step.work.friction, rel=1e-6)


def test_crossed_bars_touch_between_their_nodes():
    """Two bars of one cell each cross 1 mm apart: four crossings, each a force on four nodes."""
    corners, sides = cuboid(3)
    bars = [
        corners * [1.0, 0.1, 0.1] + [0.0, 0.45, 0.0],
        corners * [0.1, 1.0, 0.1] + [0.45, 0.0, 0.101],
    ]
    surfaces = [contact.Surface("lower", sides), contact.Surface("upper", np.array(sides) + 8)]
    points = np.vstack(bars)
    touch = contact.ContactModel(points, surfaces)
    contacts = touch.evaluate(touch.search(points, reach=0.01), points)
    assert len(contacts) == 4
    assert (contacts.node == -1).all()
    assert np.allclose(contacts.gap, 1e-3, rtol=0, atol=1e-15)
    assert (np.diff(contacts.starts) == 4).all()
    # Forces in equilibrium: every column of H sums to zero, component by component.
    sums = contacts.H.toarray().reshape(16, 3, -1).sum(axis=0)
    assert np.abs(sums).max() < 1e-15


def test_multipliers_share_what_both_sides_cover():
    """Both sides of every row weigh one, on meshes that do not match."""
    lower = np.array([[0, 0], [1, 0], [1, 1], [0.5, 1], [0, 1]], dtype=float)
    upper = np.array([[0, 1], [1 / 3, 1], [1, 1], [1, 2], [0, 2]], dtype=float)
    rim = np.array([[0, 1], [1, 2], [2, 3], [3, 4], [4, 0]])
    points = np.vstack([lower, upper])
    surfaces = [contact.Surface("lower", rim), contact.Surface("upper", rim + 5)]
    touch = contact.ContactModel(points, surfaces, discretisation="mortar", sources="first")
    contacts = touch.evaluate(touch.search(points, reach=0.1), points)
    assert len(contacts) == 3
    assert np.abs(contacts.gap).max() < 1e-15
    owner = np.repeat(np.arange(3), np.diff(contacts.starts))
    for side in (contacts.nodes < 5, contacts.nodes >= 5):
        sums = np.bincount(owner[side], contacts.weights[side])
        assert np.allclose(np.abs(sums), 1.0, rtol=0, atol=1e-14)


def test_what_was_not_foreseen_is_missed_and_searched_from_then_on():
    """A block is found to have gone through the floor, takes part, and lands on it."""
    corners, touch = block(2)
    start = corners + np.array([0.0, 0.01])
    candidates = touch.search(start, reach=1e-3)
    assert len(candidates) == 0
    contacts = touch.evaluate(candidates, start)
    found = contact.solve(contacts, lambda b: b / 1e3, free=np.array([0.0, -0.02]))
    assert found.motion[1] == -0.02, "nothing is in its way"
    candidates = touch.missed(start + found.motion)
    assert len(candidates) == 2
    contacts = touch.evaluate(candidates, start + found.motion)
    assert contacts.gap == pytest.approx([-0.01, -0.01])
    found = contact.solve(contacts, lambda b: b / 1e3, free=np.array([0.0, -0.02]))
    assert found.motion[1] == pytest.approx(-0.01, rel=1e-12)
    assert touch.missed(start + found.motion) is None
    step = touch.accept(start + found.motion)
    # 10 N over the way that was in front of them.
    assert step.work.normal_contact == pytest.approx(0.1, rel=1e-12)
    assert abs(step.min_gap) < 1e-15


@pytest.mark.parametrize("kind", ["tri6", "quad8", "quad9"])
def test_facets_of_second_order_touch_with_all_their_nodes(kind):
    """A quadratic side above a linear one, turned the wrong way: the gap is that of the sides."""
    corners, sides = cuboid(3)
    middles = {}
    points = [*corners]

    def node(*ends):
        key = tuple(sorted(ends))
        if key not in middles:
            middles[key] = len(points)
            points.append(np.mean([corners[e] for e in ends], axis=0))
        return middles[key]

    facets = []
    for a, b, c, d in sides:
        if kind == "tri6":
            for p, q, r in ((a, c, b), (a, d, c)):
                facets.append([p, q, r, node(p, q), node(q, r), node(r, p)])
        else:
            ring = [a, d, c, b, node(a, d), node(d, c), node(c, b), node(b, a)]
            facets.append([*ring, node(a, b, c, d)] if kind == "quad9" else ring)
    upper = np.array(points) + np.array([0.0, 0.0, 1.001])
    below = corners * [3.0, 3.0, 1.0] - [1.0, 1.0, 0.0]
    touch = contact.ContactModel(
        np.vstack([upper, below]),
        [contact.Surface("upper", facets), contact.Surface("below", np.array(sides) + len(upper))],
    )
    contacts = touch.evaluate(
        touch.search(np.vstack([upper, below]), reach=0.01), np.vstack([upper, below])
    )
    bottom = np.flatnonzero(upper[:, 2] < 1.01)
    assert set(contacts.node) == set(bottom)
    assert contacts.gap == pytest.approx(np.full(len(bottom), 1e-3), abs=1e-12)
    assert np.abs(contacts.frame[:, 0] - [0.0, 0.0, 1.0]).max() < 1e-12
