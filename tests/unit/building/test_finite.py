"""What leaves the native core as a result is a number."""

import json

import numpy as np
import pytest

import carom
from carom.building.build import build
from restarting import CASE

SCHEMES = {
    "theta": {"kind": "theta"},
    "conserving": {"kind": "conserving"},
}


def assert_finite(values, what):
    """Every number in nested arrays, tables and lists is finite; None stands for there is none."""
    if isinstance(values, dict):
        for name, member in values.items():
            assert_finite(member, f"{what}.{name}")
    elif isinstance(values, list | tuple):
        for member in values:
            assert_finite(member, what)
    elif isinstance(values, np.ndarray | float):
        assert np.isfinite(values).all(), what


def assert_results_finite(simulation):
    assert_finite(simulation.fields(), "fields")
    assert_finite(simulation.surface_fields(), "surface")
    assert_finite(simulation.last_step(), "step")
    assert_finite(simulation.checkpoint()["state/velocity"], "checkpoint")
    summary = simulation.summary()
    assert_finite(summary, "summary")
    json.dumps(summary, allow_nan=False)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_bodies_that_meet(scheme):
    analysis = {**CASE["analysis"], "scheme": SCHEMES[scheme]}
    simulation = build(carom.Scenario.from_dict({**CASE, "analysis": analysis}))
    while not simulation.advance(np.inf, 0.2):
        assert_results_finite(simulation)
    assert_results_finite(simulation)
    history = simulation.take_history()
    columns = simulation.history_columns()
    none = {columns[c] for c in np.flatnonzero(~np.isfinite(history).all(axis=0))}
    assert none <= {"min_gap"}


def test_a_body_of_revolution_that_lies_on_its_axis():
    """Facets and nodes on the axis have no area: nothing is divided by it."""
    case = {
        "analysis": {"end_time": 4e-3, "time_step": 1e-4},
        "materials": CASE["materials"],
        "bodies": [
            {
                "name": "rod",
                "material": "elastic",
                "hypothesis": "axisymmetric",
                "mesh": {
                    "kind": "rectangle",
                    "corner": [0.0, 0.01],
                    "size": [1.0, 2.0],
                    "divisions": [3, 4],
                },
                "velocity": [0.0, -5.0],
            }
        ],
        "obstacles": [{"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}],
    }
    simulation = build(carom.Scenario.from_dict(case))
    assert simulation.advance(np.inf, np.inf)
    assert simulation.summary()["contacts"]
    assert_results_finite(simulation)


def test_a_body_too_fast_for_its_energy_to_be_a_number_is_refused():
    bodies = [{**CASE["bodies"][0], "velocity": [1e200, 0.0]}]
    analysis = {"end_time": 1e-200, "time_step": 1e-201}
    with pytest.raises(carom.InputError, match="the initial energy is not finite"):
        build(
            carom.Scenario.from_dict({**CASE, "analysis": analysis, "bodies": bodies, "output": {}})
        )
