import numpy as np
import pytest
import scipy.sparse as sp

from carom import friction


def granular(contacts=12, dimension=3, seed=0, dofs=30):
    """W = Hᵀ M⁻¹ H of random bodies with random loads, as the arrays M, H, f, b, mu."""
    random = np.random.default_rng(seed)
    M = sp.diags_array(random.uniform(0.5, 2.0, dofs))
    H = random.standard_normal((dofs, contacts * dimension))
    H = sp.csr_array(np.where(random.random(H.shape) < 0.2, H, 0.0))
    f, b = random.standard_normal(dofs), 0.1 * random.standard_normal((contacts, dimension))
    return M, H, f, b, random.uniform(0.0, 0.8, contacts)


@pytest.fixture
def problem():
    """A problem in local form whose W is sparse and singular."""
    M, H, f, b, mu = granular()
    W = H.T @ sp.diags_array(1.0 / M.diagonal()) @ H
    return friction.Problem(W, H.T @ (f / M.diagonal()) + b.ravel(), mu)


@pytest.fixture
def global_problem():
    """The same problem in global form."""
    return friction.GlobalProblem(*granular())
