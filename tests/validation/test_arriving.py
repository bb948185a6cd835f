"""What arrives with the condition `endpoint` is stopped before it is inside, however fast it is."""

import sys
from pathlib import Path

import pytest
from rolling_bodies import floor

import carom

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import wild_scenes


@pytest.mark.filterwarnings("ignore::carom.CaromWarning")
@pytest.mark.parametrize(
    ("seed", "was"),
    [
        pytest.param(40, 0.13, id="a node that turns round far from where the step was foretold"),
        pytest.param(66, 0.46, id="a corner that a wave throws at a wall"),
        pytest.param(91, 0.020, id="a whole step after one that was taken in halves"),
        pytest.param(89, 0.023, id="what comes into sight at the end of a step"),
    ],
)
def test_what_arrives_is_seen_wherever_it_comes_from(seed, was, tmp_path):
    """Symptom guarded against: bodies were so far inside walls [m], some for good, and completed.

    A step looked only at what it had found on the way that was foretold, and took the next one for
    as short as itself.
    """
    scenario = wild_scenes.scene(seed)
    assert scenario.contact.condition == "endpoint"
    penetration = carom.run(scenario, out=tmp_path).summary["penetration"]
    assert penetration["max_depth"] <= 1e-9 * was


def test_what_starts_too_near_to_be_stopped_goes_in_by_half_of_its_way(tmp_path):
    """A block that starts 1 mm above the floor and falls 20 mm in a step is stopped 9 mm below."""
    block = carom.RigidBody(
        name="block",
        density=1.0,
        mesh=carom.Rectangle(corner=[0.0, 1e-3], size=[0.2, 0.2], divisions=[2, 2]),
        velocity=[0.0, -2.0],
    )
    scenario = carom.Scenario(
        dimension=2,
        analysis=carom.Dynamic(end_time=0.1, time_step=0.01),
        bodies=[block],
        obstacles=[floor(2)],
        contact=carom.Contact(condition="endpoint"),
    )
    penetration = carom.run(scenario, out=tmp_path).summary["penetration"]
    assert penetration["max_depth"] == pytest.approx(9e-3, rel=1e-9)
    # A hundredth of the diameter of a facet, and no more than it went in at first.
    assert penetration["worst"]["allowed"] == pytest.approx(1e-3 + 9e-3, rel=1e-9)
