"""A block on a slope of tan θ = 0.5 slides with g (sin θ − μ cos θ), or does not."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from creep import GRAVITY, incline

ANGLE = np.arctan(0.5)


def on_a_slope(friction, dimension, end=1.0):
    history = incline(dimension, ANGLE, friction, end).history
    time, speed = np.asarray(history["time"]), np.asarray(history["block.v_x"])
    late = time > 0.6 * end
    return np.polyfit(time[late], speed[late], 1)[0], speed[-1]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("friction", [0.0, 0.3, 0.49, 0.499, 0.5])
def test_it_slides_as_the_angle_says(friction, dimension):
    acceleration, _ = on_a_slope(friction, dimension)
    wanted = GRAVITY * (np.sin(ANGLE) - friction * np.cos(ANGLE))
    # Measured: 5e-13.
    assert acceleration == pytest.approx(wanted, abs=5e-12)


@pytest.mark.parametrize("dimension", [2, 3])
def test_it_sticks_where_friction_holds_it(dimension):
    acceleration, speed = on_a_slope(0.51, dimension)
    assert abs(acceleration) < 1e-13
    assert abs(speed) < 1e-13
