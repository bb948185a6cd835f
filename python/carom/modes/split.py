"""The energy of the bodies of a run, frame by frame, by their modes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from carom import _carom
from carom.building.build import build
from carom.case.body import ReducedBody
from carom.case.scenario import Scenario
from carom.case.vibrating import without_modes
from carom.errors import InputError
from carom.messages import known
from carom.modes.basis import Modes, modes
from carom.modes.energies import Array, ModalEnergies
from carom.results.fields import Fields
from carom.results.result import Result


def modal_energies(
    results: Result | str | Path,
    *,
    count: int = 20,
    bodies: Sequence[str] | None = None,
) -> dict[str, ModalEnergies]:
    """Split the energy of bodies in the recorded frames of a run over their modes.

    A free body is seen in the frame of its mean axes, in which what it does has no part that turns
    as a whole; one that something holds is seen as it is. Modes are those of where it is drawn; of
    a reduced body they are the vibrations that it steps by.

    Parameters
    ----------
    results
        A run, or its directory.
    count
        Modes of each body.
    bodies
        Names of the bodies; None for all that deform and are elastic.

    Raises
    ------
    InputError
        There is no such body, or one that has no modes or more than these; no body has modes.
    """
    result = results if isinstance(results, Result) else Result.open(results)
    if count < 1:
        raise InputError(f"{count} modes: ask for 1 at least")
    scenario = result.scenario
    if scenario.stages:
        raise InputError("modes are of a case of one analysis: stages may change what holds a body")
    names = [body.name for body in scenario.bodies]
    for name in bodies or ():
        if name not in names:
            raise InputError(f"{name}: no such body; {known(name, names)}")
        if reason := without_modes(scenario.bodies[names.index(name)], scenario.materials):
            raise InputError(
                f"body {name} has no modes that its energy could be split over: {reason}"
            )
    if bodies is None and all(without_modes(one, scenario.materials) for one in scenario.bodies):
        raise InputError(
            "no body has modes: none deforms and is elastic, without a stress at first"
        )
    return split(result.fields, scenario, build(scenario), count, bodies=bodies)


def split(
    fields: Fields,
    scenario: Scenario,
    simulation: _carom.Simulation,
    count: int,
    *,
    bodies: Sequence[str] | None = None,
) -> dict[str, ModalEnergies]:
    """Split the energy of bodies that have modes, see `modal_energies`.

    Parameters
    ----------
    fields
        Of the run, frame by frame.
    scenario, simulation
        Its case, and what was built of it; at whatever time it is.
    count
        Modes of each body.
    bodies
        Names of the bodies; None for all that have modes.
    """
    return {
        body.name: _reduced(fields, simulation, index, count)
        if isinstance(body, ReducedBody)
        else _split(fields, simulation, index, count)
        for index, body in enumerate(scenario.bodies)
        if not without_modes(body, scenario.materials) and (bodies is None or body.name in bodies)
    }


def _split(whole: Fields, simulation: _carom.Simulation, index: int, count: int) -> ModalEnergies:
    built = simulation.describe()["bodies"][index]
    matrices = simulation.matrices(index)
    own = modes(matrices, count, slow=built["wave_speed"] / built["diameter"])
    fields = whole.body(built["name"])
    is_held = bool(matrices["held"].any())
    displacements, velocities = fields["displacement"], fields["velocity"]
    rows = []
    for frame in range(len(fields.times)):
        u, v = displacements[frame], velocities[frame]
        kinetic = 0.5 * float((v * (own.mass @ v)).sum())
        bent, shaken, rigid = (u, v, 0.0) if is_held else _in_mean_axes(own, fields.points, u, v)
        rates = own.amplitudes(shaken)
        moving = 0.5 * rates**2
        still = 0.5 * (own.frequencies * own.amplitudes(bent)) ** 2
        if is_held:
            rigid = float(moving[: own.rigid].sum())
        moving, still = moving[own.rigid :], still[own.rigid :]
        strain = simulation.strain_energy(index, np.ascontiguousarray(u))
        rows.append((rigid, moving, still, kinetic - rigid - moving.sum(), strain - still.sum()))
    columns = [np.array(column) for column in zip(*rows, strict=True)]
    hertz = own.frequencies[own.rigid :] / (2.0 * np.pi)
    return ModalEnergies(built["name"], fields.times, hertz, *columns)


def _reduced(whole: Fields, simulation: _carom.Simulation, index: int, count: int) -> ModalEnergies:
    """Split the energy of a reduced body over its vibrations, which the core reads as steps do."""
    name = simulation.describe()["bodies"][index]["name"]
    fields = whole.body(name)
    rows, frequencies = [], np.zeros(0)
    for u, v in zip(fields["displacement"], fields["velocity"], strict=True):
        own = simulation.vibrations(index, np.ascontiguousarray(u), np.ascontiguousarray(v)) or {}
        frequencies, kinetic, strain = own["frequencies"], own["kinetic"], own["strain"]
        rests = kinetic[count:].sum(), strain[count:].sum()
        rows.append((own["rigid"], kinetic[:count], strain[:count], *rests))
    columns = [np.array(column) for column in zip(*rows, strict=True)]
    return ModalEnergies(name, fields.times, frequencies[:count] / (2.0 * np.pi), *columns)


def _in_mean_axes(own: Modes, points: Array, u: Array, v: Array) -> tuple[Array, Array, float]:
    """Return what a free body does in the frame that moves with it, and the energy of the frame.

    The rotation R of the frame is the one that brings positions nearest, in the mean by mass, to
    those that are drawn, so that Σ M (X − C) × d = 0; its velocities are those of a rigid body with
    the same momenta, so that what is left is at right angles to them.

    Returns
    -------
    tuple
        d = Rᵀ(x − c) − (X − C) [m] and Rᵀ(v − v̄ − ω × (x − c)) [m/s], shape [node_count, D], and
        the kinetic energy of translation and rotation [J].
    """
    weights = own.mass.sum(axis=0)
    total = float(weights.sum())
    drawn = points - weights @ points / total
    arms = points + u
    arms = arms - weights @ arms / total
    mean = weights @ v / total
    left, _, right = np.linalg.svd(arms.T @ (own.mass @ drawn))
    left[:, -1] *= np.linalg.det(left @ right)
    rotation = left @ right
    moved = arms.T @ (own.mass @ (v - mean))
    spread = arms.T @ (own.mass @ arms)
    moment = np.array([moved[j, k] - moved[k, j] for j, k in _planes(len(moved))])
    inertia = _inertia(spread)
    spin = np.linalg.solve(inertia, moment)
    turning = np.zeros_like(moved)
    for rate, (j, k) in zip(spin, _planes(len(moved)), strict=True):
        turning[k, j], turning[j, k] = rate, -rate
    shaken = v - mean - arms @ turning.T
    energy = 0.5 * total * float(mean @ mean) + 0.5 * float(moment @ spin)
    return arms @ rotation - drawn, shaken @ rotation, energy


def _planes(dimension: int) -> Iterator[tuple[int, int]]:
    """Yield the two axes of every plane in which a body turns: about z, or about x, y and z."""
    yield from ((0, 1),) if dimension == 2 else ((1, 2), (2, 0), (0, 1))


def _inertia(spread: Array) -> Array:
    """Return the inertia about the centre [kg m²] of Σ m y yᵀ."""
    inertia: Array = np.trace(spread) * np.eye(len(spread)) - spread
    return inertia if len(spread) == 3 else np.array([[np.trace(spread)]])
