"""Friction that depends on the pressure: limits of shear."""

import numpy as np
import pytest
from pressure_pad import FRICTION, LAW, SHEAR, dragged, thrown
from runs import simulate

import carom


def test_a_limit_of_shear_stops_a_block_by_its_area():
    """10 Pa on 1 m² and more than τ/μ everywhere: friction is τ A and no longer μ N."""
    run = simulate(thrown(LAW))
    time = run.history["time"]
    assert run.history["block.v_x"] == pytest.approx(1.0 - SHEAR * time, abs=1e-9)
    assert run.history["friction"][-1] == pytest.approx(
        SHEAR * (time[-1] - 0.5 * SHEAR * time[-1] ** 2), rel=1e-9
    )
    assert run.history["friction_defect"].max() < 1e-10
    assert np.abs(run.history["defect"]).max() < 1e-12


def test_a_wide_block_has_coulombs_friction():
    """On 4 m² the pressure is below τ/μ: nothing but μ counts."""
    law, constant = simulate(thrown(LAW, width=4.0)), simulate(thrown(FRICTION, width=4.0))
    for column in ("block.v_x", "friction"):
        assert law.history[column] == pytest.approx(constant.history[column], abs=1e-11)


@pytest.mark.parametrize(
    ("discretisation", "sources", "within"),
    [
        ("node-to-segment", "both", 0.06),
        ("node-to-segment", "first", 0.06),
        ("mortar", "first", 0.06),
    ],
)
def test_a_pad_that_slides_is_held_by_its_width(discretisation, sources, within):
    """However its contact is written: with τ far below μ p the shear is τ everywhere."""
    law = carom.FrictionFormula(formula="min(0.5, 0.2/p)")
    case = dragged(law, discretisation=discretisation, sources=sources)
    history = simulate(case).history
    assert abs(history["pad.top.force_x"][-1]) == pytest.approx(0.2, rel=within)
    assert abs(history["pad.top.force_y"][-1]) > 1.5
    assert history["friction_defect"].max() < 1e-8


def test_pressures_that_nodes_do_not_have_are_refused():
    case = thrown(LAW)
    quadratic = case.bodies[0].mesh.model_copy(update={"cell": "quad8"})
    body = case.bodies[0].model_copy(update={"mesh": quadratic})
    with pytest.raises(carom.InputError, match="second order, whose nodes have no pressure"):
        simulate(case.model_copy(update={"bodies": (body,)}))
    disc = carom.Disc(centre=[0.0, 1.0], radius=1.0, divisions=4)
    body = case.bodies[0].model_copy(update={"mesh": disc, "round": True})
    with pytest.raises(carom.InputError, match="is round and has no area"):
        simulate(case.model_copy(update={"bodies": (body,)}))
