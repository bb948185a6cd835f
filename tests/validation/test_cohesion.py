"""Surfaces that hold together: Coulomb's cone is shifted by an adhesion until they open."""

import numpy as np
import pytest
from cohesive import (
    GRAVITY,
    NEAR,
    UNLIKE,
    area,
    bouncing,
    glued_beam,
    hanging,
    on_an_incline,
    patch,
    patch_error,
    pulled_off,
    sheared,
    thrown,
    tumbling,
)
from rigid_bodies import run

import carom
from carom.building.build import build

STRESS = 1e3


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_block_is_pulled_off_at_its_tensile_strength(tmp_path, dimension):
    """At c A, to a millionth from both sides, and with nothing left."""
    limit = STRESS * area(dimension)
    result = run(tmp_path, pulled_off(dimension, STRESS, limit, condition="gap"))
    pull = np.abs(result.history["block.top.force_" + "xyz"[dimension - 1]])
    assert result.summary["status"] == "completed"
    assert pull[1] == pytest.approx((1 - NEAR) * limit, rel=1e-9)
    assert pull[2] < 1e-12 * limit
    assert list(result.history["holding"] > 0) == [True, True, False]
    assert result.history["normal_force"][1] == pytest.approx(-(1 - NEAR) * limit, rel=1e-9)
    # What is set free as it lets go is told.
    set_free = result.history["strain"][1]
    assert result.history["normal_contact"][2] == pytest.approx(set_free, rel=3 * NEAR)
    assert np.abs(result.history["defect"]).max() < 1e-12 * set_free


@pytest.mark.parametrize("condition", ["midpoint", "gap", "endpoint", "massless"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_block_hangs_until_it_weighs_more_than_its_adhesion(tmp_path, dimension, condition):
    stress = GRAVITY / area(dimension)
    held = run(tmp_path, hanging(dimension, stress * (1 + 1e-6), condition))
    falls = run(tmp_path, hanging(dimension, stress * (1 - 1e-6), condition))
    height = "block." + "xyz"[dimension - 1]
    assert np.abs(np.diff(held.history[height])).max() < 1e-14
    way = falls.history[height] - falls.history[height][0]
    assert way == pytest.approx(0.5 * GRAVITY * falls.history["time"] ** 2, abs=1e-12)
    for result in (held, falls):
        assert result.summary["status"] == "completed"
        assert result.summary["energy"]["max_defect"] < 1e-13
        assert np.abs(result.history["normal_contact"]).max() < 1e-13


@pytest.mark.parametrize(("strength", "holds"), [(1 + 1e-6, True), (1 - 1e-6, False)])
def test_a_force_holds_every_contact(tmp_path, strength, holds):
    cohesion = carom.Cohesion(force=strength * GRAVITY / 5)
    history = run(tmp_path, hanging(2, cohesion, "midpoint")).history
    assert bool(np.abs(np.diff(history["block.y"])).max() < 1e-14) is holds
    assert set(history["holding"][1:]) == ({5.0} if holds else {0.0})


@pytest.mark.parametrize("dimension", [2, 3])
def test_cohesion_holds_a_block_beyond_the_angle_of_friction(tmp_path, dimension):
    """To m g sin α = μ (m g cos α + c A); with less it slides, and friction takes as much."""
    angle, friction = np.radians(40.0), 0.3
    wanted = GRAVITY * (np.sin(angle) / friction - np.cos(angle)) / area(dimension)
    held = run(tmp_path, on_an_incline(dimension, angle, friction, wanted * (1 + 1e-6)))
    assert np.abs(np.diff(held.history["block.x"])).max() < 1e-13
    weak = 0.6 * wanted
    slides = run(tmp_path, on_an_incline(dimension, angle, friction, weak))
    resists = friction * (GRAVITY * np.cos(angle) + weak * area(dimension))
    time, x = slides.history["time"], slides.history["block.x"] - slides.history["block.x"][0]
    assert x == pytest.approx(0.5 * (GRAVITY * np.sin(angle) - resists) * time**2, abs=1e-12)
    assert slides.history["friction"] == pytest.approx(resists * x, abs=1e-12)
    assert slides.history["holding"].min() > 0
    for result in (held, slides):
        assert result.summary["status"] == "completed"
        assert result.summary["energy"]["max_defect"] < 1e-13


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_block_is_sheared_off_at_friction_of_pressure_and_cohesion(tmp_path, dimension):
    """μ (N + c A), whatever its distribution."""
    friction = 0.4
    result = run(tmp_path, sheared(dimension, friction, STRESS, condition="gap"))
    along = np.abs(result.history["block.top.force_x"])[-3:]
    pressed = np.abs(result.history["normal_force"])[-3:]
    assert result.summary["status"] == "completed"
    wanted = friction * (pressed + STRESS * area(dimension))
    assert along == pytest.approx(wanted, rel=1e-8)


@pytest.mark.parametrize("condition", ["midpoint", "gap", "endpoint", "massless"])
@pytest.mark.parametrize("lasting", [False, True])
def test_adhesion_does_no_work(tmp_path, condition, lasting):
    cohesion = carom.Cohesion(stress=2e3, lasting=lasting)
    result = run(tmp_path, bouncing(2, condition, cohesion))
    assert result.summary["status"] == "completed"
    energy = result.summary["energy"]
    assert energy["max_defect"] < 1e-11 * energy["initial"]
    assert result.history["friction"][-1] > 0.0
    assert bool(result.history["holding"].max() > 0) is lasting
    if condition in {"midpoint", "massless"}:
        assert np.abs(result.history["normal_contact"]).max() < 1e-11 * energy["initial"]


@pytest.mark.parametrize("kind", ["tension", "shear"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_bond_of_unlike_meshes_passes_the_patch_test(tmp_path, dimension, kind):
    """Uniform tension and shear pass through mortar rows that nothing breaks.

    Measured: 3.7e-11 at most, with the contact problem solved to 1e-15; with 1e-14, 4.8e-10.
    """
    result = run(tmp_path, patch(dimension, kind))
    assert result.summary["status"] == "completed"
    assert patch_error(result, dimension, kind) < 1e-10


@pytest.mark.parametrize(
    "discretisation", [pytest.param("mortar", marks=pytest.mark.long), "node-to-segment"]
)
def test_a_beam_of_glued_pieces_bends_as_one(tmp_path, discretisation):
    """By F L³/3EI + 6 F L/5GA. Symptom guarded against: what holds loose bodies back in load steps
    is stiffer than a slender beam, whose iterations did not end.
    """
    thickness, traction, young = 0.05, 1e-3, 1e6
    case = glued_beam(discretisation=discretisation, loads_end=traction)
    result = run(tmp_path, case)
    inertia = thickness**3 / 12
    bent = traction * thickness / (3 * young * inertia) + 6 / 5 * traction / (young / 2)
    assert result.summary["status"] == "completed"
    assert result.history["tip.u_y"][-1] == pytest.approx(bent, rel=2e-3)
    assert result.summary["newton_iterations"] <= 40


@pytest.mark.parametrize("dimension", [2, 3])
def test_blocks_that_are_glued_keep_momenta_and_energy(tmp_path, dimension):
    result = run(tmp_path, tumbling(dimension, UNLIKE[dimension], discretisation="mortar"))
    history = result.history
    assert result.summary["status"] == "completed"
    energy = result.summary["energy"]
    assert np.ptp(history["total"]) < 1e-10 * energy["initial"]
    assert energy["max_defect"] < 1e-10 * energy["initial"]
    for name in [name for name in history if name.startswith(("momentum", "angular"))]:
        size = max(np.abs(history[name]).max(), 1.0)
        assert np.ptp(history[name]) < 1e-9 * size, name
    assert history["holding"].min() == history["holding"].max() > 0


@pytest.mark.parametrize("dimension", [2, 3])
def test_halves_that_are_glued_at_their_nodes_move_as_one(tmp_path, dimension):
    """Thrown on a floor, beside the same mesh in one piece."""
    halves, whole = (
        run(tmp_path, thrown(dimension, is_glued=is_glued)).history for is_glued in (True, False)
    )
    initial = whole["total"][0]
    assert np.ptp(whole["strain"]) > 0.05 * initial
    for name in ("kinetic", "strain", "friction"):
        assert halves[name] == pytest.approx(whole[name], abs=1e-8 * initial), name


def test_what_holds_is_there_after_a_restart():
    """A block that is about to let go of the floor goes on to the last bit."""
    case = bouncing(2, "midpoint", carom.Cohesion(stress=2e4, lasting=True))
    whole, other = build(case), build(case)
    whole.advance(0.02, np.inf)
    other.restore(whole.checkpoint())
    assert whole.checkpoint()["state/reactions/adhesion"].max() > 0.0
    for run_on in (whole, other):
        run_on.advance(0.1, np.inf)
    last, wanted = other.checkpoint(), whole.checkpoint()
    kept = [name for name in wanted if name.startswith("state/")]
    assert [name for name in kept if not np.array_equal(last[name], wanted[name])] == []


@pytest.mark.parametrize("condition", ["gap", "midpoint", "massless"])
@pytest.mark.parametrize(("level", "velocity"), [(1.0, [0.0, 0.0]), (-3.0, [0.3, 0.2])])
def test_a_bond_holds_wherever_the_obstacle_is(tmp_path, condition, level, velocity):
    """Symptom guarded against: gaps of bonds were taken from the origin: a body on a floor at
    y = 1 m was pulled 1 m into it.
    """
    block = carom.Body(
        name="block",
        material="soft",
        mesh=carom.Rectangle(corner=[0.0, level], size=[1.0, 1.0], divisions=[3, 3]),
        velocity=[0.0, 0.3],
    )
    floor = carom.Plane(name="floor", point=[0.0, level], normal=[0.0, 1.0], velocity=velocity)
    pair = carom.Pair(between=["block", "floor"], cohesion=carom.Cohesion(unbreakable=True))
    case = carom.Scenario(
        dimension=2,
        analysis=carom.Dynamic(end_time=0.02, time_step=1e-3, scheme=carom.Conserving()),
        materials={"soft": carom.SaintVenantKirchhoff(young=1e5, poisson=0.3, density=1e3)},
        bodies=[block],
        obstacles=[floor],
        contact=carom.Contact(condition=condition, friction=0.2, pairs=[pair]),
        output=carom.Output(history_every=1e-3, fields_every=0.02),
    )
    history = carom.run(case, out=tmp_path).history
    assert np.abs(history["min_gap"][1:]).max() < 1e-14
    assert history["normal_force"].min() < -1.0


def test_what_cannot_hold_is_refused():
    def refused(match, cohesion, change=None, **contact):
        case = thrown(2, is_glued=True)
        pair = carom.Pair(between=["lower", "upper"], cohesion=cohesion)
        case = case.model_copy(update={"contact": carom.Contact(pairs=[pair], **contact)})
        with pytest.raises(carom.InputError, match=match):
            build(case if change is None else change(case))

    refused("what holds is on one side of a pair", 1e3, sources="both")
    refused("cells of second order, whose nodes have no pressure", 1e3, of_second_order)
    with pytest.raises(carom.InputError, match='give one of "stress", "force" and "unbreakable"'):
        carom.Cohesion()
    with pytest.raises(carom.InputError, match='leave one of "lasting" and "unbreakable" out'):
        carom.Cohesion(unbreakable=True, lasting=True)
    itself = carom.Pair(between=["lower", "lower"], cohesion=1e3)
    case = thrown(2, is_glued=True)
    with pytest.raises(carom.InputError, match="does not hold on to itself"):
        build(case.model_copy(update={"contact": carom.Contact(pairs=[itself])}))


def of_second_order(case):
    """Return the case with cells of second order in its first body."""
    first = case.bodies[0]
    mesh = first.mesh.model_copy(update={"cell": "quad8"})
    return case.model_copy(
        update={"bodies": (first.model_copy(update={"mesh": mesh}), *case.bodies[1:])}
    )


def test_loops_of_others_do_not_hold():
    surface = carom.contact.Surface("block", [[0, 1]])
    floor = carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0])
    pair = carom.Pair(between=["block", "floor"], cohesion=1e3)
    with pytest.raises(carom.InputError, match="only runs of carom have it"):
        carom.contact.ContactModel([[0.0, 0.0], [1.0, 0.0]], [surface], [floor], pairs=[pair])
    mass = carom.ForeignBody(
        "mass",
        [[0.0, 0.0], [1.0, 0.0]],
        [[0, 1]],
        mass=np.eye(4),
        energy=lambda _: 0.0,
        force=np.zeros_like,
        stiffness=lambda _: np.zeros((4, 4)),
    )
    contact = carom.Contact(cohesion=1e3)
    with pytest.raises(carom.InputError, match="bodies of other codes do not hold together"):
        carom.ForeignRun([mass], [floor], time_step=0.1, contact=contact)
