from time import process_time

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
@settings(max_examples=60)
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
    assert 0.005 <= found.time < 1.0


@pytest.fixture(scope="module")
def large():
    """5e3 contacts whose factors take a quarter of a minute."""
    random = np.random.default_rng(0)
    bodies = random.integers(0, 1000, (5_000, 2))
    rows = np.repeat(np.arange(15_000), 6)
    columns = (3 * np.repeat(bodies, 3, axis=0)[:, :, None] + np.arange(3)).ravel()
    H = sp.csr_array((random.standard_normal(rows.size), (rows, columns)), shape=(15_000, 3000))
    return friction.Problem((H @ H.T).tocsr(), random.standard_normal((5_000, 3)) - 0.1, 0.4)


@every_solver
def test_a_large_problem_ends_in_time(solver, large):
    """Factors are cut short, or not begun, and no one looks for negative eigenvalues after that."""
    start = process_time()
    found = friction.solve(large, solver=solver, tolerance=1e-300, time_limit=0.5)
    assert found.status == "time-limit"
    # Processor time, which a busy machine does not stretch; the order of elimination cannot be cut
    # short. Measured: 0.55 s.
    assert process_time() - start < 5.0


def test_a_large_global_problem_ends_in_time():
    random = np.random.default_rng(0)
    H = sp.random_array((3000, 3000), density=0.003, rng=random, format="csc")
    M = sp.diags_array([-np.ones(2999), np.full(3000, 2.5), -np.ones(2999)], offsets=[-1, 0, 1])
    large = friction.GlobalProblem(
        M, H, random.standard_normal(3000) - 0.1, np.zeros((1000, 3)), 0.4
    )
    for method in ("auto", "condense", "admm"):
        start = process_time()
        found = friction.solve(large, method=method, tolerance=1e-300, time_limit=0.3)
        assert found.status == "time-limit"
        assert process_time() - start < 4.0


def extreme(matrix, motion):
    """Three contacts of ordinary numbers times two of any size."""
    random = np.random.default_rng(3)
    A = random.standard_normal((9, 9))
    return (A @ A.T + np.eye(9)) * matrix, random.standard_normal((3, 3)) * motion, np.full(3, 0.3)


SIZES = [1e-310, 1e-300, 1e-200, 1e-163, 1.0, 1e163, 1e300]


@every_solver
@pytest.mark.parametrize("motion", SIZES)
@pytest.mark.parametrize("matrix", SIZES)
def test_solved_is_said_of_solutions_alone_whatever_their_size(solver, matrix, motion):
    """Below 1e-162 squares vanished, and anything passed for solved."""
    W, q, mu = extreme(matrix, motion)
    problem = friction.Problem(W, q, mu)
    found = friction.solve(problem, solver=solver)
    size = np.abs(q).max()
    can_be_written = abs(np.log10(motion) - np.log10(matrix)) < 295.0
    assert found.status in {"solved", "stalled", "diverged"}
    if can_be_written and min(matrix, motion) > 1e-305:
        assert found.solved
    if found.solved:
        assert found.motions[:, 0].min() >= -1e-7 * size
        thrust = found.reactions[:, 0] / np.abs(found.reactions).max(initial=5e-324)
        assert np.minimum(found.motions[:, 0] / size, thrust).max() <= 1e-7
        assert problem.measure(found.reactions).decisive <= 1.001e-8


def test_condition_1e14_is_not_called_inconsistent():
    """W is positive definite, so that there is a solution: 4 of 43 were called inconsistent."""
    for seed in range(43):
        random = np.random.default_rng(seed)
        contacts, dimension = int(random.integers(2, 8)), int(random.integers(1, 4))
        size = contacts * dimension
        Q = np.linalg.qr(random.standard_normal((size, size)))[0]
        W = (Q * 10.0 ** np.linspace(0.0, -14.0, size)) @ Q.T
        q = random.standard_normal((contacts, dimension))
        found = friction.solve((W + W.T) / 2, q, np.full(contacts, 0.3), max_iterations=5000)
        assert found.status != "inconsistent", seed


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
