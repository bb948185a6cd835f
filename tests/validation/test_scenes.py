"""Scenes of contact that end as they should; `benchmarks/scenes.py` has all of them judged.

The bounds are of the penetration that runs tell of, within ten times of what is measured.
"""

import sys
from pathlib import Path

import numpy as np
import pytest

import carom

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import random_scenes
import stacks
import wild_scenes
from scene_list import SCENES

DEEPEST = {
    "stack in the plane": 4e-11,
    "inset stack": 3e-7,
    "pyramid of boxes": 6e-11,
    "box on its edge": 3e-13,
    "cube on its corner": 1e-12,
    "corner on corner": 5e-6,
    "spike and wedge": 2e-6,
    "wedge between two blocks": 3e-6,
    "needle on a coarse sheet": 6e-4,
    "plate over a post": 8e-14,
    "plate over a post in the plane": 8e-15,
    "plate across a beam": 2e-13,
    "plate over a pyramid": 1e-10,
    "block slides off a table": 1e-12,
    "house of cards": 1e-12,
    "square in a notch": 2e-7,
    "plate on small discs": 1e-9,
    "plate on small balls": 4e-9,
    "plate on thin bars": 7e-9,
    "bullet 10 rigid in the plane": 4e-13,
    "bullet 1000 rigid in the plane": 1e-13,
    "bullet 100 loose in the plane": 4e-7,
    "bullet 1000 rigid in space": 4e-13,
    "bullet 10 loose in space": 3e-5,
}


LONG = {"plate on thin bars"}
"""What takes as long as all others together."""


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.long] if name in LONG else []) for name in DEEPEST],
)
def test_nothing_is_in_anything(name, tmp_path):
    scenario = carom.Scenario.model_validate(SCENES[name](tmp_path))
    simulation = carom.Simulation(scenario)
    while simulation.time < scenario.analysis.end_time * (1 - 1e-9):
        simulation.step()
    history = simulation.history
    assert np.max(history["penetration"]) < DEEPEST[name]
    work = max(np.ptp(history["kinetic"]), np.ptp(history["total"]))
    assert np.max(np.abs(history["defect"])) < 1e-9 * work
    assert np.max(history["contacts"]) > 0


@pytest.mark.parametrize("setting", stacks.SETTINGS)
def test_a_stack_of_unequal_meshes_rests_in_space(setting):
    """Symptom guarded against: rims sank into the flat sides that they stood on, between nodes."""
    row = stacks.rest(3, 2, (3, 2), stacks.SETTINGS[setting], end=0.5)
    # Measured: 1.1e-11 with massless contact, whose gaps are as good as iterations leave them.
    assert row["depth"] < 5e-11
    # Measured: 3.7e-11 with gap.
    assert row["across"] < 1e-10


def test_a_box_with_mass_where_it_is_touched_rests_on_one_without():
    """Symptom guarded against: what the blend adds to reactions was not in W, and steps failed.

    Two cells across leave a box too few nodes inside to take the mass of those outside.
    """
    row = stacks.rest(2, 2, (3, 2), {}, end=0.9)
    assert row["why"] == ""
    # Measured: 8.3.
    assert row["its"] < 12.0
    # Measured: 3.7e-15.
    assert row["depth"] < 2e-14


def test_a_ring_that_is_thrown_at_a_wall_touches_itself(tmp_path):
    """Symptom guarded against: the inner circle went through itself, and nothing said so."""
    scenario = carom.Scenario.model_validate(SCENES["ring through itself"](tmp_path))
    summary = carom.run(scenario, out=tmp_path / "out").summary
    assert summary["status"] == "completed"
    assert ["body-0", "body-0"] in [pair["between"] for pair in summary["pairs"]]
    worst = summary["penetration"]["worst"]
    assert worst["depth"] < worst["allowed"]


@pytest.mark.parametrize("condition", ["midpoint", "gap"])
def test_a_round_indenter_of_the_radius_of_a_few_cells_completes(condition, tmp_path):
    """Symptom guarded against: between nodes that it touched it was in a facet, as it must be."""
    material = {"kind": "neo-hookean", "young": 1e6, "poisson": 0.3, "density": 1000.0}
    material["damping"] = {"mass": 5.0, "stiffness": 1e-3}
    mesh = {"kind": "rectangle", "corner": [0.0, 0.0], "size": [2.0, 1.0], "divisions": [5, 2]}
    ball = {"name": "ball", "kind": "sphere", "centre": [1.0, 2.02], "radius": 1.0}
    case = {
        "analysis": {"kind": "dynamic", "end_time": 0.2, "time_step": 2e-3},
        "materials": {"m": material},
        "bodies": [{"name": "block", "material": "m", "mesh": mesh}],
        "obstacles": [
            {"name": "floor", "kind": "plane", "point": [0.0, 0.0], "normal": [0.0, 1.0]},
            {**ball, "velocity": [0.0, -0.5]},
        ],
        "contact": {"friction": 0.3, "condition": condition},
    }
    summary = carom.run(carom.Scenario.model_validate(case), out=tmp_path / "out").summary
    assert summary["status"] == "completed"
    worst = summary["penetration"]["worst"]
    assert worst["allowed"] / 10 < worst["depth"] < worst["allowed"]


@pytest.mark.parametrize(("seed", "deepest"), [(18, 1e-7), (26, 5e-12)])
def test_corners_stay_outside_of_coarse_bodies_without_mass(seed, deepest):
    """Symptom guarded against: the finer side alone was checked, and corners sank in by 0.08 m."""
    scenario = random_scenes.scene(seed, "conserving", "massless")
    simulation = carom.Simulation(scenario)
    while simulation.time < scenario.analysis.end_time * (1 - 1e-9):
        simulation.step()
    assert np.max(simulation.history["penetration"]) < deepest


def test_a_step_that_is_repeated_with_more_contacts_goes_back_to_no_guess_of_fewer():
    """Symptom guarded against: a panic where contacts with the stiffness of their reactions failed.

    It crushes a body, and ends with a reason.
    """
    scenario = wild_scenes.scene(224)
    simulation = carom.Simulation(scenario)
    with pytest.raises(carom.ConvergenceError, match="Newton's iterations"):
        while simulation.time < scenario.analysis.end_time * (1 - 1e-9):
            simulation.step()
