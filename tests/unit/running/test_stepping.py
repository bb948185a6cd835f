"""Going through time by hand."""

import math

import numpy as np
import pytest

import carom
import restarting
from carom.building.build import build


@pytest.fixture
def simulation():
    return carom.Simulation(restarting.scenario())


def test_steps_are_those_of_a_run(simulation, impact):
    steps = []
    while not simulation.has_ended:
        steps.append(simulation.step())
    assert [step.index for step in steps] == list(range(1, 76))
    assert simulation.steps == 75
    assert simulation.time == steps[-1].time == 0.15
    assert simulation.history.keys() == impact.history.keys()
    for name, column in simulation.history.items():
        np.testing.assert_array_equal(column, impact.history[name], err_msg=name)
    # The history is recorded every second step.
    assert [step.contacts for step in steps[1::2]] == impact.history["contacts"][1:-1].tolist()
    assert sum(step.iterations for step in steps) == impact.summary["newton_iterations"]
    assert max(step.certificate for step in steps) == impact.summary["certificate"]["max_joule"]
    with pytest.raises(carom.InputError, match=r"ended at t = 0\.15 s; give a later"):
        simulation.step()


def test_every_step_says_what_became_of_the_energy(simulation):
    before = simulation.energy.total
    first, dissipated = before, 0.0
    while simulation.time < 0.1:
        step = simulation.step()
        change = step.ledger.kinetic + step.ledger.strain
        assert step.energy.total - before == pytest.approx(change, abs=1e-12)
        assert abs(step.ledger.defect) < 1e-9
        before, dissipated = step.energy.total, dissipated + step.ledger.friction
    assert dissipated > 0.1
    ledger = simulation.ledger
    assert ledger.friction == pytest.approx(dissipated)
    assert ledger.kinetic + ledger.strain == pytest.approx(before - first)
    assert abs(ledger.defect) < 1e-8


def test_advance_goes_to_a_time(simulation):
    simulation.advance(0.0301)
    assert simulation.time == pytest.approx(0.032)
    simulation.advance(0.01)
    assert simulation.steps == 16
    simulation.advance(math.inf)
    assert simulation.has_ended
    with pytest.raises(carom.InputError, match="not nan"):
        simulation.advance(math.nan)


def test_bodies_are_where_the_fields_say(simulation, impact):
    simulation.advance(0.1)
    for name, body in simulation.bodies.items():
        stored = impact.fields.body(name)
        np.testing.assert_array_equal(body.points, stored.points)
        np.testing.assert_array_equal(body.positions, body.points + body.displacement)
        for field in stored:
            np.testing.assert_array_equal(
                getattr(body, field), stored[field].at(0.1), err_msg=field
            )


def test_arrays_are_of_their_moment(simulation):
    body = simulation.bodies["left"]
    before, stress = body.velocity, body.stress
    copy = before.copy()
    simulation.step()
    np.testing.assert_array_equal(before, copy)
    assert not np.array_equal(body.velocity, before)
    assert body.stress.any()
    assert not stress.any()
    with pytest.raises(ValueError, match="read-only"):
        body.velocity[0] = 0.0


@pytest.mark.parametrize(
    "how",
    [
        "contact.condition=midpoint",
        "contact.condition=gap",
        "contact.condition=massless",
        "contact.discretisation=mortar",
        "contact.sources=both",
    ],
)
def test_contacts_press_on_both_sides(how):
    simulation = carom.Simulation(restarting.scenario(how))
    assert len(simulation.contacts) == 0
    np.testing.assert_array_equal(simulation.contacts.force("left"), [0.0, 0.0])
    seen = set()
    while not simulation.has_ended:
        step = simulation.step()
        contacts = simulation.contacts
        assert len(contacts) == step.contacts
        normal = (contacts.reaction * contacts.normal).sum()
        assert normal == pytest.approx(step.normal_force)
        seen |= {frozenset(pair) for pair in zip(contacts.source, contacts.target, strict=True)}
        for name, body in simulation.bodies.items():
            np.testing.assert_allclose(
                contacts.force(name), body.reaction.sum(axis=0), atol=1e-9 + 1e-12 * normal
            )
        np.testing.assert_array_equal(
            contacts.force("left", by="right"), -contacts.force("right", by="left")
        )
        np.testing.assert_array_equal(contacts.force("floor"), -contacts.force("left", by="floor"))
    assert seen == {frozenset(("left", "floor")), frozenset(("left", "right"))}


def test_a_contact_is_a_node_of_its_source(simulation):
    simulation.advance(0.1)
    contacts, left = simulation.contacts, simulation.bodies["left"]
    on_floor = np.array([target == "floor" for target in contacts.target])
    assert on_floor.any()
    nodes = contacts.node[on_floor]
    np.testing.assert_allclose(left.reaction[nodes], contacts.reaction[on_floor])
    np.testing.assert_array_equal(contacts.normal[on_floor], [[0.0, 1.0]] * len(nodes))
    # Nodes enter by less than they travel in a step.
    np.testing.assert_allclose(left.positions[nodes, 1], 0.0, atol=3.0 * 0.002)


def test_in_space_vectors_have_three_components(tmp_path):
    ball = carom.Body(
        name="ball",
        material="rubber",
        mesh=carom.Ball(centre=[0.0, 0.0, 1.01], radius=1.0, divisions=2),
        velocity=[0.5, 0.0, -1.0],
    )
    scenario = carom.Scenario(
        dimension=3,
        analysis=carom.Dynamic(end_time=0.04, time_step=2e-3),
        materials={"rubber": carom.NeoHookean(young=1e4, poisson=0.3, density=1.0)},
        bodies=[ball],
        obstacles=[carom.Plane(name="floor", point=[0.0, 0.0, 0.0], normal=[0.0, 0.0, 1.0])],
        contact=carom.Contact(friction=0.3),
    )
    simulation = carom.Simulation(scenario)
    while not len(simulation.contacts):
        simulation.step()
    push = simulation.contacts.force("ball")
    assert push.shape == (3,)
    assert push[2] > 0.0 > push[0]
    simulation.advance(0.04)
    stored = carom.run(scenario, out=tmp_path).fields
    for name, field in stored.items():
        np.testing.assert_array_equal(getattr(simulation.bodies["ball"], name), field[-1])
    assert stored["velocity"].components == ("x", "y", "z")


def test_a_step_that_is_halved_counts_its_parts():
    fast = restarting.scenario("analysis.newton.max_iterations=5")
    simulation = carom.Simulation(fast)
    steps = []
    while not simulation.has_ended:
        steps.append(simulation.step())
    assert max(step.substeps for step in steps) > 1
    assert steps[-1].time == pytest.approx(0.15)
    friction = sum(step.ledger.friction for step in steps)
    assert simulation.ledger.friction == pytest.approx(friction)


def test_a_simulation_ends_where_a_step_fails():
    hopeless = restarting.scenario("analysis.newton.max_iterations=1", "bodies.0.spin=30")
    simulation = carom.Simulation(hopeless)
    with pytest.raises(carom.ConvergenceError, match="Newton") as first:
        simulation.advance(1.0)
    with pytest.raises(carom.ConvergenceError) as second:
        simulation.step()
    assert second.value is first.value


def test_initial_velocities_are_those_of_a_spin():
    still = carom.Simulation(restarting.scenario("bodies.0.velocity=[0, 0]", "bodies.0.spin=0"))
    arm = still.bodies["left"].points - [0.0, 1.06]
    still.set_velocity("left", [1.5, -1.0] + 4.0 * np.column_stack([-arm[:, 1], arm[:, 0]]))
    described = carom.Simulation(restarting.scenario())
    assert still.energy.total == pytest.approx(described.energy.total, rel=1e-12)
    for simulation in (still, described):
        simulation.advance(0.1)
    np.testing.assert_allclose(
        still.bodies["left"].positions, described.bodies["left"].positions, rtol=1e-9, atol=1e-14
    )
    assert still.history["kinetic"][0] == pytest.approx(described.history["kinetic"][0])
    assert abs(still.ledger.defect) < 1e-8


def test_one_velocity_is_for_all_nodes(simulation):
    simulation.set_velocity("right", [3.0, 0.0])
    np.testing.assert_array_equal(simulation.bodies["right"].velocity[:, 0], 3.0)
    left = simulation.bodies["left"].velocity
    assert left.mean(axis=0) == pytest.approx([1.5, -1.0])


@pytest.mark.parametrize(
    ("body", "velocity", "message"),
    [
        ("lift", [0.0, 0.0], "lift: no such body.*left"),
        ("left", [0.0, 0.0, 0.0], r"shape \(57, 2\) or \(2,\), not \(3,\)"),
        ("left", [math.nan, 0.0], "must be finite"),
    ],
)
def test_velocities_that_do_not_fit_are_refused(simulation, body, velocity, message):
    with pytest.raises(carom.InputError, match=message):
        simulation.set_velocity(body, velocity)


def test_no_velocity_comes_out_of_nowhere(simulation):
    simulation.step()
    with pytest.raises(carom.InputError, match=r"before the first step.*load"):
        simulation.set_velocity("left", [0.0, 0.0])


def test_the_native_module_refuses_what_does_not_fit():
    native = build(restarting.scenario())
    for shape in ((114, 3), (113, 2), (0, 2)):
        with pytest.raises(ValueError, match="shape"):
            native.set_initial_velocity(np.zeros(shape))
    native.set_initial_velocity(np.zeros((114, 2)))
    assert native.describe()["energy"] == 0.0
    assert native.summary()["certificate"]["tolerance_joule"] == 0.0
    native.advance(1.0, 0.0)
    with pytest.raises(ValueError, match="steps were made"):
        native.set_initial_velocity(np.zeros((114, 2)))


def test_a_simulation_says_where_it_is(simulation):
    simulation.advance(0.02)
    assert repr(simulation) == "Simulation('Restart': 10 of 75 steps, t = 0.02 s)"
    assert repr(simulation.bodies["left"]) == "BodyState('left': 57 nodes, 48 cells)"


def test_a_static_analysis_has_no_velocities():
    case = {
        **restarting.CASE,
        "analysis": {"kind": "static", "end_time": 1.0, "time_step": 0.1},
        "bodies": [
            {key: body[key] for key in ("name", "material", "mesh")}
            for body in restarting.CASE["bodies"]
        ],
    }
    case["output"] = {}
    simulation = carom.Simulation(carom.Scenario.from_dict(case))
    with pytest.raises(carom.InputError, match=r"^a static analysis has no velocities$"):
        simulation.set_velocity("left", [0.0, 0.0])
