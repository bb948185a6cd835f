"""Where the energy of an impact goes, against closed forms."""

import math

import numpy as np
import pytest

import carom

YOUNG, DENSITY = 1e4, 1.0
SPEED_OF_SOUND = math.sqrt(YOUNG / DENSITY)
SPEED = 1e-3 * SPEED_OF_SOUND


def bar(name, start, length, cells, **more):
    mesh = carom.Rectangle(
        corner=[start, 0.0], size=[length, 0.02], divisions=[round(length * cells), 1]
    )
    return carom.Body(name=name, material="elastic", mesh=mesh, **more)


def bars(cells, ratio, out):
    """Let a bar of 1 m hit one that is so many times as long and at rest."""
    gap = 1e-3
    scenario = carom.Scenario(
        analysis=carom.Dynamic(
            end_time=gap / SPEED + 2.4 / SPEED_OF_SOUND, time_step=1.0 / (cells * SPEED_OF_SOUND)
        ),
        materials={
            "elastic": carom.SaintVenantKirchhoff(young=YOUNG, poisson=0.0, density=DENSITY)
        },
        bodies=[
            bar("short", -1.0 - gap, 1.0, cells, velocity=[SPEED, 0.0], contact_sets=["right"]),
            bar("long", 0.0, ratio, cells, contact_sets=["left"]),
        ],
        output=carom.Output(history_every=1e-3),
    )
    return carom.run(scenario, out=out)


@pytest.mark.parametrize(("ratio", "off"), [(1.5, 8e-3), (2.0, 1.4e-2)])
def test_unequal_bars_part_at_the_ratio_of_their_lengths(tmp_path, ratio, off):
    """e = L₁/L₂: the short bar comes to rest, and a wave is left in the long one (Saint-Venant)."""
    errors = []
    for cells in (50, 100):
        result = bars(cells, ratio, tmp_path / str(cells))
        (event,) = result.summary["contacts"]
        impact, energy = event["impact"], result.summary["energy"]
        errors.append(impact["restitution"] - 1.0 / ratio)
        # m₁ m₂ / (m₁ + m₂) (1 + e) v
        mass = 0.02 * DENSITY * ratio / (1.0 + ratio)
        impulse = mass * (1.0 + impact["restitution"]) * SPEED
        assert impact["impulse"] == pytest.approx(impulse, rel=1e-9)
        assert impact["approach"] == pytest.approx(SPEED, rel=1e-12)
        rings = impact["vibration"] + impact["strain"]
        assert impact["translation"] == pytest.approx(-rings, abs=1e-9 * energy["initial"])
        assert impact["rotation"] == pytest.approx(0.0, abs=1e-9 * energy["initial"])
    assert abs(errors[1]) < off
    assert abs(errors[1]) < 0.7 * abs(errors[0])


def test_a_disc_that_slips_throughout_gains_the_spin_that_friction_gives(tmp_path):
    """Rigid disc on a rough floor: e as given, e_t = −1 + 3 μ (1 + e) v_n / v_t."""
    mu, e, down, along = 0.1, 0.5, 2.0, 5.0
    disc = carom.RigidBody(
        name="disc",
        density=1000.0,
        mesh=carom.Disc(centre=[0.0, 0.11], radius=0.1, divisions=4),
        round=True,
        velocity=[along, -down],
    )
    scenario = carom.Scenario(
        analysis=carom.Dynamic(end_time=0.02, time_step=1e-4),
        bodies=[disc],
        obstacles=[carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0])],
        contact=carom.Contact(condition="endpoint", friction=mu, restitution=e),
        output=carom.Output(history_every=1e-3),
    )
    result = carom.run(scenario, out=tmp_path / "disc")
    (event,) = result.summary["contacts"]
    impact, history = event["impact"], result.history
    mass = 2.0 * result.summary["energy"]["initial"] / (down**2 + along**2)
    # The place of the impulse is known but for the turn of a step.
    assert impact["restitution"] == pytest.approx(e, rel=3e-4)
    assert impact["impulse"] == pytest.approx(mass * (1.0 + e) * down, rel=1e-9)
    assert impact["friction_impulse"] == pytest.approx(mu * mass * (1.0 + e) * down, rel=1e-9)
    assert impact["sliding"] == pytest.approx(along, rel=1e-9)
    # The mesh of the disc has a little less inertia than a round one.
    wanted = -1.0 + 3.0 * mu * (1.0 + e) * down / along
    assert impact["tangential_restitution"] == pytest.approx(wanted, abs=0.01)
    lost = impact["translation"] + impact["rotation"]
    assert history["kinetic"][-1] - history["kinetic"][0] == pytest.approx(lost, rel=1e-9)
    assert abs(impact["vibration"]) < 1e-12 * history["kinetic"][0]


def test_kinetic_energy_is_that_of_its_parts(tmp_path):
    """A ball that spins, flies and rings: Σ of the parts, and no vibration before it hits."""
    ball = carom.Body(
        name="ball",
        material="elastic",
        mesh=carom.Ball(centre=[0.0, 0.0, 0.55], radius=0.5, divisions=2),
        velocity=[0.3, 0.0, -1.0],
        spin=[0.5, 1.0, -0.5],
    )
    scenario = carom.Scenario(
        dimension=3,
        analysis=carom.Dynamic(end_time=0.4, time_step=5e-3),
        materials={"elastic": carom.SaintVenantKirchhoff(young=500.0, poisson=0.3, density=1.0)},
        bodies=[ball],
        obstacles=[carom.Plane(name="floor", point=[0.0, 0.0, 0.0], normal=[0.0, 0.0, 1.0])],
        contact=carom.Contact(friction=0.2),
        output=carom.Output(history_every=5e-3),
    )
    history = carom.run(scenario, out=tmp_path / "ball").history
    parts = history["translation"] + history["rotation"] + history["vibration"]
    first = history["kinetic"][0]
    np.testing.assert_allclose(parts, history["kinetic"], rtol=1e-13)
    np.testing.assert_allclose(history["ball.strain"], history["strain"], rtol=1e-13)
    assert history["ball.vibration"].min() > -1e-14 * first
    assert abs(history["ball.vibration"][0]) < 1e-14 * first
    assert history["ball.vibration"].max() > 0.01 * first
    drift = 0.5 * (history["ball.v_x"] ** 2 + history["ball.v_y"] ** 2 + history["ball.v_z"] ** 2)
    mass = history["translation"][0] / drift[0]
    np.testing.assert_allclose(history["ball.translation"], mass * drift, rtol=1e-12)
