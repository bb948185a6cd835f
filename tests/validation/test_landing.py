"""What nodes get back on landing with the condition `midpoint` stays within Coulomb's law."""

import sys
from pathlib import Path

import numpy as np

import carom

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import random_scenes

FRICTION = 0.3


def test_impulses_of_landing_leave_reactions_in_their_cones():
    """Symptom guarded against: 0.24 N of 3 N were taken back of what pressed, its friction stayed.

    Such steps are rare: two of the many hundred of this scene.
    """
    scenario = random_scenes.scene(2, "conserving", "midpoint")
    contact = scenario.contact.model_copy(update={"friction": FRICTION})
    simulation = carom.Simulation(scenario.model_copy(update={"contact": contact}))
    largest, excess = 0.0, 0.0
    while not simulation.has_ended:
        simulation.step()
        pressing = simulation.contacts
        along = np.einsum("ij,ij->i", pressing.reaction, pressing.normal)
        across = np.linalg.norm(pressing.reaction - along[:, None] * pressing.normal, axis=1)
        largest = max(largest, along.max(initial=0.0))
        excess = max(excess, (across - FRICTION * along).max(initial=0.0))
    # Measured: 1.6e-17, where it was 6e-4 before.
    assert excess < 1e-15 * largest
