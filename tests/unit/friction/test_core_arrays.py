"""Arrays that the core of contact problems refuses, should anything but the package pass them."""

from types import SimpleNamespace

import numpy as np
import pytest

from carom import InputError, _carom
from carom.friction import Problem

LOCAL = {
    "starts": np.array([0, 1]),
    "columns": np.array([0]),
    "blocks": np.eye(2)[None],
    "q": np.array([[-1.0, 0.0]]),
    "mu": np.array([0.5]),
}
GLOBAL = {
    "m_starts": np.array([0, 1, 2]),
    "m_rows": np.array([0, 1]),
    "m_values": np.ones(2),
    "h_starts": np.array([0, 1, 2]),
    "h_rows": np.array([0, 1]),
    "h_values": np.ones(2),
    "f": np.array([-1.0, 0.0]),
    "b": np.zeros((1, 2)),
    "mu": np.array([0.5]),
}
RULE = {"solver": "auto", "tolerance": 1e-8, "max_iterations": 100, "time_limit": None}


def local(reactions=((0.0, 0.0),), **changes):
    rule = {key: changes.pop(key, value) for key, value in RULE.items()}
    problem = SimpleNamespace(**{**LOCAL, **changes})
    return _carom.solve_friction(problem, np.array(reactions), **rule)


def global_form(method="auto", **changes):
    problem = SimpleNamespace(**{**GLOBAL, **changes})
    start = np.zeros((1, 2))
    return _carom.solve_global_friction(problem, start, method=method, **RULE)


def test_healthy_arrays_are_solved():
    assert local()["reactions"] == pytest.approx(np.array([[1.0, 0.0]]))
    assert global_form()["reactions"] == pytest.approx(np.array([[1.0, 0.0]]))


@pytest.mark.parametrize(
    ("solve", "changes", "message"),
    [
        (
            local,
            {"starts": np.array([0, 2])},
            "the arrays of a contact problem do not fit together",
        ),
        (local, {"columns": np.array([1])}, "the arrays of a contact problem do not fit together"),
        (local, {"solver": "magic"}, 'there is no friction solver named "magic"'),
        (local, {"reactions": np.zeros((2, 2))}, "the reactions do not fit the contact problem"),
        (
            global_form,
            {"f": np.zeros(3)},
            "the arrays of a global contact problem do not fit together",
        ),
        (global_form, {"method": "magic"}, 'there is no global method named "magic"'),
    ],
)
def test_arrays_that_do_not_fit_are_refused(solve, changes, message):
    with pytest.raises(ValueError, match=f"^{message}$"):
        solve(**changes)


def test_one_coefficient_for_all_must_be_finite_too():
    with pytest.raises(InputError, match=r"^mu = nan: must be finite$"):
        Problem(np.eye(2), [[0.0, 0.0]], np.nan)
