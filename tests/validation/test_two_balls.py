"""Two balls in a rigid box, the paper's two cylinders in space: ``examples/two_balls.toml``.

Energy is exact with the scheme ``conserving`` and the condition ``midpoint``: what is asserted is
round-off, as far as the tolerances of Newton's iterations and of the friction solver let it.
"""

from functools import cache

import pytest
from runs import example, simulate


@pytest.fixture(scope="module")
def balls_run():
    @cache
    def run(friction):
        coarse = [f"bodies.{body}.mesh.divisions=2" for body in (0, 1)]
        changes = [f"contact.friction={friction}", "analysis.end_time=3.0"]
        return simulate(example("two_balls.toml", *coarse, *changes))

    return run


@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_the_balls_meet_one_another_and_the_walls(balls_run, friction):
    pairs = {frozenset(contact["pair"]) for contact in balls_run(friction).summary["contacts"]}
    assert frozenset(["first", "second"]) in pairs
    assert len(pairs) >= 4


def test_frictionless_impacts_conserve_energy(balls_run):
    assert balls_run(0.0).energy("max_drift") <= 2e-12


def test_books_close_with_friction(balls_run):
    run = balls_run(0.2)
    assert run.energy("friction") >= 0.05
    assert run.energy("max_defect") <= 1e-12
