"""What slides over a concave kink stays outside of both of its sides."""

import sys
from pathlib import Path

import pytest

import carom

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import random_scenes


@pytest.mark.parametrize(
    ("seed", "was"),
    [
        pytest.param(200, 2.8e-5, id="before the facet that it came to first"),
        pytest.param(375, 1.6e-5, id="while two facets change places"),
        pytest.param(49, 8.8e-6, id="from a node that it stood on"),
        pytest.param(390, 1.9e-5, id="back over a convex one"),
    ],
)
def test_a_node_that_slides_over_the_kink_of_a_bent_side_stays_outside(seed, was, tmp_path):
    """Symptom guarded against: it was so far inside [m], and later steps kept it there."""
    scenario = random_scenes.scene(seed, "conserving", "massless")
    summary = carom.run(scenario, out=tmp_path).summary
    # Measured: 4e-12 m at most; of bodies of a metre.
    assert summary["min_gap"] > -2e-11 > -was
    assert summary["energy"]["max_defect"] < 1e-12 * summary["energy"]["initial"]


@pytest.mark.parametrize("condition", ["gap", "midpoint"])
def test_a_block_that_slides_through_a_valley_stays_outside_of_both_slopes(condition, tmp_path):
    """Symptom guarded against: with `midpoint` a corner went in by 0.8 mm, and stayed there."""
    block = carom.Body(
        name="block",
        material="soft",
        mesh=carom.Rectangle(corner=[-1.0, 0.21], size=[0.3, 0.2], divisions=[3, 2]),
        velocity=[2.0, -0.8],
    )
    points = [[-2.0, -1.0], [2.0, -1.0], [2.0, 0.4], [0.0, 0.0], [-2.0, 0.4]]
    scenario = carom.Scenario(
        analysis=carom.Dynamic(
            end_time=1.0, time_step=2e-3, scheme={"kind": "conserving"}, gravity=[0.0, -9.81]
        ),
        materials={"soft": carom.NeoHookean(young=1e5, poisson=0.3, density=100.0)},
        bodies=[block],
        obstacles=[carom.RigidPolygon(name="valley", points=points)],
        contact=carom.Contact(condition=condition, friction=0.4),
    )
    # Measured: 8e-14 and 6e-12 m.
    assert carom.run(scenario, out=tmp_path).summary["min_gap"] > -6e-11
