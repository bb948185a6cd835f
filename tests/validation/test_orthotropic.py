"""Friction by the direction: closed forms of slides, and what carries the direction."""

import math

import numpy as np
import orthotropic
import painleve
import pytest
from friction_laws import on_a_spring, sliding_block
from orthotropic import ALONG, GRAIN, LOAD, errors, pulled

import carom

PULL = 0.6 * LOAD


def test_a_block_pulled_at_24_angles_slides_and_dissipates_by_the_closed_form():
    worst = np.abs([errors(angle, PULL) for angle in np.arange(24) * math.pi / 12]).max(axis=0)
    assert worst.max() < 1e-8


@pytest.mark.parametrize("condition", ["gap", "massless", "endpoint"])
def test_every_condition_has_the_same_ellipse(condition):
    # The velocity at the end of a step is of first order in it.
    assert max(map(abs, errors(0.7, PULL, condition=condition))) < 1e-8


@pytest.mark.parametrize("of", ["floor", "block"])
def test_a_direction_turns_with_what_carries_it(of):
    assert max(map(abs, errors(0.3, PULL, of=of, turned=1.1))) < 1e-8


def test_what_is_pulled_within_the_ellipse_stays():
    """Just below μ₁ N along, and far above it across."""
    across = GRAIN + math.pi / 2
    for angle, pull in ((GRAIN, 0.999 * ALONG * LOAD), (across, 2.9 * ALONG * LOAD)):
        slide, history = pulled(angle, pull)
        assert slide.way < 1e-12
        assert history["certificate"].max() < 1e-12
    assert pulled(GRAIN, 1.001 * ALONG * LOAD)[0].way > 1e-5


def test_equal_coefficients_are_coulombs():
    direction = [1.0, 2.0, 0.5]
    same = carom.OrthotropicFriction(along=0.3, across=0.3, direction=direction, of="floor")
    cases = []
    for friction in (same, 0.3):
        case = soft_block(friction)
        cases.append(orthotropic.simulate(case).history)
    for column in ("kinetic", "strain", "friction"):
        one, other = (np.asarray(history[column]) for history in cases)
        assert np.abs(one - other).max() < 1e-11 * np.abs(other).max()


def soft_block(friction, **given):
    """A block of rubber that is thrown onto a floor and turns."""
    pair = carom.Pair(between=["block", "floor"], friction=friction)
    return carom.Scenario(
        dimension=3,
        analysis=carom.Dynamic(
            end_time=0.1,
            time_step=2e-3,
            scheme=carom.Conserving(),
            newton=carom.Newton(tolerance=1e-11),
        ),
        output=carom.Output(history_every=2e-3, fields_every=0.1),
        materials={"rubber": carom.NeoHookean(young=2e4, poisson=0.3, density=10.0)},
        bodies=[
            carom.Body(
                name="block",
                material="rubber",
                mesh=carom.Box(
                    corner=[-0.5, -0.5, 0.01], size=[1.0, 1.0, 0.5], divisions=[3, 3, 2]
                ),
                velocity=[0.6, 0.4, -1.0],
                spin=[0.0, 0.0, 3.0],
            )
        ],
        obstacles=[carom.Plane(name="floor", point=[0.0] * 3, normal=[0.0, 0.0, 1.0])],
        contact=carom.Contact(pairs=[pair], **given),
    )


@pytest.mark.parametrize("of", ["floor", "block"])
@pytest.mark.parametrize("condition", ["midpoint", "gap"])
def test_books_of_a_soft_block_are_closed_and_friction_takes(of, condition):
    friction = carom.OrthotropicFriction(along=0.05, across=0.5, direction=[1.0, 0.3, 0.0], of=of)
    run = orthotropic.simulate(soft_block(friction, condition=condition))
    initial = run.summary["energy"]["initial"]
    taken = np.diff(run.history["friction"])
    assert taken.sum() > 1e-3 * initial
    assert taken.min() > -1e-10 * initial
    assert np.abs(run.history["defect"]).max() < 1e-10 * initial
    assert run.summary["certificate"]["max_joule"] < 1e-9 * initial


def test_what_has_no_direction_is_refused():
    def refused(match, **given):
        valid = {"along": 0.1, "across": 0.3, "direction": [1.0, 0.0, 0.0], "of": "floor"}
        with pytest.raises(carom.InputError, match=match):
            orthotropic.simulate(soft_block(carom.OrthotropicFriction(**valid | given)))

    refused("is none of the pair", of="wall")
    refused("has no length", direction=[0.0, 0.0, 0.0])
    friction = carom.OrthotropicFriction(along=0.1, across=0.3, direction=[1.0, 0.0, 0.0], of="x")
    case = soft_block(0.1)
    whole = case.model_copy(update={"contact": carom.Contact(friction=friction)})
    with pytest.raises(carom.InputError, match="needs a surface that carries it"):
        orthotropic.simulate(whole)
    with pytest.raises(carom.InputError, match="the plane has one direction to slide in"):
        orthotropic.simulate(in_the_plane(friction))
    with pytest.raises(carom.InputError, match="is round, and nothing is drawn on it"):
        orthotropic.simulate(round_ball())
    with pytest.raises(carom.InputError, match="is not there for bodies of other codes"):
        on_a_spring(friction, stiffness=1.0, time_step=0.1)
    pressed = carom.FrictionFormula(formula="min(0.3, 2/p)")
    with pytest.raises(carom.InputError, match="areas of bodies of other codes are not known"):
        on_a_spring(pressed, stiffness=1.0, time_step=0.1)


def in_the_plane(friction):
    """Return a block in the plane whose pair with the floor has this friction."""
    case = sliding_block(0.1)
    floor = case.obstacles[0].name
    pair = carom.Pair(between=["block", floor], friction=friction)
    return case.model_copy(update={"contact": carom.Contact(pairs=[pair])})


def round_ball():
    """Return a ball that is round and should carry a direction."""
    friction = carom.OrthotropicFriction(
        along=0.1, across=0.3, direction=[1.0, 0.0, 0.0], of="ball"
    )
    case = soft_block(friction)
    mesh = carom.Ball(centre=[0.0, 0.0, 1.1], radius=1.0, divisions=2)
    ball = carom.RigidBody(name="ball", mass=1.0, mesh=mesh, round=True)
    pair = carom.Pair(between=["ball", "floor"], friction=friction)
    return case.model_copy(
        update={"bodies": (ball,), "contact": carom.Contact(pairs=[pair]), "materials": {}}
    )


LAWS = painleve.LAWS | {
    "orthotropic": carom.OrthotropicFriction(
        along=painleve.ROUGH, across=0.5, direction=[1.0, 0.4, 0.0], of="floor"
    )
}


@pytest.mark.parametrize("condition", ["midpoint", "gap"])
@pytest.mark.parametrize("law", LAWS)
def test_painleves_rod_jams_and_closes_its_books_with_every_law(tmp_path, law, condition):
    assert painleve.factor() < -1.0
    dimension = 3 if law == "orthotropic" else 2
    case = painleve.rod(tmp_path / "rod.inp", LAWS[law], condition=condition, dimension=dimension)
    result = carom.run(case, out=tmp_path / "results")
    assert result.summary["status"] == "completed"
    size = result.summary["energy"]["initial"] + painleve.MASS * 10.0
    assert np.abs(result.history["defect"]).max() < 1e-10 * size
    assert np.diff(result.history["friction"]).min() > -1e-10 * size
    # No finite force stops its tip: it is one step.
    assert result.history["rod.v_x"][1] > -0.7 * painleve.SPEED


GRAINED = {"direction": [math.cos(GRAIN), math.sin(GRAIN), 0.0], "of": "floor"}


def test_each_direction_may_have_its_own_law():
    """Viscous along, weaker with speed across: beside v' = −g M² d/|M d|, at second order."""
    along = carom.StaticKinetic(kinetic=0.15, viscous=0.3)
    across = carom.FrictionFormula(formula="0.1 + 0.4*exp(-v/0.5)")
    friction = carom.OrthotropicFriction(along=along, across=across, **GRAINED)
    worst = []
    for step in (2e-3, 1e-3):
        history = orthotropic.simulate(orthotropic.thrown(friction, [0.8, 0.7], step)).history
        found = np.stack([history["block.v_x"], history["block.v_y"]], axis=-1)
        wanted = orthotropic.slowed(
            lambda v: 0.15 + 0.3 * v,
            lambda v: 0.1 + 0.4 * math.exp(-v / 0.5),
            [0.8, 0.7],
            history["time"],
        )
        worst.append(np.abs(found - wanted).max())
        assert history["friction_defect"].max() < 1e-10
        assert np.abs(history["defect"]).max() < 1e-12
        assert history["certificate"].max() < 1e-12
    assert worst[1] < 1e-6
    assert worst[0] / worst[1] == pytest.approx(4.0, rel=0.1)


def test_laws_that_say_the_same_everywhere_are_coefficients():
    cases = []
    for along, across in ((0.15, 0.45), (carom.FrictionFormula(formula="0.15"), 0.45)):
        friction = carom.OrthotropicFriction(along=along, across=across, **GRAINED)
        cases.append(orthotropic.simulate(orthotropic.thrown(friction, [0.8, 0.7], 2e-3)).history)
    for column in ("block.v_x", "block.v_y", "friction"):
        assert cases[0][column] == pytest.approx(cases[1][column], abs=1e-11)


def test_a_soft_block_with_a_law_for_each_direction_closes_its_books():
    friction = carom.OrthotropicFriction(
        along=0.1, across=carom.FrictionFormula(formula="0.2 + 0.3*v"), **GRAINED
    )
    run = orthotropic.simulate(soft_block(friction))
    initial = run.summary["energy"]["initial"]
    assert np.diff(run.history["friction"]).min() > -1e-10 * initial
    assert np.abs(run.history["defect"]).max() < 1e-10 * initial
    assert run.history["friction_defect"].max() < 1e-6


def test_laws_of_a_direction_that_jump_are_refused():
    jump = carom.StaticKinetic(static=0.5, kinetic=0.2)
    friction = carom.OrthotropicFriction(along=0.1, across=jump, **GRAINED)
    with pytest.raises(carom.InputError, match="each direction has a coefficient, a formula, or"):
        orthotropic.simulate(soft_block(friction))
