"""Two cylinders in contact, against Hertz, and Cattaneo and Mindlin.

K. L. Johnson, Contact Mechanics, Cambridge University Press 1985, sections 4.2(c) and 7.2(a). The
example on finer meshes finds the forces of the published benchmark too.
"""

import importlib.util
import math
import sys

import pytest


@pytest.fixture
def hertz(examples):
    spec = importlib.util.spec_from_file_location("hertz_2d", examples / "hertz_2d.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["hertz_2d"] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("discretisation", ["mortar", "node-to-segment"])
def test_pressed_cylinders_have_the_pressure_of_hertz_and_stick_where_mindlin_says(
    hertz, discretisation
):
    press = hertz.Press(20, discretisation=discretisation)
    pushed = press.profile(0.18, 0.03)
    normal, tangential = pushed.force[0], abs(pushed.force[1])
    assert 8 < normal < 12
    assert 0.3 < tangential / (hertz.FRICTION * normal) < 0.7
    width = hertz.HALF_WIDTH * math.sqrt(normal / hertz.FORCE)
    peak = hertz.PEAK * math.sqrt(normal / hertz.FORCE)
    stick = width * math.sqrt(1 - tangential / (hertz.FRICTION * normal))
    found_width, found_peak = pushed.half_width
    # Mortar: 2.2 %, and 0.2 % with 28 cells.
    assert found_width == pytest.approx(width, rel=0.03)
    assert found_peak == pytest.approx(peak, rel=0.01)
    assert pushed.stick_half_width == pytest.approx(stick, rel=0.06)
