"""The state that a case starts from: displacements of bodies, or the end of another run."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom._carom import Simulation
from carom.building.identity import difference, identity, what_lasts
from carom.case.initial import Initial, InitialDisplacement
from carom.case.scenario import Scenario
from carom.errors import InputError
from carom.io import layout
from carom.io.checkpoint import DamagedError, read_checkpoint
from carom.io.summary import read_summary
from carom.results.result import Result

ROUND_OFF = 1e-9
"""Relative difference of times that are the same."""


def start(simulation: Simulation, scenario: Scenario, initial: Initial) -> None:
    """Give a simulation the state that its case starts from.

    Raises
    ------
    InputError
        The state is not there, or not one of these bodies.
    """
    if initial.result is not None:
        _go_on(simulation, scenario, Path(initial.result), initial.start_time)
        return
    bodies = simulation.describe()["bodies"]
    starts = np.cumsum([0, *(body["nodes"] for body in bodies)])
    whole = np.zeros((int(starts[-1]), scenario.dimension))
    names = [body.name for body in scenario.bodies]
    points = simulation.mesh()["points"]
    for index, entry in enumerate(initial.displacements):
        body = names.index(entry.body)
        nodes = slice(int(starts[body]), int(starts[body + 1]))
        key = f"initial.displacements.{index}"
        whole[nodes] = _displacement(entry, points[nodes], key)
    simulation.set_initial_displacement(whole)


def _go_on(simulation: Simulation, scenario: Scenario, directory: Path, time: float) -> None:
    """Let a simulation go on from the end of a run."""
    key = "initial.result"
    file = directory / layout.END_STATE
    try:
        end = read_checkpoint(file)
    except FileNotFoundError:
        raise InputError(f"{key}: {directory}: {_why_none(directory)}", key) from None
    except (DamagedError, InputError) as error:
        raise InputError(f"{key}: {error}; run that case again", key) from error
    except OSError as error:
        raise InputError(f"{key}: {file}: {error.strerror}", key) from error
    here, there = what_lasts(identity(scenario, simulation)), what_lasts(end.case)
    if (found := difference(here, there)) is not None:
        what = found[1]
        raise InputError(
            f"{key}: {directory} is a run of others: {what}; a case goes on with the same meshes, "
            "materials, obstacles and pairs",
            key,
        )
    if abs(end.time - time) > ROUND_OFF * time:
        raise InputError(
            f"initial.time = {time:.12g}: {directory} ended at t = {end.time:.12g} s; "
            f"give time = {end.time:.12g}",
            "initial.time",
        )
    try:
        simulation.start_from(end.arrays)
    except ValueError as error:
        raise InputError(f"{key}: {file} does not fit: {error}; run that case again", key) from None


def _why_none(directory: Path) -> str:
    """Return why there is no state at the end of a run."""
    if not directory.is_dir():
        return "there is no such directory; name the results of a run that completed"
    try:
        status = read_summary(directory / layout.SUMMARY)["status"]
    except (OSError, InputError):
        return "has no results of a run that ended; name one that completed"
    if status != "completed":
        return f"that run ended as {status}; name one that completed"
    return f"has no {layout.END_STATE}, which this version leaves; run that case again"


def _displacement(
    entry: InitialDisplacement, points: NDArray[np.float64], key: str
) -> NDArray[np.float64]:
    """Return the displacements of the nodes of a body, of which the reference positions are known.

    Raises
    ------
    InputError
        They are not there, or not of these nodes.
    """
    if entry.file is None:
        return _last_of(Path(str(entry.result)), entry.body, points, f"{key}.result")
    place = f"{key}.file"
    found = _numbers(Path(entry.file), place)
    if found.shape != points.shape:
        raise InputError(
            f"{place}: {entry.file} has the shape {found.shape}, the nodes of {entry.body} "
            f"{points.shape}; give a displacement of each node",
            place,
        )
    if not np.isfinite(found).all():
        raise InputError(f"{place}: displacements must be finite numbers, in metres", place)
    return found


def _numbers(file: Path, key: str) -> NDArray[np.float64]:
    """Read an array of numbers."""
    try:
        content = np.load(io.BytesIO(file.read_bytes()), allow_pickle=False)
        return np.asarray(content, dtype=np.float64)
    except OSError as error:
        raise InputError(f"{key}: {file}: {error.strerror}", key) from error
    except (TypeError, ValueError, EOFError) as error:
        raise InputError(f"{key}: {file}: not an array of NumPy (.npy): {error}", key) from error


def _last_of(
    directory: Path, body: str, points: NDArray[np.float64], key: str
) -> NDArray[np.float64]:
    """Return the last displacements of a body of a run, whose nodes must be at these points."""
    try:
        result = Result.open(directory)
        there = result.fields.body(body)
        found = np.asarray(there["displacement"][-1], dtype=np.float64)
    except InputError as error:
        raise InputError(f"{key}: {directory}: {error}", key) from error
    if there.points.shape != points.shape or np.any(there.points != points):
        raise InputError(
            f"{key}: the mesh of {body} in {directory} has {len(there.points)} nodes, here it has "
            f"{len(points)}, or they are elsewhere; give a result of the same mesh",
            key,
        )
    return found
