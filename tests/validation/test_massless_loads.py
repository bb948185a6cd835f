"""Loads on nodes without mass: these give way at once, and vibration has the energy soon after."""

import numpy as np
import pytest
from runs import simulate

import carom

YOUNG, DENSITY, PRESSURE = 1e6, 1000.0, 1e5  # Pa, kg/m³, Pa
STEP = 1e-3  # s, a tenth of what a wave needs for a third of the block
FLOOR = carom.Plane(name="floor", point=[0, 0], normal=[0, 1])
RUBBER = {"rubber": carom.SaintVenantKirchhoff(young=YOUNG, poisson=0.3, density=DENSITY)}


def block(cells, *, height=5.0, **more):
    """A block of 1 m × 1 m over the floor, which it does not reach."""
    mesh = carom.Rectangle(corner=[0, height], size=[1, 1], divisions=[cells, cells])
    return carom.Body(name="block", material="rubber", mesh=mesh, **more)


def pressed(cells, pressure, **more):
    return carom.Scenario(
        analysis=carom.Dynamic(end_time=0.1, time_step=STEP),
        materials=RUBBER,
        bodies=[block(cells, **more)],
        obstacles=[FLOOR],
        loads=[carom.Pressure(body="block", on="top", pressure=pressure)] if pressure else [],
        output=carom.Output(history_every=STEP, fields_every=1.0),
    )


def open_steps(run):
    """Return the last step after which the books are open."""
    defect = np.abs(run.history["defect"])
    largest = max(abs(run.summary["energy"]["external"]), run.history["total"].max())
    return np.flatnonzero(defect > 1e-11 * largest).max(initial=0)


@pytest.mark.parametrize("cells", [3, 8])
@pytest.mark.parametrize(
    ("pressure", "impulse"),
    [
        (f"{PRESSURE}*t", 0.5 * PRESSURE * 0.1**2),
        (f"{PRESSURE}", PRESSURE * 0.1),
        (f"{PRESSURE}*step(t - 0.05)", PRESSURE * 0.05),
    ],
)
def test_a_load_may_set_in_on_a_body_at_rest(cells, pressure, impulse):
    """Symptom guarded against: any load on a block at rest failed in its first step."""
    run = simulate(pressed(cells, pressure))
    # The step in which a load jumps may be halved, those of loads that begin with the run are not.
    assert run.summary["retried_steps"] <= (10 if "step" in pressure else 0)
    sets_in = 50 if "step" in pressure else 0
    assert open_steps(run) < sets_in + 20
    # The load of a step is that of its middle: right at once where it does not jump within it.
    late = 0.5 * STEP * PRESSURE if "step" in pressure else 0.0
    assert run.history["momentum_y"][-1] == pytest.approx(-impulse, abs=1e-9 * impulse + late)


@pytest.mark.parametrize("cells", [3, 8])
def test_a_body_may_start_under_a_stress_that_nothing_holds(cells):
    stress = carom.InitialStress(xx=1e4)
    run = simulate(pressed(cells, None, initial_stress=stress))
    assert run.summary["retried_steps"] == 0
    assert open_steps(run) < 15
    total = run.history["total"]
    assert total[-1] == pytest.approx(total[0], rel=1e-12)


@pytest.mark.filterwarnings("ignore:.*vibrations")
@pytest.mark.parametrize("cells", [3, 12])
def test_what_was_pressed_may_be_let_go(cells, tmp_path):
    """Symptom guarded against: half of its energy was missing when the load was gone."""
    case = carom.Scenario(
        materials=RUBBER,
        bodies=[block(cells, height=0.0)],
        obstacles=[FLOOR],
        stages=[
            carom.Stage(
                name="press",
                analysis=carom.Static(end_time=1.0, time_step=0.25),
                loads=[carom.Pressure(body="block", on="top", pressure=f"{PRESSURE}*t")],
                motions=[carom.Fixed(body="block", on="left", components=["x"])],
            ),
            carom.Stage(
                name="free",
                analysis=carom.Dynamic(end_time=1.3, time_step=STEP),
                removed_loads=[carom.RemovedLoad(kind="pressure", body="block", on="top")],
                removed_motions=[carom.RemovedMotion(body="block", on="left")],
            ),
        ],
    )
    history = carom.run(case, out=tmp_path).history
    pressed_in = history["strain"][np.searchsorted(history["time"], 1.0)]
    assert history["total"][-1] == pytest.approx(pressed_in, rel=1e-11)
    assert history["block.y"][-1] > 1.1


def test_what_waited_for_vibrations_is_told_as_such(tmp_path):
    """Symptom guarded against: it was put down to the time step, whatever the step."""
    with pytest.warns(carom.CaromWarning) as told:
        carom.run(pressed(3, f"{PRESSURE}"), out=tmp_path)
    defect = next(str(each.message) for each in told if "the ledger" in str(each.message))
    assert "until vibrations had it" in defect
    assert "time_step" not in defect
