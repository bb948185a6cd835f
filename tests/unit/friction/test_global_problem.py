import numpy as np
import pytest
import scipy.sparse as sp

from carom import InputError
from carom.friction import SOLVERS, GlobalProblem, Problem, solve


def test_the_condensed_problem_is_the_local_one(global_problem, problem):
    condensed = global_problem.condense()
    assert condensed.matrix().toarray() == pytest.approx(problem.matrix().toarray(), abs=1e-12)
    assert condensed.q == pytest.approx(problem.q)
    assert global_problem.q == pytest.approx(problem.q)
    assert global_problem.stiffness == pytest.approx(problem.stiffness)
    assert np.array_equal(condensed.mu, problem.mu)


@pytest.mark.parametrize("method", ["auto", "condense", "admm"])
def test_motions_and_velocities_obey_their_equations(global_problem, method):
    found = solve(global_problem, method=method)
    assert found.solved
    p, r = global_problem, found.reactions.ravel()
    assert p.M @ found.velocities == pytest.approx(p.H @ r + p.f, abs=1e-9)
    assert p.H.T @ found.velocities + p.b.ravel() == pytest.approx(found.motions.ravel(), abs=1e-9)
    measured = p.measure(found.reactions)
    assert measured.residual == pytest.approx(found.residual, rel=1e-3, abs=1e-14)
    assert measured.natural_residual == pytest.approx(found.natural_residual, rel=1e-3, abs=1e-14)


@pytest.mark.parametrize("solver", SOLVERS)
def test_local_and_global_form_have_the_same_motions(global_problem, problem, solver):
    local = solve(problem, solver=solver, tolerance=1e-10)
    found = solve(global_problem, solver=solver, method="condense", tolerance=1e-10)
    assert found.method == "condense"
    assert found.motions == pytest.approx(local.motions, abs=1e-6)


def test_a_mass_matrix_without_symmetry_is_taken_as_it_is(global_problem):
    p = global_problem
    gyroscopic = sp.diags_array([0.2, -0.2], offsets=[1, -1], shape=p.M.shape)
    turned = GlobalProblem(p.M + gyroscopic, p.H, p.f, p.b, p.mu)
    W = turned.condense().matrix().toarray()
    assert np.abs(W - W.T).max() > 0.01 * np.abs(W).max()
    found = solve(turned)
    assert found.solved
    assert turned.measure(found.reactions).decisive <= 1.001e-8


def test_a_singular_mass_is_bad_input():
    free = GlobalProblem(np.diag([1.0, 0.0]), np.eye(2), np.zeros(2), [[-1.0, 0.0]], [0.3])
    for attempt in (free.condense, lambda: solve(free), lambda: free.measure([1.0, 0.0])):
        with pytest.raises(InputError, match="singular"):
            attempt()


M, H, F, B, MU = np.eye(4), np.ones((4, 6)), np.zeros(4), np.zeros((2, 3)), [0.5, 0.5]


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ((np.ones((4, 3)), H, F, B, MU), "M has shape [4, 3]: must be square"),
        ((M * np.nan, H, F, B, MU), "M[0, 0] = nan: must be finite"),
        ((M, np.ones((3, 6)), F, B, MU), "H has shape [3, 6]: must be [4, 6], rows as M has"),
        ((M, np.ones((4, 7)), F, B, MU), "H has shape [4, 7]"),
        ((M, H, np.zeros(5), B, MU), "f has shape [5]: must be [4]"),
        ((M, H, F, np.zeros(5), MU), "b has 5 entries for the 2 contacts of mu"),
        ((M, H, F, B, [0.5, -0.5]), "mu[1] = -0.5: must be at least 0"),
        ((M, H, F, np.zeros(6), 0.5), "b has shape [6] and mu []"),
        ((M, H, F, B, [0.5, np.inf]), "mu[1] = inf: must be finite"),
    ],
)
def test_bad_input_is_named_with_its_place(arrays, message):
    with pytest.raises(InputError) as caught:
        GlobalProblem(*arrays)
    assert str(caught.value).startswith(message)


def test_forms_are_told_apart(global_problem, problem):
    assert repr(global_problem) == "<GlobalProblem: 12 contacts in 3D, 30 dofs>"
    assert isinstance(global_problem.condense(), Problem)
