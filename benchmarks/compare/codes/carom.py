"""carom through its Python package; the native time loop is timed, with nothing recorded."""

from __future__ import annotations

import math
import time
from pathlib import Path

import carom
from carom.building.build import build
from compare.abaqus import abaqus_mesh
from compare.energy import Sampler
from compare.outcome import Outcome
from compare.problems import Problem

NEWTON = 1e-9
"""Tolerance of Newton's iteration, that of ``make bench``."""

SCHEMES: dict[str, carom.Theta | carom.Conserving] = {
    "theta": carom.Theta(),
    "conserving": carom.Conserving(),
}


def run(problem: Problem, variant: str, friction: float) -> Outcome:
    """Run once with stops, to see what happens and to warm up, and once timed."""
    scenario = described(problem, variant, friction)
    sampler = Sampler(problem)
    simulation = build(scenario)
    for step in range(problem.sample_every, problem.steps + 1, problem.sample_every):
        simulation.advance(step * problem.time_step, math.inf)
        fields = simulation.fields()
        sampler.take(simulation.time, fields["displacement"], fields["velocity"])
    simulation = build(scenario)
    start = time.process_time()
    simulation.advance(math.inf, math.inf)
    seconds = time.process_time() - start
    return Outcome(
        version=carom.__version__,
        dofs=simulation.summary()["dofs"],
        steps=simulation.step,
        seconds=seconds,
        motion=sampler.motion,
    )


def described(problem: Problem, variant: str, friction: float) -> carom.Scenario:
    """Describe the problem to carom; the variant is the scheme and the contact condition.

    The meshes are written into the current directory.
    """
    scheme, condition = variant.split("/")
    bodies = []
    for body in problem.bodies:
        file = Path(f"{body.name}.inp").absolute()
        file.write_text(abaqus_mesh(body.mesh), encoding="utf-8")
        bodies.append(
            carom.Body(
                name=body.name,
                material="elastic",
                hypothesis="plane-strain",
                mesh=carom.MeshFile(file=str(file)),
                velocity=body.velocity,
            )
        )
    return carom.Scenario.from_dict(
        {
            "title": problem.title,
            "analysis": carom.Dynamic(
                end_time=problem.end_time,
                time_step=problem.time_step,
                scheme=SCHEMES[scheme],
                newton=carom.Newton(tolerance=NEWTON),
            ),
            "materials": {
                "elastic": carom.SaintVenantKirchhoff(
                    young=problem.young, poisson=problem.poisson, density=problem.density
                )
            },
            "bodies": bodies,
            "obstacles": _walls(problem),
            "contact": carom.Contact.model_validate(
                {"condition": condition, "targets": "faceted", "friction": friction}
            ),
        }
    )


def _walls(problem: Problem) -> list[carom.Plane]:
    """Return the walls of the box."""
    if problem.box is None:
        return []
    left, bottom, right, top = problem.box
    return [
        carom.Plane(name="floor", point=(left, bottom), normal=(0.0, 1.0)),
        carom.Plane(name="east", point=(right, bottom), normal=(-1.0, 0.0)),
        carom.Plane(name="ceiling", point=(left, top), normal=(0.0, -1.0)),
        carom.Plane(name="west", point=(left, bottom), normal=(1.0, 0.0)),
    ]
