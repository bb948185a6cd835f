"""A block on a slope of tan θ = 0.5 slides with g (sin θ − μ cos θ), or does not."""

import numpy as np
import pytest

import carom

GRAVITY = 9.81
TANGENT = 0.5


def on_a_slope(friction, dimension, end=1.0):
    angle = np.arctan(TANGENT)
    up = [0.0] * (dimension - 1)
    down = [GRAVITY * np.sin(angle), *up[1:], -GRAVITY * np.cos(angle)]
    mesh = {
        "kind": "rectangle" if dimension == 2 else "box",
        "corner": [*up, 0.0],
        "size": [0.4] * (dimension - 1) + [0.2],
        "divisions": [3] * (dimension - 1) + [2],
    }
    rubber = {
        "kind": "neo-hookean",
        "young": 1e7,
        "poisson": 0.3,
        "density": 1000.0,
        "damping": {"stiffness": 1e-3},
    }
    simulation = carom.Simulation(
        carom.Scenario.from_dict(
            {
                "dimension": dimension,
                "analysis": {"end_time": end, "time_step": 2e-3, "gravity": down},
                "materials": {"rubber": rubber},
                "bodies": [{"name": "block", "material": "rubber", "mesh": mesh}],
                "obstacles": [
                    {"name": "slope", "kind": "plane", "point": [*up, 0.0], "normal": [*up, 1.0]}
                ],
                "contact": {"friction": friction},
            }
        )
    )
    while simulation.time < end - 1e-9:
        simulation.step()
    history = simulation.history
    time, speed = np.asarray(history["time"]), np.asarray(history["block.v_x"])
    late = time > 0.6 * end
    return np.polyfit(time[late], speed[late], 1)[0], speed[-1]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("friction", [0.0, 0.3, 0.49, 0.499, 0.5])
def test_it_slides_as_the_angle_says(friction, dimension):
    acceleration, _ = on_a_slope(friction, dimension)
    angle = np.arctan(TANGENT)
    wanted = GRAVITY * (np.sin(angle) - friction * np.cos(angle))
    # Measured: 5e-13.
    assert acceleration == pytest.approx(wanted, abs=5e-12)


@pytest.mark.parametrize("dimension", [2, 3])
def test_it_sticks_where_friction_holds_it(dimension):
    acceleration, speed = on_a_slope(0.51, dimension)
    assert abs(acceleration) < 1e-13
    assert abs(speed) < 1e-13
