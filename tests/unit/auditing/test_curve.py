"""The auditor's closest points, against exact ones and brute force."""

import numpy as np
import pytest

from carom.auditing.targets.curve import Curve

COUNT = 24


def ring(count, radius=1.0):
    angle = 2 * np.pi * np.arange(count) / count
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def facets(count):
    return np.stack([np.arange(count), (np.arange(count) + 1) % count], axis=1)


SQUARE = np.array([[0.0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1]])


def test_a_smooth_ring_is_round_to_fourth_order():
    errors = []
    for count in (COUNT, 2 * COUNT):
        target = Curve(facets(count), ring(count), smooth=True)
        x = 1.2 * ring(7)
        errors.append(np.abs(target.signed_distance(x, ring(count)) - 0.2).max())
    assert errors[0] < 2e-4
    assert errors[1] < errors[0] / 12


@pytest.mark.parametrize("smooth", [True, False])
def test_feet_are_where_the_distance_is_smallest(smooth):
    rng = np.random.default_rng(3)
    nodes = ring(COUNT) + rng.normal(scale=0.02, size=(COUNT, 2))
    target = Curve(facets(COUNT), ring(COUNT), smooth=smooth)
    x = 1.1 * ring(11) + rng.normal(scale=0.05, size=(11, 2))
    feet = target.feet(x, nodes)
    points = np.einsum("kj,kji->ki", feet.weights, nodes[feet.nodes])
    np.testing.assert_allclose(feet.weights.sum(axis=1), 1.0, rtol=1e-12)
    xi = np.linspace(0, 1, 2001)[:, None] ** np.arange(4)
    curve = np.einsum("sj,fjk,fki->fsi", xi, target._weights, nodes[target._nodes]).reshape(-1, 2)
    signed = target.signed_distance(x, nodes)
    for k in range(len(x)):
        mine = feet.point == k
        offset = x[k] - points[mine]
        np.testing.assert_allclose(
            (feet.normal[mine] * offset).sum(axis=1), feet.gap[mine], atol=1e-14
        )
        closest = np.linalg.norm(curve - x[k], axis=1).min()
        assert abs(signed[k]) == pytest.approx(closest, abs=1e-6)


@pytest.mark.parametrize("smooth", [True, False])
def test_a_square_keeps_its_corners_and_its_sides(smooth):
    target = Curve(facets(8), SQUARE, smooth=smooth)
    x = np.array([[0.4, -0.3], [2.3, 2.4], [1.0, 0.2], [-0.5, 1.0]])
    np.testing.assert_allclose(target.signed_distance(x, SQUARE), [0.3, 0.5, -0.2, 0.5], atol=1e-15)
    feet = target.feet(np.array([[-0.1, -0.2]]), SQUARE)
    below = feet.normal[:, 1] < -0.5
    # Beyond its end a side goes on straight for half a facet.
    np.testing.assert_allclose(feet.gap[below & (feet.beyond < 0.5)], 0.2, atol=1e-15)
