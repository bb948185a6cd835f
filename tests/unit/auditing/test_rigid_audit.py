"""Runs of rigid bodies are confirmed, and a node that leaves its body is found."""

import shutil

import h5py
import pytest

import carom

CONSERVING, DAMPED = carom.Conserving(), carom.Theta(theta=0.8, xi=0.7)


def thrown(condition, scheme, *, restitution=None, soft=True, inertia=None):
    """A rigid disc that turns meets a block beside it, and both a floor."""
    elastic = carom.SaintVenantKirchhoff(young=2700.0, poisson=0.33, density=1.0)
    mass = {"density": 2.0} if inertia is None else {"mass": 5.0, "inertia": inertia}
    disc = carom.RigidBody(
        name="disc",
        mesh=carom.Disc(centre=[0.0, 1.2], radius=1.0, divisions=4),
        velocity=[1.5, -1.0],
        spin=4.0,
        **mass,
    )
    given = {
        "name": "block",
        "mesh": carom.Rectangle(corner=[1.3, 0.05], size=[1.0, 1.4], divisions=[3, 4]),
        "velocity": [-0.5, -1.0],
    }
    block = carom.Body(material="m", **given) if soft else carom.RigidBody(density=1.0, **given)
    return carom.Scenario(
        analysis=carom.Dynamic(end_time=0.5, time_step=2e-3, scheme=scheme, gravity=[0.0, -2.0]),
        materials={"m": elastic},
        bodies=[disc, block],
        obstacles=[carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0])],
        contact=carom.Contact(
            condition=condition, friction=0.3, restitution=restitution, penetration_tolerance=0.5
        ),
        output=carom.Output(history_every=2e-3, fields_every=1e-2, audit=True),
    )


@pytest.mark.parametrize(
    "given",
    [
        {"condition": "midpoint", "scheme": CONSERVING},
        {"condition": "midpoint", "scheme": CONSERVING, "soft": False},
        {"condition": "midpoint", "scheme": CONSERVING, "inertia": 3.0},
        {"condition": "gap", "scheme": DAMPED},
        {"condition": "endpoint", "scheme": CONSERVING, "restitution": 0.5, "soft": False},
        {"condition": "endpoint", "scheme": DAMPED, "soft": False, "inertia": 3.0},
    ],
)
def test_rigid_bodies_are_confirmed(tmp_path, given):
    result = carom.run(thrown(**given), out=tmp_path / "run")
    assert len(result.summary["contacts"]) > 2
    audit = carom.audit(tmp_path / "run")
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["rigid motion"].count > 100
    assert checks["rigid motion"].figure < 1e-12
    assert checks["angular impulse"].figure < 1e-9


def test_a_node_that_leaves_its_body_is_found(tmp_path):
    carom.run(thrown("midpoint", CONSERVING, soft=False), out=tmp_path / "run")
    shutil.copytree(tmp_path / "run", tmp_path / "changed")
    with h5py.File(tmp_path / "changed" / "fields.vtkhdf", "r+") as file:
        file["VTKHDF/PointData/displacement"][-3, 0] += 1e-6
    refuted = {check.name for check in carom.audit(tmp_path / "changed").refuted}
    assert "rigid motion" in refuted


@pytest.mark.parametrize("law", [0.3, carom.StaticKinetic(static=0.5, kinetic=0.2, distance=0.02)])
def test_a_rigid_block_that_a_spring_pulls_in_load_steps_is_confirmed(tmp_path, law):
    """It sticks, then slips at μ N. Symptom guarded against: what the solver leaves of a contact
    problem whose reactions prevent motions of 10 m was refuted as friction that gives energy back.
    """
    load, stiffness = 2000.0, 2e4
    block = carom.RigidBody(
        name="block",
        density=1000.0,
        mesh=carom.Rectangle(corner=[0.0, 0.0], size=[1.0, 0.2], divisions=[4, 2]),
    )
    hook = carom.RigidSphere(
        name="hook", centre=[3.0, 0.1], radius=0.01, motion=carom.Displacement(x="0.1*t")
    )
    ends = (
        carom.Place(body="block", point=[1.0, 0.1]),
        carom.Place(obstacle="hook", point=[3, 0.1]),
    )
    scenario = carom.Scenario(
        analysis=carom.Static(end_time=1.0, time_step=0.05),
        bodies=[block],
        obstacles=[carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0]), hook],
        springs=[carom.Spring(name="spring", between=ends, stiffness=stiffness)],
        loads=[carom.Traction(body="block", on="top", traction=[0.0, f"-{load:g}*min(t/0.05, 1)"])],
        contact=carom.Contact(friction=law),
    )
    result = carom.run(scenario, out=tmp_path / "run")
    slides_at = 0.3 if law == 0.3 else 0.2
    assert result.history["spring.force"][-1] == pytest.approx(slides_at * load, rel=1e-9)
    assert carom.audit(tmp_path / "run").refuted == ()
