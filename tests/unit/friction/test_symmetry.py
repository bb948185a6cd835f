import numpy as np
import pytest
import scipy.sparse as sp

from carom import InputError
from carom.friction import Problem, solve
from carom.friction.symmetry import DENSE


def with_eigenvalue(value, size, seed=0):
    """A full matrix with eigenvalues from 0.5 to 1 and one of the given value."""
    random = np.random.default_rng(seed)
    Q, _ = np.linalg.qr(random.standard_normal((size, size)))
    return Q @ np.diag([value, *np.linspace(0.5, 1.0, size - 1)]) @ Q.T


def problem(W):
    return Problem((W + W.T) / 2, np.zeros((len(W) // 3, 3)), 0.3)


def test_a_negative_diagonal_is_refused_with_its_place():
    W = np.eye(6)
    W[4, 4] = -0.1
    with pytest.raises(InputError, match=r"W\[4, 4\] = -0.1 \(contact 1\): a diagonal entry"):
        problem(W)


def test_two_rows_that_are_indefinite_are_refused_with_their_places():
    W = np.eye(6)
    W[1, 3] = W[3, 1] = 1.2
    with pytest.raises(
        InputError, match=r"\|W\[1, 3\]\| = 1.2 is larger than .* .contacts 0 and 1.:"
    ):
        problem(W)


def test_a_contact_without_compliance_that_others_move_is_indefinite():
    W = np.diag([1.0, 1.0, 1.0, 0.0, 1.0, 1.0])
    W[0, 3] = W[3, 0] = 0.1
    with pytest.raises(InputError, match="W is indefinite"):
        problem(W)


@pytest.mark.parametrize("size", [30, 3 * (DENSE // 3 + 4)])
def test_one_negative_eigenvalue_is_found(size):
    with pytest.raises(InputError, match="W is indefinite: scaled to a diagonal of ones"):
        problem(with_eigenvalue(-0.3, size))


@pytest.mark.parametrize("size", [30, 3 * (DENSE // 3 + 4)])
@pytest.mark.parametrize("value", [0.0, -1e-7])
def test_singular_to_round_off_or_to_few_digits_is_not_indefinite(size, value):
    problem(with_eigenvalue(value, size))


def test_small_contacts_count_as_much_as_large_ones():
    small = 1e-6 * with_eigenvalue(-0.2, 12)
    W = sp.block_diag([np.eye(12), small]).toarray()
    with pytest.raises(InputError, match="indefinite"):
        problem(W)


def test_zero_and_empty_operators_are_semidefinite():
    problem(np.zeros((6, 6)))
    problem(np.zeros((0, 0)))


def test_what_a_first_look_misses_is_found_where_a_solver_gives_up():
    """A chain whose long waves alone are unstable: eigenvalues 1 − 1.001 cos θ crowd at zero."""
    size = 900
    W = sp.diags_array([-0.5005, 1.0, -0.5005], offsets=[-1, 0, 1], shape=(size, size))
    missed = Problem(W, np.random.default_rng(0).standard_normal((size // 3, 3)), 0.3)
    with pytest.raises(InputError, match="W is indefinite"):
        missed.refuse_if_indefinite()
    with pytest.raises(InputError, match="W is indefinite"):
        solve(missed, max_iterations=0)
