"""Kratos Multiphysics: mortar contact by an augmented Lagrangian; the loop over steps is timed."""

from __future__ import annotations

import json
import time
from pathlib import Path

import KratosMultiphysics as Kratos
import numpy as np
from KratosMultiphysics.StructuralMechanicsApplication.structural_mechanics_analysis import (
    StructuralMechanicsAnalysis,
)

from compare.energy import Sampler
from compare.kratos_files import ITERATIONS, everything, material, model, parameters
from compare.meshes import Points
from compare.outcome import Outcome
from compare.problems import Problem


class Analysis(StructuralMechanicsAnalysis):  # type: ignore[misc]
    """The analysis of Kratos, looked at between steps, with a clock.

    Parameters
    ----------
    project
        Parameters of the project.
    problem
        What is run.
    """

    def __init__(self, project: Kratos.Parameters, problem: Problem) -> None:
        super().__init__(Kratos.Model(), project)
        self._problem = problem
        self.sampler = Sampler(problem)
        self.steps = 0
        self.exhausted = 0
        self.seconds = 0.0
        """CPU time of the loop, without that of our own looks [s]."""

    def Initialize(self) -> None:  # noqa: N802 (the name is Kratos')
        """Set the velocities at the start."""
        super().Initialize()
        nodes = self.model["Structure"].Nodes
        velocities = self._problem.velocities.tolist()
        self._nodes = [nodes[number] for number in range(1, len(velocities) + 1)]
        for node, (x, y) in zip(self._nodes, velocities, strict=True):
            node.SetSolutionStepValue(Kratos.VELOCITY, Kratos.Array3([x, y, 0.0]))

    def RunSolutionLoop(self) -> None:  # noqa: N802
        """Time the loop."""
        start = time.process_time()
        super().RunSolutionLoop()
        self.seconds += time.process_time() - start

    def FinalizeSolutionStep(self) -> None:  # noqa: N802
        """Count the step and look at the motion."""
        super().FinalizeSolutionStep()
        start = time.process_time()
        self.steps += 1
        iterations = self.model["Structure"].ProcessInfo[Kratos.NL_ITERATION_NUMBER]
        self.exhausted += iterations >= ITERATIONS
        if self.steps % self._problem.sample_every == 0:
            self.sampler.take(
                self.steps * self._problem.time_step,
                self._values(Kratos.DISPLACEMENT),
                self._values(Kratos.VELOCITY),
            )
        self.seconds -= time.process_time() - start

    def OutputSolutionStep(self) -> None:  # noqa: N802
        """Write nothing."""

    def _values(self, variable: Kratos.Array1DVariable3) -> Points:
        """Return a variable of the nodes of the bodies, shape [node_count, 2]."""
        return np.array([list(node.GetSolutionStepValue(variable))[:2] for node in self._nodes])


def run(problem: Problem, _variant: str, friction: float) -> Outcome:
    """Run in the current directory."""
    Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
    mesh = everything(problem)
    Path("model.mdpa").write_text(model(mesh), encoding="ascii")
    Path("materials.json").write_text(json.dumps(material(problem)), encoding="ascii")
    project = Kratos.Parameters(json.dumps(parameters(problem, mesh, friction)))
    analysis = Analysis(project, problem)
    analysis.Run()
    return Outcome(
        version=Kratos.KratosGlobals.Kernel.Version().split("-")[0].replace('"', ""),
        dofs=2 * len(problem.points),
        steps=analysis.steps,
        seconds=analysis.seconds,
        motion=analysis.sampler.motion,
        exhausted=analysis.exhausted,
    )
