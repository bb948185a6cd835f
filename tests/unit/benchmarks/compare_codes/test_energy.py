"""The routine by which all codes are measured, against motions that are known."""

import numpy as np
import pytest
from compare.energy import Energy, Motion
from compare.problems import BARS, CYLINDERS, PROBLEMS


def polygon_moments(mesh):
    """Return area and polar second moment about the origin of what the surface encloses."""
    start, end = mesh.points[mesh.surface[:, 0]], mesh.points[mesh.surface[:, 1]]
    cross = start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]
    squares = (start * start + start * end + end * end).sum(axis=1)
    return cross.sum() / 2, cross @ squares / 12


def turned(points, angle):
    cosine, sine = np.cos(angle), np.sin(angle)
    return points @ np.array([[cosine, sine], [-sine, cosine]])


def test_discs_have_the_unknowns_and_the_mass_of_their_polygons():
    assert CYLINDERS.points.size == 2084
    area = sum(polygon_moments(body.mesh)[0] for body in CYLINDERS.bodies)
    assert Energy(CYLINDERS).mass.sum() == pytest.approx(CYLINDERS.density * area)
    for body in CYLINDERS.bodies:
        centre = body.mesh.points[body.mesh.surface[:, 0]].mean(axis=0)
        radii = np.linalg.norm(body.mesh.points[body.mesh.surface] - centre, axis=2)
        np.testing.assert_allclose(radii, 1.0)


def test_bars_have_the_unknowns_and_the_mass_of_their_rectangles():
    assert BARS.points.size == 808
    assert Energy(BARS).mass.sum() == pytest.approx(2 * 10.0 * 0.1 * BARS.density)
    left, right = BARS.surfaces
    np.testing.assert_allclose(BARS.points[left][0, ::-1], BARS.points[right][0])


@pytest.mark.parametrize("problem", PROBLEMS.values(), ids=PROBLEMS)
def test_rigid_motion_has_no_strain_energy(problem):
    moved = turned(problem.points, 1.1) + np.array([3.0, -2.0])
    assert abs(Energy(problem).strain(moved - problem.points)) < 1e-24 * problem.young


def test_spinning_discs_have_the_kinetic_energy_of_rigid_bodies():
    velocity, spin = np.array([3.0, -2.0]), 0.7
    velocities = velocity + spin * CYLINDERS.points @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    expected = 0.0
    for body in CYLINDERS.bodies:
        area, polar = polygon_moments(body.mesh)
        centre = body.mesh.points[body.mesh.surface[:, 0]].mean(axis=0)
        at_centre = velocity + spin * np.array([-centre[1], centre[0]])
        expected += (
            area * at_centre @ at_centre / 2 + (polar - area * centre @ centre) * spin**2 / 2
        )
    assert Energy(CYLINDERS).kinetic(velocities) == pytest.approx(expected, rel=1e-12)


def test_stretched_and_turned_discs_have_the_energy_of_a_uniform_strain():
    stretch = 0.1
    stretched = turned(CYLINDERS.points * [1 + stretch, 1.0], 0.4)
    area = sum(polygon_moments(body.mesh)[0] for body in CYLINDERS.bodies)
    young, poisson = CYLINDERS.young, CYLINDERS.poisson
    modulus = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))
    expected = area * modulus / 2 * (stretch + stretch**2 / 2) ** 2
    assert Energy(CYLINDERS).strain(stretched - CYLINDERS.points) == pytest.approx(expected)


def test_motion_knows_when_bodies_are_touched_and_what_was_lost():
    velocities = [[[1, -2], [0, 0]], [[1, -1.9], [0, 0]], [[0, 0], [1, 1]]]
    motion = Motion([0.0, 0.1, 0.2], [4.0, 5.0, 3.0], velocities)
    assert motion.touches == (0.1, 0.2)
    assert motion.change == -0.25
    assert motion.excursion == 0.25
    assert motion.last_velocity == (1, 1)
