"""Distances of boundaries are those that a general optimiser finds."""

import numpy as np
import pytest
from scipy.optimize import minimize

import carom
from carom.building.build import build
from carom.building.simplices import Boundary, behind, boundaries, distance, to_point


def found(one, other):
    """The distance of two segments or triangles by a general optimiser."""
    count = len(one)

    def square(shares):
        arm = shares[:count] @ one - shares[count:] @ other
        return arm @ arm

    sums = [
        {"type": "eq", "fun": lambda shares, part=part: shares[part].sum() - 1.0}
        for part in (slice(0, count), slice(count, None))
    ]
    start = np.full(2 * count, 1.0 / count)
    options = {"ftol": 1e-16, "maxiter": 500}
    best = minimize(
        square,
        start,
        bounds=[(0, 1)] * 2 * count,
        constraints=sums,
        method="SLSQP",
        options=options,
    )
    return np.sqrt(max(best.fun, 0.0))


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("seed", range(25))
def test_distances_of_pieces_are_those_of_an_optimiser(dimension, seed):
    rng = np.random.default_rng(seed)
    corners = np.arange(dimension)[None]
    one, other = rng.normal(size=(2, dimension, dimension))
    other += rng.uniform(0, 2) * rng.normal(size=dimension)
    gap, place = distance(Boundary(one, corners), Boundary(other, corners))
    assert gap == pytest.approx(found(one, other), abs=2e-6)
    point = Boundary(place[None].repeat(dimension, axis=0), corners)
    assert found(point.points, one) == pytest.approx(gap / 2, abs=2e-6)


def surface_of(mesh, dimension):
    scenario = carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(end_time=1.0, time_step=1.0),
        materials={"m": carom.LinearElastic(young=1.0, poisson=0.3, density=1.0)},
        bodies=[carom.Body(name="b", material="m", mesh=mesh)],
    )
    native = build(scenario)
    ((boundary, nodes),) = boundaries(native.surface(), native.mesh()["points"], 1)
    np.testing.assert_array_equal(boundary.points, native.mesh()["points"][nodes])
    return boundary


@pytest.mark.parametrize("cell", ["hex8", "tet4", "hex20", "hex27", "tet10"])
def test_boxes_apart_touching_and_crossed(cell):
    box = {"size": [1, 2, 3], "divisions": [2, 2, 2], "cell": cell}
    one = surface_of(carom.Box(corner=[0, 0, 0], **box), 3)
    for shift, gap in (
        ([1.25, 0.3, 0.1], 0.25),  # facets
        ([1.3, 2.4, 0.0], 0.5),  # edges
        ([1.2, 2.3, 3.6], 0.7),  # corners
        ([0.5, 0.2, 0.7], 0.0),  # through one another
        ([40.0, 0.0, 0.0], 39.0),
    ):
        assert distance(one, one.at(one.points + shift))[0] == pytest.approx(gap, abs=1e-12)


@pytest.mark.parametrize("cell", ["quad4", "tri3", "quad8", "tri6", "quad9"])
def test_a_coarse_plate_above_a_corner_is_as_far_as_its_side(cell):
    plate = surface_of(
        carom.Rectangle(corner=[-1, 0], size=[2, 0.1], divisions=[1, 1], cell=cell), 2
    )
    post = surface_of(carom.Rectangle(corner=[0.3, -1.01], size=[0.02, 1], divisions=[1, 5]), 2)
    gap, place = distance(plate, post)
    assert gap == pytest.approx(0.01, abs=1e-12)
    assert place[1] == pytest.approx(-0.005, abs=1e-12)
    assert to_point(plate, np.array([0.4, -0.3])) == pytest.approx(0.3)


@pytest.mark.parametrize("dimension", [2, 3])
def test_points_that_are_a_little_behind_belong_on_the_boundary(dimension):
    mesh = (
        carom.Rectangle(corner=[0, 0], size=[1, 1], divisions=[2, 2])
        if dimension == 2
        else carom.Box(corner=[0, 0, 0], size=[1, 1, 1], divisions=[2, 2, 2], cell="tet4")
    )
    boundary = surface_of(mesh, dimension)
    points = np.full((4, dimension), 0.3)
    points[:, -1] = [1.0 - 1e-6, 1.0 + 1e-6, 0.9, 1.0 - 1e-7]
    points[3, 0] = 0.5  # on an edge of the mesh
    which, feet = behind(points, boundary, 1e-5)
    assert which.tolist() == [0, 3]
    np.testing.assert_allclose(feet[:, -1], 1.0, atol=1e-15)
    np.testing.assert_allclose(feet[:, :-1], points[which, :-1], atol=1e-15)
