"""The auditor's own finite elements, against derivatives, exact integrals and the native core."""

import numpy as np
import pytest

import carom
from carom.auditing.bodies.body import AuditBody
from carom.auditing.bodies.mass import affine_weights
from carom.auditing.mesh.cells import Cells
from carom.auditing.mesh.kinds import KINDS

STRESSES = (None, carom.InitialStress(xx=0.4, yy=-0.2, zz=0.1, xy=0.3))
MATERIALS = {
    "saint-venant-kirchhoff": carom.SaintVenantKirchhoff(young=3.0, poisson=0.3, density=2.0),
    "linear-elastic": carom.LinearElastic(young=3.0, poisson=0.3, density=2.0),
    "neo-hookean": carom.NeoHookean(young=3.0, poisson=0.3, density=2.0),
    "mooney-rivlin": carom.MooneyRivlin(c10=0.4, c01=0.2, bulk=3.0, density=2.0),
    "yeoh": carom.Yeoh(c10=0.6, c20=-0.3, c30=2.0, bulk=3.0, density=2.0),
}
LAWS = tuple(MATERIALS)

# Skewed quadrilaterals, 4 by 3: the six nodes inside can carry the mass of the others.
POINTS = np.array(
    [
        [x + 0.1 * y * y, y - 0.07 * x * x]
        for y in (0.0, 0.5, 1.1, 1.5)
        for x in (0.0, 0.6, 1.0, 1.5, 2.1)
    ]
)
QUADS = np.array(
    [[a, a + 1, a + 6, a + 5] for row in range(3) for a in range(5 * row, 5 * row + 4)],
    dtype=np.int64,
)
TRIANGLES = np.concatenate([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]])
MOTIONS = np.random.default_rng(7).normal(scale=0.02, size=(2, len(POINTS), 2))


def body(
    law="saint-venant-kirchhoff",
    *,
    triangles=False,
    mass="consistent",
    massless=False,
    initial_stress=None,
):
    entry = carom.Body(
        name="b",
        material="m",
        thickness=0.3,
        mass=mass,
        initial_stress=initial_stress,
        mesh=carom.Rectangle(corner=[0, 0], size=[1, 1], divisions=[1, 1]),
    )
    nodes = TRIANGLES if triangles else QUADS
    return AuditBody(
        entry,
        {"m": MATERIALS[law]},
        types=np.full(len(nodes), KINDS["tri3" if triangles else "quad4"].vtk_type),
        nodes=nodes,
        points=POINTS,
        first_node=0,
        massless=massless,
    )


@pytest.mark.parametrize("stress", STRESSES)
@pytest.mark.parametrize("triangles", [False, True])
@pytest.mark.parametrize("law", LAWS)
def test_internal_force_is_the_derivative_of_the_energy(law, triangles, stress):
    b = body(law, triangles=triangles, initial_stress=stress)
    (u, direction), h = MOTIONS, 1e-5
    slope = (b.strain_energy(u + h * direction) - b.strain_energy(u - h * direction)) / (2 * h)
    assert (b.internal_force(u) * direction).sum() == pytest.approx(slope, rel=1e-8)


@pytest.mark.parametrize("stress", STRESSES)
@pytest.mark.parametrize("law", LAWS)
def test_conserving_force_does_the_change_of_energy_and_has_no_moment(law, stress):
    b, (u0, u1) = body(law, initial_stress=stress), MOTIONS
    force = b.conserving_force(u0, u1)
    change = b.strain_energy(u1) - b.strain_energy(u0)
    assert (force * (u1 - u0)).sum() == pytest.approx(change, rel=1e-12)
    np.testing.assert_allclose(force.sum(axis=0), 0.0, atol=1e-15)
    middle = POINTS + 0.5 * (u0 + u1)
    if b.law.objective:
        for f in (force, b.difference_force(u0, u1)):
            assert (middle[:, 0] * f[:, 1] - middle[:, 1] * f[:, 0]).sum() == pytest.approx(
                0, abs=1e-14
            )


@pytest.mark.parametrize("law", LAWS)
def test_reference_stiffness_is_the_slope_of_the_force(law):
    b, h = body(law), 1e-7
    v = MOTIONS[0]
    slope = (b.internal_force(h * v) - b.internal_force(-h * v)) / (2 * h)
    local = np.einsum("caibk,cbk->cai", b._stiffness, v[b.cells.nodes])
    np.testing.assert_allclose(b.cells.assembled(local), slope, atol=1e-7)


@pytest.mark.parametrize("options", [{}, {"mass": "lumped"}, {"massless": True}])
@pytest.mark.parametrize("triangles", [False, True])
def test_every_mass_has_mass_and_centre_and_consistent_ones_inertia(options, triangles):
    b = body(triangles=triangles, **options)
    x, y = POINTS[b.cells.nodes].transpose(2, 0, 1)
    area = 0.5 * (x * (np.roll(y, -1, 1) - np.roll(y, 1, 1))).sum()
    assert b.mass.total == pytest.approx(2.0 * 0.3 * area, rel=1e-14)
    exact = body(triangles=triangles).mass
    np.testing.assert_allclose(b.mass.mean(POINTS), exact.mean(POINTS), rtol=1e-13)
    if not options.get("mass"):
        inertia = (POINTS * b.mass.times(POINTS)).sum()
        assert inertia == pytest.approx((POINTS * exact.times(POINTS)).sum(), rel=1e-13)
    if b.massless.size:
        assert not b.mass.times(MOTIONS[0])[b.massless].any()


def test_affine_weights_extrapolate_on_a_line_and_not_off_it():
    np.testing.assert_allclose(affine_weights(np.array([[1.0, 0], [2.0, 0]])), [2, -1], atol=1e-14)
    assert affine_weights(np.array([[1.0, 0.5]])) is None


def test_the_mean_rotation_of_a_turned_body_is_its_rotation():
    b, angle = body(), 2.0
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    np.testing.assert_allclose(b.rotation(POINTS @ turn.T - POINTS + [3, 4]), turn, atol=1e-14)


def test_boundary_has_the_body_on_its_left():
    types = np.full(len(QUADS), KINDS["quad4"].vtk_type)
    facets = Cells(types, QUADS, POINTS, 1.0).outer_sides()
    assert len(facets) == 14
    (ax, ay), (bx, by) = POINTS[facets].transpose(1, 2, 0)
    assert 0.5 * (ax * by - ay * bx).sum() == pytest.approx(body().cells.weights.sum() / 0.3)
