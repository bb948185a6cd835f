import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from law import violation

from carom import InputError, friction

TOLERANCE = 1e-8

every_solver = pytest.mark.parametrize("solver", friction.SOLVERS)


def random_problem(seed, contacts, dimension, *, rank, spread, units, mu):
    """W = A Aᵀ of a rank, with contacts of sizes over `spread` decades, in any unit."""
    random = np.random.default_rng(seed)
    size = contacts * dimension
    A = random.standard_normal((size, max(1, round(rank * size))))
    A *= np.repeat(10.0 ** random.uniform(-spread / 2, spread / 2, contacts), dimension)[:, None]
    q = 10.0**units * random.standard_normal((contacts, dimension))
    return A @ A.T, q, np.full(contacts, mu)


@every_solver
@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    seed=st.integers(0, 10_000),
    contacts=st.integers(1, 6),
    dimension=st.integers(1, 3),
    rank=st.sampled_from([0.3, 0.6, 1.0, 1.5]),
    spread=st.sampled_from([0.0, 2.0, 5.0]),
    units=st.sampled_from([-6.0, 0.0, 6.0]),
    mu=st.sampled_from([0.0, 0.3, 1.2]),
)
def test_the_laws_hold_or_the_status_says_no(solver, seed, contacts, dimension, **of):
    W, q, mu = random_problem(seed, contacts, dimension, **of)
    found = friction.solve(W, q, mu, solver=solver, tolerance=TOLERANCE, max_iterations=500)
    if found.solved:
        # The residual bounds each of the laws, by a few times 1 + μ.
        assert violation(W, q, mu, found.reactions) < 20 * TOLERANCE
    else:
        assert found.status in {"iteration-limit", "stalled", "inconsistent", "diverged"}


@every_solver
@pytest.mark.parametrize("dimension", [1, 2, 3])
def test_well_conditioned_problems_are_solved(solver, dimension):
    for seed in range(10):
        W, q, mu = random_problem(
            seed, 5, dimension, rank=1.5, spread=0.5, units=0.0, mu=0.3 * (seed % 3)
        )
        found = friction.solve(W + np.eye(len(W)), q, mu, solver=solver)
        assert found.solved
        assert found.residual <= TOLERANCE
        assert found.natural_residual <= TOLERANCE


@every_solver
@pytest.mark.parametrize(
    ("q", "reaction"),
    [
        ([0.5, 3.0, 4.0], [0.0, 0.0, 0.0]),
        ([-2.0, 0.3, -0.4], [2.0, -0.3, 0.4]),
        ([-2.0, 3.0, 4.0], [2.0, -0.6, -0.8]),
    ],
    ids=["separates", "sticks", "slips"],
)
def test_a_mass_on_a_plane_does_as_by_hand(solver, q, reaction):
    found = friction.solve(np.eye(3), q, [0.5], solver=solver, tolerance=1e-12)
    assert found.reactions == pytest.approx(np.array([reaction]), abs=1e-10)
    assert found.motions == pytest.approx(found.reactions + q, abs=1e-15)


@every_solver
def test_a_wall_pressed_into_a_wall_is_not_solved(solver):
    """Nothing can move (W = 0), and the contact is closed by q: no reactions can open it."""
    found = friction.solve(np.zeros((3, 3)), [-1.0, 0.0, 0.0], [0.5], solver=solver)
    assert not found.solved


@every_solver
def test_few_iterations_are_no_success(solver, problem):
    found = friction.solve(problem, solver=solver, tolerance=1e-14, max_iterations=1)
    assert (found.status, found.solved) == ("iteration-limit", False)


@every_solver
def test_no_contacts_are_solved_at_once(solver):
    found = friction.solve(np.zeros((0, 0)), np.zeros((0, 2)), [], solver=solver)
    assert found.solved
    assert found.reactions.shape == (0, 2)


def test_dense_sparse_and_flat_arrays_say_the_same(problem):
    W = problem.matrix()
    answers = [
        friction.solve(matrix, q, problem.mu).reactions
        for matrix in (W.toarray(), W.tocsr(), sp.csc_matrix(W), W.tocoo(), W)
        for q in (problem.q, problem.q.ravel(), problem.q.tolist())
    ]
    assert all(np.array_equal(answer, answers[0]) for answer in answers)


def test_the_default_is_the_first_of_the_solvers(problem):
    default, first = friction.solve(problem), friction.solve(problem, solver=friction.SOLVERS[0])
    assert np.array_equal(default.reactions, first.reactions)


def test_a_guess_that_is_the_answer_takes_no_iteration(problem):
    exact = friction.solve(problem, tolerance=1e-10)
    again = friction.solve(problem, guess=exact.reactions)
    assert again.iterations == 0
    assert friction.solve(problem, guess=exact.reactions.ravel()).iterations == 0


def test_the_time_limit_ends_a_solve(problem):
    found = friction.solve(problem, solver="gauss-seidel", tolerance=1e-300, time_limit=0.01)
    assert found.status == "time-limit"
    assert 0.01 <= found.time < 1.0


def test_the_history_leads_to_the_residual(problem):
    found = friction.solve(problem)
    iterations, residuals = found.history.T
    assert np.all(np.diff(iterations) >= 0)
    assert residuals[-1] == max(found.residual, found.natural_residual)
    assert "solved" in repr(found)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"solver": "gaus-seidel"}, "solver = 'gaus-seidel': did you mean \"gauss-seidel\"?"),
        ({"method": "condens"}, "method = 'condens': did you mean \"condense\"?"),
        ({"tolerance": 0.0}, "tolerance = 0: must be greater than 0"),
        ({"tolerance": np.nan}, "tolerance = nan: must be greater than 0"),
        ({"max_iterations": -1}, "max_iterations = -1: must be at least 0"),
        ({"time_limit": -1.0}, "time_limit = -1: must be at least 0"),
        ({"guess": [1.0]}, "guess has shape [1]: must be [12, 3] or [36]"),
        ({"guess": np.full(36, np.inf)}, "guess[0] = inf: must be finite"),
        ({"mu": [0.1]}, "q and mu are part of the problem"),
    ],
)
def test_a_wrong_option_is_named(problem, options, message):
    with pytest.raises(InputError) as caught:
        friction.solve(problem, **options)
    assert str(caught.value).startswith(message)


def test_a_missing_array_is_named():
    with pytest.raises(InputError, match="mu is missing"):
        friction.solve(np.eye(3), [0.0, 0.0, 0.0])


def test_the_package_gives_the_module_where_it_is_asked_for():
    import carom

    assert carom.friction is friction
    with pytest.raises(AttributeError, match="frictoin"):
        _ = carom.frictoin
