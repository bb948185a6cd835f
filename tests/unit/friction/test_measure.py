import numpy as np
import pytest

from carom import _carom
from carom.friction import Problem, measure, project


def test_projection_is_the_closest_point_of_the_cone():
    random = np.random.default_rng(0)
    for dimension in (1, 2, 3):
        tau, other = random.standard_normal((2, 500, dimension))
        mu = random.choice([0.0, 0.3, 1.2], 500)
        p, inside = project(tau, mu), project(other, mu)
        assert np.all(np.linalg.norm(p[:, 1:], axis=1) <= mu * p[:, 0] + 1e-14)
        assert np.all(np.sum((tau - p) * (inside - p), axis=1) <= 1e-13)


@pytest.mark.parametrize("dimension", [1, 2, 3])
def test_numpy_and_the_core_measure_the_same(dimension):
    random = np.random.default_rng(dimension)
    A = random.standard_normal((4 * dimension, 5))
    problem = Problem(A @ A.T, random.standard_normal((4, dimension)), random.uniform(0, 1, 4))
    for scale in (0.0, 1e-3, 1.0, 1e3, 1e6, 1e12):
        r = project(scale * random.standard_normal((4, dimension)), problem.mu)
        here = problem.measure(r)
        core = _carom.measure_friction(problem, r)
        assert (here.residual, here.natural_residual, here.certificate) == pytest.approx(core)


def test_a_sliding_mass_that_is_not_braked_is_measured_by_hand():
    """r = n, w = t: the fixed point is proj(n − μ n − t); the gap is μ r_n |w_t|."""
    r, w, mu = np.array([[1.0, 0.0]]), np.array([[0.0, 1.0]]), np.array([0.5])
    found = measure(r, w, q=w - r, mu=mu, stiffness=2.0)
    # proj(0.5, −1) on |t| ≤ n/2 is (0.8, −0.4).
    assert found.residual == pytest.approx(np.hypot(0.2, 0.4) / np.sqrt(2.0))
    assert found.certificate == 0.5
    assert found.decisive == max(found.residual, found.natural_residual)


def test_what_is_not_a_number_is_no_small_residual():
    r = np.array([[np.nan, 0.0]])
    found = measure(r, r, q=np.zeros((1, 2)), mu=np.array([0.5]), stiffness=1.0)
    assert not found.residual <= 1e300
    assert not found.decisive <= 1e300


@pytest.mark.parametrize("unit", [1e-310, 1e-300, 1e-163, 1e163, 1e300])
def test_no_reactions_are_as_wrong_in_any_unit(unit):
    """Symptom guarded against: squares below 1e-324 vanished, and the residual with them."""
    W, q, mu = np.diag([4.0, 4.0]), np.array([[-8.0, 0.0]]), np.zeros(1)
    nothing = np.zeros((1, 2))
    for problem in (Problem(W, unit * q, mu), Problem(unit / 10.0 * W, q, mu)):
        core = _carom.measure_friction(problem, nothing)
        assert problem.measure(nothing).natural_residual == pytest.approx(1.0)
        assert core[1] == pytest.approx(1.0)
        assert problem.measure(nothing).residual == pytest.approx(core[0])
    reactions = np.array([[unit, 0.0]])
    # w = −4 of q = −8, and ρ is 1/4: 1 of 2.
    half = Problem(W, unit * q, mu).measure(reactions)
    assert half.natural_residual == pytest.approx(0.5)
