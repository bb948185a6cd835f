import numpy as np
import pytest
import scipy.sparse as sp

from carom import InputError
from carom.friction import AsymmetryWarning, Problem

Q, MU = np.zeros((2, 3)), [0.5, 0.5]


def spoilt(entries):
    W = np.eye(6)
    for place, value in entries.items():
        W[place] = value
    return W


@pytest.mark.parametrize(
    ("W", "q", "mu", "message"),
    [
        (spoilt({(4, 1): np.nan}), Q, MU, "W[4, 1] = nan: must be finite"),
        (sp.csr_array(spoilt({(4, 1): np.inf})), Q, MU, "W[4, 1] = inf: must be finite"),
        (np.eye(6) * 1j, Q, MU, "W: has complex numbers"),
        (sp.eye_array(6) * 1j, Q, MU, "W: has complex numbers"),
        ([["a"]], Q, MU, "W: must be an array of numbers"),
        (np.ones(6), Q, MU, "W has shape [6]: must be a matrix"),
        (np.eye(5), Q, MU, "W has shape [5, 5]: must be [6, 6] for 2 contacts of 3 components"),
        (np.ones((6, 5)), Q, MU, "W has shape [6, 5]: must be [6, 6]"),
        (np.eye(6), [0.0] * 7, MU, "q has 7 entries for the 2 contacts of mu"),
        (np.eye(6), [0.0] * 8, MU, "q has 4 components for each of 2 contacts"),
        (np.eye(6), 1.0, MU, "q has shape [] and mu [2]"),
        (np.eye(6), np.zeros(6), 0.5, "q has shape [6] and mu []"),
        (np.eye(6), [0, 0, 0, 0, np.nan, 0], MU, "q[4] = nan: must be finite"),
        (np.eye(6), [[0, 0, 0], [0, -np.inf, 0]], MU, "q[1, 1] = -inf: must be finite"),
        (np.eye(6), Q, [0.5, -0.1], "mu[1] = -0.1: must be at least 0"),
        (np.eye(6), Q, [np.nan, 0.1], "mu[0] = nan: must be finite"),
        (np.eye(6), Q, [0.1, 0.2, 0.3], "mu has shape [3]: must be [2]"),
    ],
)
def test_bad_input_is_named_with_its_place(W, q, mu, message):
    with pytest.raises(InputError) as caught:
        Problem(W, q, mu)
    assert str(caught.value).startswith(message)
    assert caught.value.key in {"W", "q", "mu"}


def test_a_clearly_asymmetric_operator_is_refused_with_its_worst_entry():
    with pytest.raises(InputError, match=r"^W\[0, 5\] = 0.02 but W\[5, 0\] = 0 ") as caught:
        Problem(spoilt({(0, 5): 0.02}), Q, MU)
    assert "(contacts 0 and 1)" in str(caught.value)
    assert "asymmetric by 0.02 of its largest entry" in str(caught.value)


def test_what_few_digits_leave_is_symmetrised_with_a_warning():
    W = spoilt({(0, 5): 0.301, (5, 0): 0.3})
    with pytest.warns(AsymmetryWarning, match=r"asymmetric by 0.001 of its largest.*\[0, 5\]") as w:
        problem = Problem(sp.csr_array(W), Q, MU)
    assert w[0].filename == __file__
    assert problem.asymmetry == pytest.approx(1e-3)
    assert problem.matrix().toarray() == pytest.approx((W + W.T) / 2, abs=0)


@pytest.mark.filterwarnings("error")
def test_round_off_is_symmetrised_in_silence():
    problem = Problem(spoilt({(0, 5): 0.3 + 1e-14, (5, 0): 0.3}), Q, MU)
    W = problem.matrix().toarray()
    assert np.array_equal(W, W.T)


@pytest.mark.parametrize("stored", [np.asarray, sp.csr_array, sp.bsr_array])
def test_blocks_are_stored_in_pairs_and_on_the_diagonal(stored):
    W = np.diag([1.0, 1.0, 0.0, 0.0, 2.0, 2.0])
    W[0, 5] = W[5, 0] = 0.25
    problem = Problem(stored(W), np.zeros((3, 2)), 0.3)
    assert problem.starts.tolist() == [0, 2, 3, 5]
    assert problem.columns.tolist() == [0, 2, 1, 0, 2]
    assert problem.blocks.shape == (5, 2, 2)
    assert np.array_equal(problem.matrix().toarray(), W)
    assert (problem.contacts, problem.dimension, problem.mu.tolist()) == (3, 2, [0.3] * 3)


def test_repeated_entries_of_a_sparse_matrix_add_up():
    W = sp.coo_array(([0.5, 0.5, 1.0], ([0, 0, 1], [0, 0, 1])), shape=(2, 2))
    assert np.array_equal(Problem(W, np.zeros((1, 2)), [0.0]).matrix().toarray(), np.eye(2))


def test_the_callers_arrays_are_neither_kept_nor_changed():
    W, q, mu = sp.csr_array(np.eye(6)), np.ones((2, 3)), np.array(MU)
    problem = Problem(W, q, mu)
    W.data[0], q[0, 0], mu[0] = 5.0, 5.0, 5.0
    assert problem.blocks.max() == problem.q.max() == 1.0
    with pytest.raises(ValueError, match="read-only"):
        problem.q[0, 0] = 3.0


def test_a_problem_from_blocks_is_taken_as_it_is():
    asymmetric = np.array([[[1.0, 0.5], [0.0, 1.0]]])
    problem = Problem.from_blocks([0, 1], [0], asymmetric, [[-1.0, 0.0]], [0.2])
    assert problem.matrix().toarray().tolist() == asymmetric[0].tolist()
    assert "1 contact in 2D, 1 block of W" in repr(problem)


def test_motions_and_measure_are_those_of_the_reactions(problem):
    r = np.random.default_rng(1).standard_normal(problem.q.shape)
    W = problem.matrix().toarray()
    assert problem.motions(r).ravel() == pytest.approx(W @ r.ravel() + problem.q.ravel())
    assert problem.stiffness == pytest.approx(len(W) / np.trace(W))
    assert problem.measure(r).residual > 0.1
