"""Functions of time as the auditor reads them: values, rates, and kinks to the right."""

import numpy as np
import pytest

import carom
from carom.auditing.functions.formula import Formula
from carom.auditing.functions.signals import AuditSignal

SMOOTH = [
    "2^3^0.5*t - -t^2/3",
    "sin(3*t)*cos(t)^2 + tan(t/4) - e^(t/2)",
    "asin(t/3) + acos(t/4)*atan(t) + log(1 + t)",
    "sqrt(1 + t)*sinh(t/2) - cosh(t)/tanh(1 + t)",
    "where(t > 0.5, t^3, 7) + max(t, 0.1, t^2/2) - min(2*pi, 5*t)",
    "abs(t - 2)^1.5 + exp(-t/0.3)*sign(t)*step(t - 0.2)",
]


@pytest.mark.parametrize("text", SMOOTH)
def test_the_rate_of_a_formula_is_its_difference_quotient(text):
    formula, t, h = Formula(text), 0.83, 1e-6
    value, rate = formula.with_rate("t", t)
    ends = formula(t=np.array([t - h, t + h]))
    assert value == pytest.approx(float(formula(t=np.array(t))), rel=1e-15)
    assert rate == pytest.approx(float(np.diff(ends)[0]) / (2 * h), rel=1e-8)


def test_at_a_kink_the_rate_is_that_to_the_right():
    assert Formula("max(0, t - 1)").with_rate("t", 1.0) == (0.0, 1.0)
    assert Formula("min(t, 1)").with_rate("t", 1.0) == (1.0, 0.0)
    table = AuditSignal(carom.Table(time=[0.0, 1.0, 3.0], value=[5.0, 7.0, 3.0]))
    assert [table.at(t) for t in (-1.0, 0.5, 1.0, 3.0)] == [(5, 0), (6, 2), (7, -2), (3, 0)]
