"""Everyday static contact: blocks, strips and seals between plates, against closed forms."""

import numpy as np
import pytest

import carom

STEPS = 10


def plates(height: float, down: float) -> list[carom.Plane]:
    """A plate at y = 0 and one at `height` [m] that comes down by `down` [m] in 1 s."""
    return [
        carom.Plane(name="below", point=[0.0, 0.0], normal=[0.0, 1.0]),
        carom.Plane(
            name="above", point=[0.0, height], normal=[0.0, -1.0], motion={"y": f"-{down}*t"}
        ),
    ]


def run(folder, law, body, steps=STEPS, analysis=(), **others) -> carom.Result:
    analysis = carom.Static(end_time=1.0, time_step=1.0 / steps, **dict(analysis))
    output = carom.Output(history_every=1.0 / steps, fields_every=1.0)
    scenario = carom.Scenario(
        analysis=analysis, output=output, materials={"law": law}, bodies=[body], **others
    )
    return carom.run(scenario, out=folder / "out")


def square(law: str = "law", divisions: int = 10) -> carom.Body:
    mesh = carom.Rectangle(corner=[0.0, 0.0], size=[0.1, 0.1], divisions=[divisions, divisions])
    return carom.Body(name="block", material=law, mesh=mesh)


def neo_hookean_energy(young: float, poisson: float, stretch: float) -> float:
    """Energy per area of a plane that is pressed to `stretch` and free across (Simo & Pister)."""
    mu = young / (2.0 * (1.0 + poisson))
    lame = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
    low, high = 1.0, 3.0
    for _ in range(200):
        across = 0.5 * (low + high)
        log_j = np.log(across * stretch)
        pull = mu * (across - 1.0 / across) + lame * log_j / across
        low, high = (across, high) if pull < 0.0 else (low, across)
    log_j = np.log(across * stretch)
    return mu * (0.5 * (across**2 + stretch**2 - 2.0) - log_j) + 0.5 * lame * log_j**2


@pytest.mark.parametrize("down", [0.3, 0.4])
def test_a_block_between_plates_without_friction_is_pressed_as_its_law_says(tmp_path, down):
    """Symptom guarded against: at 27 % the block that both plates hold was said not to be held."""
    result = run(
        tmp_path,
        carom.NeoHookean(young=3e6, poisson=0.3, density=1000.0),
        square(),
        motions=[carom.Fixed(body="block", on="left", components=["x"])],
        obstacles=plates(0.1, 0.1 * down),
    )
    exact = neo_hookean_energy(3e6, 0.3, 1.0 - down) * 0.01
    history = result.history
    assert history["strain"][-1] == pytest.approx(exact, rel=1e-11)
    # Measured: 6 a load step.
    assert max(history["newton_iterations"][1:]) <= 7
    assert max(abs(history["defect"])) < 1e-12 * exact


def test_a_bonded_block_is_pressed_to_sixty_per_cent(tmp_path):
    result = run(
        tmp_path,
        carom.NeoHookean(young=3e6, poisson=0.3, density=1000.0),
        square(),
        motions=[
            carom.Fixed(body="block", on="bottom"),
            carom.Prescribed(body="block", on="top", x=0.0, y="-0.04*t"),
        ],
    )
    history = result.history
    assert result.summary["retried_steps"] == 0
    assert max(history["newton_iterations"][1:]) <= 6
    # Nothing but the press works, and elastic bodies store it.
    assert abs(history["scheme"][-1]) < 2e-3 * history["strain"][-1]
    assert max(abs(history["defect"])) < 1e-12 * history["strain"][-1]


def test_what_a_load_step_books_as_scheme_is_of_third_order_in_the_step(tmp_path):
    taken = []
    for steps in (10, 20):
        result = run(
            tmp_path / str(steps),
            carom.SaintVenantKirchhoff(young=3e6, poisson=0.3, density=1000.0),
            square(divisions=4),
            steps=steps,
            motions=[
                carom.Fixed(body="block", on="bottom"),
                carom.Prescribed(body="block", on="top", x="0.02*t", y="0.02*t"),
            ],
        )
        taken.append(abs(result.history["scheme"][-1]))
    # A step of a third order, and twice as many of them: a fourth.
    assert taken[1] == pytest.approx(taken[0] / 4.0, rel=0.05)


@pytest.mark.parametrize("size", [(10.0, 0.05), (10.0, 1.0), (4.0, 1.0), (1.0, 1.0)])
def test_a_strip_on_a_floor_takes_one_iteration_where_nothing_changes(tmp_path, size):
    """Symptom guarded against: strips that lie on a floor were said not to be held."""
    length, height = size
    divisions = [max(int(length / max(height, 0.2)), 2), max(int(4 * height), 1)]
    result = run(
        tmp_path,
        carom.LinearElastic(young=1e6, poisson=0.0, density=1.0),
        carom.Body(
            name="bar",
            material="law",
            mesh=carom.Rectangle(corner=[0.0, 0.0], size=list(size), divisions=divisions),
        ),
        loads=[carom.Pressure(body="bar", on="top", pressure=1000.0)],
        motions=[carom.Fixed(body="bar", on="right", components=["x"])],
        obstacles=[carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0])],
    )
    history = result.history
    # Measured: 5.8e-9 of the thinnest, which bends at almost no force.
    exact = 0.5 * 1000.0**2 / 1e6 * length * height
    assert history["strain"][-1] == pytest.approx(exact, rel=5e-8)
    assert history["normal_force"][-1] == pytest.approx(1000.0 * length, rel=1e-9)
    assert list(history["newton_iterations"][2:]) == [1] * (STEPS - 1)


def test_a_rubber_ring_is_squeezed_between_plates(tmp_path):
    """Symptom guarded against: at 22 % the free motion of the contacts was not finite."""
    result = run(
        tmp_path,
        carom.MooneyRivlin(c10=0.4e6, c01=0.1e6, bulk=2e8, density=1100.0),
        carom.Body(
            name="ring",
            material="law",
            formulation="mean-dilatation",
            hypothesis="axisymmetric",
            mesh=carom.Disc(centre=[0.02, 0.0025], radius=0.0025, divisions=8),
        ),
        steps=20,
        obstacles=plates(0.005, 0.0015),
        contact=carom.Contact(friction=0.3),
    )
    history = result.history
    assert result.summary["retried_steps"] == 0
    # Measured: 22.5. Nearly incompressible, it is held back by a share of its pressure waves.
    assert np.mean(history["newton_iterations"][1:]) < 30.0
    assert max(abs(history["defect"])) < 1e-12 * history["strain"][-1]
    # The lower plate pushes back as the upper one presses.
    assert history["friction"][-1] > 0.0


def test_a_block_that_loses_its_hold_moves_on_to_the_next(tmp_path):
    """Pushed beyond what friction bears, it slides until a wall holds it."""
    case = {
        "loads": [
            carom.Pressure(body="block", on="top", pressure=1e4),
            carom.Traction(body="block", on="left", traction=["6e3*t", 0.0]),
        ],
        "obstacles": [
            carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0]),
            carom.Plane(name="wall", point=[0.102, 0.0], normal=[-1.0, 0.0]),
        ],
        "contact": carom.Contact(friction=0.3),
    }
    law = carom.NeoHookean(young=3e6, poisson=0.3, density=1000.0)
    result = run(tmp_path, law, square(divisions=4), analysis={"stabilisation": "dynamic"}, **case)
    history = result.history
    pairs = result.summary["pairs"]
    assert history["block.x"][-1] - history["block.x"][0] == pytest.approx(0.002, rel=0.02), pairs
    # What friction on the floor does not bear, the wall does: 600 N of traction against 300 N.
    assert history["kinetic"][-1] == 0.0
    # All that the way there took is the scheme's. Measured: 4e-15 J.
    assert max(abs(history["defect"])) < 1e-13 * history["external"][-1]
