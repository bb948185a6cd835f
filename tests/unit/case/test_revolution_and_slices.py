"""Bodies of revolution touch their like alone."""

import pytest

import carom


def body(name, height, **more):
    mesh = carom.Rectangle(corner=[0.0, height], size=[1.0, 1.0], divisions=[3, 3])
    return carom.Body(name=name, material="e", mesh=mesh, **more)


def case(*bodies, **contact):
    law = carom.SaintVenantKirchhoff(young=1e6, poisson=0.3, density=1e3)
    return carom.Scenario(
        analysis=carom.Dynamic(end_time=0.01, time_step=1e-3),
        materials={"e": law},
        bodies=bodies,
        contact=carom.Contact(**contact),
    )


RING = body("ring", 0.0, hypothesis="axisymmetric")
RIGID = carom.RigidBody(name="block", density=1e3, mesh=RING.mesh.model_copy())
REDUCED = carom.ReducedBody(name="block", material="e", modes=3, mesh=RING.mesh)


# Symptom guarded against: forces of a circumference pressed on a slice of 1 m, without a word.
@pytest.mark.parametrize("hypothesis", ["plane-strain", "plane-stress"])
def test_a_body_of_revolution_does_not_touch_a_slice(hypothesis):
    said = (
        rf'bodies\.1\.hypothesis = "{hypothesis}": ring is a body of revolution and block a slice '
        r"of the plane, and they may touch: .* or disable their pair in contact\.pairs$"
    )
    with pytest.raises(carom.InputError, match=said):
        case(RING, body("block", 1.05, hypothesis=hypothesis))


@pytest.mark.parametrize("block", [RIGID, REDUCED])
def test_nor_one_that_does_not_deform_as_others_do(block):
    with pytest.raises(carom.InputError, match=r"bodies\.0\.hypothesis = .* ring is a body of rev"):
        case(block, RING)


def test_they_are_in_one_case_where_they_cannot_touch():
    pairs = [carom.Pair(between=["block", "ring"], enabled=False)]
    assert case(RING, body("block", 1.05), pairs=pairs).contact.pairs
    assert case(RING, body("block", 1.05, hypothesis="axisymmetric"))
