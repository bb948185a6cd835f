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
