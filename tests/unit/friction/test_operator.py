"""K̄⁻¹ as a function: W is made of its answers, and what is no answer is refused."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, splu

from carom import InputError, friction


@pytest.fixture
def system():
    """A symmetric positive definite K̄, H of six contacts, q and μ."""
    random = np.random.default_rng(3)
    A = random.standard_normal((40, 40))
    K = A @ A.T + 40.0 * np.eye(40)
    H = sp.csc_array(np.where(random.random((40, 18)) < 0.3, random.standard_normal((40, 18)), 0.0))
    return K, H, random.standard_normal((6, 3)), np.full(6, 0.3)


def test_reactions_are_those_of_the_matrix(system):
    K, H, q, mu = system
    factor = splu(sp.csc_array(K))
    inverse = np.linalg.inv(K)
    operator = LinearOperator(K.shape, matvec=lambda b: inverse @ b)
    expected = friction.solve(H.T @ inverse @ H.toarray(), q, mu, tolerance=1e-13).reactions
    assert np.abs(expected).max() > 1.0

    def by_columns(b):
        if b.ndim > 1:
            raise ValueError("one right-hand side at a time")
        return factor.solve(b)

    for solver in (factor.solve, by_columns, operator):
        found = friction.solve(solver, q, mu, H=H, tolerance=1e-13)
        assert found.solved
        assert np.abs(found.reactions - expected).max() < 1e-11 * np.abs(expected).max()
    W = H.T @ inverse @ H.toarray()
    found = friction.solve(LinearOperator(W.shape, matvec=lambda r: W @ r), q, mu, tolerance=1e-13)
    assert np.abs(found.reactions - expected).max() < 1e-11 * np.abs(expected).max()


@pytest.mark.parametrize(
    ("solver", "message"),
    [
        (lambda b: b[:-1], r"shape \[39\] for a right-hand side of shape \[40\]; must be as long"),
        (lambda b: np.full_like(b, np.nan), r"answer is nan at \[0, 0\]; K̄ must be regular"),
        (lambda b: {"x": b}, "answer is dict; must be an array of numbers"),
        (
            lambda b: np.triu(np.ones((40, 40))) @ b,
            "asymmetric by .* give the solver of a symmetric K̄",
        ),
    ],
)
def test_what_is_no_solution_is_refused(system, solver, message):
    _, H, q, mu = system
    with pytest.raises(InputError, match=message):
        friction.solve(solver, q, mu, H=H)


def test_a_solver_and_its_h_go_together(system):
    K, H, q, mu = system
    with pytest.raises(
        InputError, match="H is missing: with a function that solves with K̄, give H too"
    ):
        friction.solve(lambda b: b, q, mu)
    with pytest.raises(
        InputError, match=r"H goes with a function or a LinearOperator .* not with ndarray"
    ):
        friction.solve(K, q, mu, H=H)
