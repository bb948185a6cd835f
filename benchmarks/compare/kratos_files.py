"""The input of Kratos: mesh, material and parameters.

A surface may have one role, source or target, in all pairs: the left body is the source, the right
one and the walls are targets. Conditions take their material from a parent element, and the search
does not find a wall that is one long segment, so walls are strips of fixed cells.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from compare.meshes import Indices, Points
from compare.problems import Problem

TOLERANCE = 1e-7
"""Of the residual and of the displacements; tighter ones are not reached in every step."""

ITERATIONS = 20
"""Of Newton's method in a step, after which Kratos goes on to the next."""

BOSSAK = -0.3
"""Numerical damping of Bossak's scheme; Kratos' own value."""

CELL = 0.2
"""Size of the cells of the walls [m]."""


@dataclass(frozen=True)
class Everything:
    """Bodies and walls as one mesh, the bodies first.

    Parameters
    ----------
    points, cells
        Of bodies and walls.
    surfaces
        Facets that may touch, by name.
    bodies
        How many of the points belong to bodies.
    """

    points: Points
    cells: Indices
    surfaces: dict[str, Indices]
    bodies: int


def everything(problem: Problem) -> Everything:
    """Return the bodies of a problem with strips of cells for its walls."""
    points, cells = [problem.points], [problem.cells]
    surfaces = dict(zip(("Left", "Right"), problem.surfaces, strict=True))
    count = bodies = len(problem.points)
    walls = []
    for start, end in _walls(problem):
        along = end - start
        number = round(float(np.hypot(*along)) / CELL)
        outwards = np.array([along[1], -along[0]]) / np.hypot(*along) * CELL
        inner = start + along * np.linspace(0.0, 1.0, number + 1)[:, None]
        points += [inner, inner + outwards]
        inside = count + np.arange(number)
        outside = inside + number + 1
        cells.append(np.column_stack([outside, outside + 1, inside + 1, inside]))
        walls.append(np.column_stack([inside + 1, inside]))
        count += 2 * (number + 1)
    if walls:
        surfaces["Walls"] = np.vstack(walls)
    return Everything(np.vstack(points), np.vstack(cells), surfaces, bodies)


def _walls(problem: Problem) -> Iterator[tuple[Points, Points]]:
    """Yield start and end of each wall, counter-clockwise around the box."""
    if problem.box is not None:
        left, bottom, right, top = problem.box
        corners = np.array([(left, bottom), (right, bottom), (right, top), (left, top)])
        yield from zip(corners, np.roll(corners, -1, axis=0), strict=True)


def model(mesh: Everything) -> str:
    """Return the file of the mesh."""
    return "\n".join(_model(mesh)) + "\n"


def _model(mesh: Everything) -> Iterator[str]:
    yield from ("Begin ModelPartData", "End ModelPartData")
    for properties in (0, 1):
        yield from (f"Begin Properties {properties}", "End Properties")
    yield "Begin Nodes"
    for number, (x, y) in enumerate(mesh.points.tolist(), 1):
        yield f"{number} {x!r} {y!r} 0"
    yield from ("End Nodes", "Begin Elements TotalLagrangianElement2D4N")
    for number, cell in enumerate((mesh.cells + 1).tolist(), 1):
        yield f"{number} 1 {' '.join(map(str, cell))}"
    yield from ("End Elements", "Begin Conditions LineCondition2D2N")
    facets = np.vstack(list(mesh.surfaces.values())) + 1
    for number, (start, end) in enumerate(facets.tolist(), 1):
        yield f"{number} 0 {start} {end}"
    yield "End Conditions"
    count = len(mesh.points)
    yield from _part("Body", range(1, count + 1), range(1, len(mesh.cells) + 1), ())
    first = 1
    for name, surface in mesh.surfaces.items():
        conditions = range(first, first + len(surface))
        yield from _part(name, np.unique(surface + 1).tolist(), (), conditions)
        first += len(surface)
    if count > mesh.bodies:
        yield from _part("Fixed", range(mesh.bodies + 1, count + 1), (), ())


def _part(
    name: str, nodes: Iterable[int], elements: Iterable[int], conditions: Iterable[int]
) -> Iterator[str]:
    """Yield a named part of the mesh."""
    yield f"Begin SubModelPart {name}"
    for kind, members in (("Nodes", nodes), ("Elements", elements), ("Conditions", conditions)):
        yield f"Begin SubModelPart{kind}"
        yield from map(str, members)
        yield f"End SubModelPart{kind}"
    yield "End SubModelPart"


def material(problem: Problem) -> dict[str, Any]:
    """Return the file of materials: with total Lagrangian elements, Saint-Venant–Kirchhoff."""
    law = {
        "constitutive_law": {"name": "LinearElasticPlaneStrain2DLaw"},
        "Variables": {
            "DENSITY": problem.density,
            "YOUNG_MODULUS": problem.young,
            "POISSON_RATIO": problem.poisson,
            "THICKNESS": 1.0,
        },
    }
    part = {"model_part_name": "Structure.Body", "properties_id": 1, "Material": law}
    return {"properties": [part]}


def parameters(problem: Problem, mesh: Everything, friction: float) -> dict[str, Any]:
    """Return the project: augmented Lagrangian mortar contact, Bossak's scheme."""
    law = "Frictional" if friction else "Frictionless"
    contact = {
        "python_module": "alm_contact_process",
        "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication",
        "Parameters": {
            "model_part_name": "Structure",
            "contact_model_part": {"0": list(mesh.surfaces)},
            "assume_master_slave": {"0": ["Left"]},
            "contact_type": law,
            "friction_coefficients": {"0": friction},
        },
    }
    held = {
        "python_module": "assign_vector_variable_process",
        "kratos_module": "KratosMultiphysics",
        "Parameters": {
            "model_part_name": "Structure.Fixed",
            "variable_name": "DISPLACEMENT",
            "value": [0, 0, 0],
            "constrained": [True, True, True],
        },
    }
    return {
        "problem_data": {
            "problem_name": "model",
            "parallel_type": "OpenMP",
            "echo_level": 0,
            "start_time": 0.0,
            "end_time": problem.end_time - problem.time_step / 2,
        },
        "solver_settings": _solver(problem, f"ALMContact{law}"),
        "processes": {
            "fixed": [held] if len(mesh.points) > mesh.bodies else [],
            "contact": [contact],
        },
    }


def _solver(problem: Problem, contact: str) -> dict[str, Any]:
    """Return the settings of scheme, contact and solvers."""
    return {
        "solver_type": "Dynamic",
        "time_integration_method": "implicit",
        "scheme_type": "bossak",
        "damp_factor_m": BOSSAK,
        "model_part_name": "Structure",
        "domain_size": 2,
        "echo_level": 0,
        "model_import_settings": {"input_type": "mdpa", "input_filename": "model"},
        "material_import_settings": {"materials_filename": "materials.json"},
        "time_stepping": {"time_step": problem.time_step},
        "analysis_type": "non_linear",
        "clear_storage": False,
        "reform_dofs_at_each_step": True,
        "max_iteration": ITERATIONS,
        "convergence_criterion": "contact_residual_criterion",
        "residual_relative_tolerance": TOLERANCE,
        "residual_absolute_tolerance": 1e-9,
        "displacement_relative_tolerance": TOLERANCE,
        "displacement_absolute_tolerance": 1e-11,
        "compute_reactions": False,
        "volumetric_strain_dofs": False,
        "rotation_dofs": False,
        "contact_settings": {
            "mortar_type": contact,
            "fancy_convergence_criterion": False,
            "contact_displacement_relative_tolerance": TOLERANCE,
            "contact_residual_relative_tolerance": TOLERANCE,
        },
        "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"},
    }
