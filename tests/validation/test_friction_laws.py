"""Friction that depends on the sliding: masses on springs and blocks, beside closed forms."""

import numpy as np
import pytest
from friction_laws import (
    GRAVITY,
    LOAD,
    OMEGA,
    SLIP,
    oscillation,
    sliding_block,
    stick_slip,
    weakening,
)
from rigid_bodies import run

import carom
from carom.building.build import build


def test_stick_slip_on_a_belt_is_that_of_the_closed_form():
    """A step more of sticking or sliding is the error: T_stick, T_slip and the amplitude."""
    coarse, fine = stick_slip(4e-3), stick_slip(5e-4)
    assert max(fine) < 5e-3
    for errors, step in ((coarse, 4e-3), (fine, 5e-4)):
        assert max(errors[:2]) < 2.0 * step / SLIP
        assert max(errors[2:]) < 2.0 * step * OMEGA


@pytest.mark.parametrize(("static", "kinetic"), [(0.1, 0.1), (0.45, 0.1)])
def test_dry_friction_stops_a_swing(static, kinetic):
    reached, wanted = oscillation(static, kinetic)
    assert reached == pytest.approx(wanted, abs=1e-6 * wanted[0])


def test_slip_weakening_takes_its_fracture_energy():
    taken, by_hand, defect, certificate = weakening(1e-4)
    assert taken == pytest.approx(by_hand, rel=5e-8)
    assert max(defect, certificate) < 1e-12


@pytest.mark.parametrize("condition", ["midpoint", "gap", "endpoint"])
def test_viscous_friction_slows_a_block_as_an_exponential_does(tmp_path, condition):
    """m v' = −N (μ + c v), for every condition that a law goes with."""
    mu, viscous = 0.1, 0.4
    law = carom.StaticKinetic(kinetic=mu, viscous=viscous)
    result = run(tmp_path, sliding_block(law, condition=condition))
    history, time = result.history, np.asarray(result.history["time"])
    exact = (1.0 + mu / viscous) * np.exp(-GRAVITY * viscous * time) - mu / viscous
    assert result.summary["status"] == "completed"
    # Velocities at the end of a step, friction of its mean velocity: second order.
    worst = np.abs(history["block.v_x"] - np.maximum(exact, 0.0)).max()
    assert worst < (5e-6 if condition != "endpoint" else 2e-3)
    assert history["friction_defect"].max() < 1e-14


def test_a_formula_is_the_law_that_it_writes_out(tmp_path):
    written = carom.StaticKinetic(static=0.4, kinetic=0.1, speed=0.3, viscous=0.05)
    formula = carom.FrictionFormula(formula="0.1 + 0.3*exp(-v/0.3) + 0.05*v")
    one, other = (run(tmp_path, sliding_block(law)) for law in (written, formula))
    for name in ("block.v_x", "friction", "certificate"):
        assert np.asarray(one.history[name]) == pytest.approx(
            np.asarray(other.history[name]), abs=1e-13
        )
    assert one.summary["status"] == other.summary["status"] == "completed"


def test_rate_and_state_friction_follows_a_step_of_speed(tmp_path):
    """μ rises by a ln, falls by b ln over D_c of slip: the age at constant speed is known."""
    a, b, speed, critical = 0.01, 0.015, 1e-3, 1e-4
    slow, fast, jump, step = 1e-3, 5e-3, 0.1, 1e-3
    law = carom.RateAndState(reference=0.6, direct=a, evolution=b, speed=speed, distance=critical)
    case = sliding_block(law, time_step=step, end_time=0.2)
    path = carom.Table(time=[0.0, jump, 1.0], value=[0.0, slow * jump, slow * jump + fast * 0.9])
    body = case.bodies[0].model_copy(update={"velocity": None})
    guided = carom.Guided(body="block", x=path, turn_z=0.0)
    result = run(tmp_path, case.model_copy(update={"bodies": (body,), "motions": (guided,)}))
    assert result.summary["status"] == "completed"
    time = np.asarray(result.history["time"])
    middle = 0.5 * (time[1:] + time[:-1])
    v = np.where(middle < jump, slow, fast)
    age = np.where(
        middle < jump,
        critical / slow,
        critical / fast
        + (critical / slow - critical / fast) * np.exp(-fast * (middle - jump) / critical),
    )
    wanted = 0.6 + a * np.log1p(v / speed) + b * np.log1p(age * speed / critical)
    found = np.diff(result.history["friction"]) / (LOAD * v * step)
    # A body that is guided presses with its weight from the first step on.
    assert found == pytest.approx(wanted, abs=1e-9)
    assert wanted.max() - wanted.min() > 0.01


def test_what_contacts_have_slid_is_there_after_a_restart():
    """A run that stops in the middle of its weakening goes on to the last bit."""
    law = carom.StaticKinetic(static=0.5, kinetic=0.1, distance=0.2)
    whole, other = build(sliding_block(law)), build(sliding_block(law))
    whole.advance(0.05, np.inf)
    other.restore(whole.checkpoint())
    assert 0.0 < whole.checkpoint()["state/sliding/distance"].max() < 0.06
    for run_on in (whole, other):
        run_on.advance(0.3, np.inf)
    last, wanted = other.checkpoint(), whole.checkpoint()
    kept = [name for name in wanted if name.startswith("state/")]
    assert [name for name in kept if not np.array_equal(last[name], wanted[name])] == []
    assert wanted["state/sliding/distance"].min() > 0.1


def test_a_law_without_a_fixed_point_fails_its_step(tmp_path):
    """With 0.1 the block slides too fast for 0.1, with 0.6 too slowly for 0.6."""
    law = carom.FrictionFormula(formula="where(v > 0.5, 0.6, 0.1)")
    case = sliding_block(law).with_overrides(
        ["bodies.0.velocity=[0.502, 0]", "analysis.max_halvings=0"]
    )
    with pytest.raises(carom.ConvergenceError, match="law has no fixed point in this step"):
        run(tmp_path, case)


def test_a_law_that_gives_no_coefficient_fails_its_step(tmp_path):
    with pytest.raises(carom.ConvergenceError, match=r"the friction law gives -0\.\d+ at a slip"):
        run(tmp_path, sliding_block(carom.FrictionFormula(formula="0.3 - v")))


def test_a_static_analysis_has_laws_of_the_distance_alone():
    def pressed(law):
        case = sliding_block(law)
        support = carom.Guided(body="block", x=0.0, turn_z=0.0)
        analysis = carom.Static(end_time=1.0, time_step=0.5, gravity=[0.0, -GRAVITY])
        body = case.bodies[0].model_copy(update={"velocity": None})
        contact = case.contact.model_copy(update={"condition": "gap"})
        changes = {"analysis": analysis, "bodies": (body,), "motions": (support,)}
        output = carom.Output()
        return case.model_copy(update={**changes, "contact": contact, "output": output})

    carom.Simulation(pressed(carom.StaticKinetic(static=0.5, kinetic=0.2, distance=0.01)))
    for law in (
        carom.StaticKinetic(static=0.5, kinetic=0.2, speed=0.01),
        carom.StaticKinetic(kinetic=0.2, viscous=0.01),
        carom.FrictionFormula(formula="0.2 + v"),
    ):
        with pytest.raises(carom.InputError, match="a static analysis has no speed of slip"):
            carom.Simulation(pressed(law))


def test_loops_of_others_have_coefficients_alone():
    surface = carom.contact.Surface("block", [[0, 1]])
    law = carom.StaticKinetic(static=0.5, kinetic=0.2)
    with pytest.raises(carom.InputError, match="needs the steps of carom, which give it a fixed"):
        carom.contact.ContactModel([[0.0, 0.0], [1.0, 0.0]], [surface], friction=law)


def test_the_audit_confirms_laws(tmp_path):
    run(tmp_path, sliding_block(carom.StaticKinetic(static=0.5, kinetic=0.2), end_time=0.1))
    assert carom.audit(tmp_path / "0").refuted == ()
