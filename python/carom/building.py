"""From a scenario to the native simulation."""

from __future__ import annotations

import json

from carom._carom import Simulation
from carom.leaps import refuse_leaps
from carom.mesh import MeshFile
from carom.mesh_file import MeshArrays, read_body_mesh, read_surface
from carom.obstacle import RigidSurface
from carom.scenario import Scenario


def build(scenario: Scenario) -> Simulation:
    """Build meshes, matrices and the initial state.

    Raises
    ------
    InputError
        The scenario cannot be run, such as bodies that overlap at the start.
    """
    simulation = Simulation(_json(scenario), _meshes(scenario))
    refuse_leaps(scenario, simulation.describe())
    return simulation


def _json(scenario: Scenario) -> str:
    """Return the scenario as the native core reads it, the triangles of obstacles included."""
    data = json.loads(scenario.to_json())
    for index, obstacle in enumerate(scenario.obstacles):
        if isinstance(obstacle, RigidSurface):
            key = f"obstacles.{index}"
            surface = read_surface(obstacle.file, scale=obstacle.scale, key=key)
            data["obstacles"][index]["vertices"] = surface.points.tolist()
            data["obstacles"][index]["triangles"] = surface.triangles.tolist()
    return json.dumps(data)


def _meshes(scenario: Scenario) -> dict[str, MeshArrays]:
    """Read the meshes of the bodies that have theirs in a file."""
    return {
        body.name: read_body_mesh(
            body.mesh.file,
            body=body.mesh.body,
            scale=body.mesh.scale,
            space=scenario.dimension,
            key=f"bodies.{index}.mesh",
        )
        for index, body in enumerate(scenario.bodies)
        if isinstance(body.mesh, MeshFile)
    }
