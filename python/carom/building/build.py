"""From a scenario to the native simulation."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from carom._carom import Simulation
from carom.building.closing import closed
from carom.building.leaps import refuse_leaps
from carom.building.magnitudes import refuse_unbounded
from carom.case.foreign_body import ForeignEntry
from carom.case.mesh import MeshFile
from carom.case.obstacle import Obstacle, RigidSurface
from carom.case.scenario import Scenario
from carom.errors import InputError
from carom.mesh_file import MeshArrays, Note, SurfaceArrays, read_body_mesh, read_surface
from carom.results.doubts import of_mesh, warn

if TYPE_CHECKING:
    from carom.ranks import Engine


def build(
    scenario: Scenario, notes: list[Note] | None = None, *, engine: Engine | None = None
) -> Simulation:
    """Build meshes, matrices and the initial state.

    Parameters
    ----------
    scenario
        What to build.
    notes
        A list that gets what was done to meshes out of files, such as cells that were turned. None
        warns of it.
    engine
        The ranks that share the bodies; None leaves them all to this process.

    Raises
    ------
    InputError
        The scenario cannot be run, such as bodies that overlap at the start.
    """
    if not isinstance(scenario, Scenario):
        raise InputError(
            f"{scenario!r:.40}: is no Scenario; carom.Scenario.from_toml reads a case file, "
            "from_dict a dictionary"
        )
    if engine is not None and scenario.output.modes is not None:
        raise InputError(
            f"output.modes = {scenario.output.modes}: ranks have no modes of the bodies that they "
            "share; leave it out, or run without --engine"
        )
    foreign = _foreign(scenario)
    meshes = _meshes(scenario) | {name: code.mesh() for name, code in foreign.items()}
    surfaces = obstacle_surfaces(scenario.obstacles)

    def make(scenario: Scenario, meshes: Mapping[str, MeshArrays]) -> Simulation:
        try:
            return Simulation(_json(scenario), dict(meshes), surfaces, foreign, engine)
        except InputError as error:
            raise _at_its_place(error, scenario) from None

    found = [note for arrays in meshes.values() for note in arrays.notes]
    try:
        simulation = make(scenario, meshes)
    except InputError as refusal:
        try:
            meshes, moves = closed(scenario, meshes, make)
            if not moves:
                raise refusal from None
            simulation = make(scenario, meshes)
        except InputError:  # what has been wrong before is told, not what is left of it
            raise refusal from None
        found += moves
    if scenario.initial is not None:
        from carom.building.initial import start  # noqa: PLC0415 (reads results, for few cases)

        start(simulation, scenario, scenario.initial)
    description = simulation.describe()
    refuse_unbounded(scenario, description)
    refuse_leaps(scenario, description)
    if notes is None:
        for note in found:
            warn(of_mesh(note))
    else:
        notes += found
    return simulation


def _at_its_place(error: InputError, scenario: Scenario) -> InputError:
    """Return a refusal with the key under which the case gives what the core refuses in a stage."""
    for index, stage in enumerate(scenario.full_stages() if scenario.stages else ()):
        for name, given in (("loads", stage.loads), ("motions", stage.motions)):
            for number, one in enumerate(given):
                path = f"stages.{index}.{name}.{number}."
                if error.key is not None and error.key.startswith(path):
                    key = f"{one.key}.{error.key.removeprefix(path)}"
                    return type(error)(str(error).replace(error.key, key, 1), key)
        path = f"stages.{index}.contact."
        if error.key is not None and error.key.startswith(path):
            # What a stage says of contact is checked before; the rest holds in all stages.
            key = error.key.removeprefix(f"stages.{index}.")
            return type(error)(str(error).replace(error.key, key, 1), key)
    return error


def _json(scenario: Scenario) -> str:
    """Return the scenario as the native core reads it, but for what goes to it as arrays."""
    data = json.loads(scenario.to_json())
    for index, obstacle in enumerate(scenario.obstacles):
        if isinstance(obstacle, RigidSurface):
            data["obstacles"][index] |= {"vertices": [], "triangles": []}
    return json.dumps(data)


def _meshes(scenario: Scenario) -> dict[str, MeshArrays]:
    """Read the meshes of the bodies that have theirs in a file, each file once."""
    read: dict[tuple[str, str | None, float], MeshArrays] = {}
    meshes = {}
    for index, body in enumerate(scenario.bodies):
        if not isinstance(body.mesh, MeshFile):
            continue
        mesh = body.mesh
        known = (mesh.file, mesh.body, mesh.scale)
        is_first = known not in read
        if is_first:
            read[known] = read_body_mesh(
                mesh.file,
                body=mesh.body,
                scale=mesh.scale,
                space=scenario.dimension,
                key=f"bodies.{index}.mesh",
            )
        arrays = read[known]
        if mesh.move is not None:
            arrays = replace(arrays, points=arrays.points + np.array(mesh.move))
        # What is said of a file is said once.
        meshes[body.name] = arrays if is_first else replace(arrays, notes=[])
    return meshes


def _foreign(scenario: Scenario) -> dict[str, Any]:
    """Return the bodies of other codes, each of which has answered once, by their names."""
    foreign = {}
    for index, body in enumerate(scenario.bodies):
        if not isinstance(body, ForeignEntry) or body.code is None:
            continue
        code, key = body.code, f"bodies.{index}"
        space = code.points.shape[1]
        if space != scenario.dimension:
            raise InputError(
                f"{key}: {body.name!r} is a body in {space}D; set dimension = {space} at the top",
                key,
            )
        code.stiffness_at(np.zeros_like(code.points))
        foreign[body.name] = code
    return foreign


def obstacle_surfaces(obstacles: Sequence[Obstacle]) -> dict[str, SurfaceArrays]:
    """Read the surfaces of the obstacles that have theirs in a file."""
    return {
        obstacle.name: read_surface(obstacle.file, scale=obstacle.scale, key=f"obstacles.{index}")
        for index, obstacle in enumerate(obstacles)
        if isinstance(obstacle, RigidSurface)
    }
