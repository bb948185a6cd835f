"""A rubber O-ring, squeezed between plates and then pressed on the wall of a groove by a fluid."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from math import pi
from pathlib import Path
from time import process_time

import numpy as np
from runs import Array

import carom

MIDDLE, RADIUS = 0.02, 0.0025  # m
SQUEEZE = 0.3  # of the diameter
WALL = 0.0232  # m, radius of the groove
FLUID = 1e6  # Pa
STEPS = 20
WETTED = pi / 4.0  # angle from the level line up to which the fluid is at the ring


@dataclass(frozen=True)
class Sealed:
    """What a ring does when it is squeezed, and with the fluid at its inside.

    Parameters
    ----------
    squeezed, pressed
        Force of the upper plate before and with the pressure of the fluid [N].
    wall
        Force of the wall on the ring, as a whole [N].
    seal
        Mean pressure of the upper plate [Pa], over the width of the nodes that press.
    defect
        What the books do not explain, relative to the stored energy.
    iterations
        Newton iterations per load step.
    time
        Processor time [s].
    """

    squeezed: float
    pressed: float
    wall: float
    seal: float
    defect: float
    iterations: float
    time: float


def seal(divisions: int = 8, friction: float = 0.3) -> Sealed:
    """Squeeze the ring in 1 s and let the fluid press in another."""
    begun = process_time()
    with tempfile.TemporaryDirectory() as folder:
        file = _disc(Path(folder) / "ring.inp", divisions)
        scenario = carom.Scenario(
            analysis=carom.Static(end_time=2.0, time_step=1.0 / STEPS),
            materials={
                "rubber": carom.MooneyRivlin(c10=0.4e6, c01=0.1e6, bulk=2e8, density=1100.0)
            },
            bodies=[
                carom.Body(
                    name="ring",
                    material="rubber",
                    formulation="mean-dilatation",
                    hypothesis="axisymmetric",
                    mesh=carom.MeshFile(file=str(file)),
                )
            ],
            loads=[
                carom.Pressure(
                    body="ring", on="wetted", pressure=f"{FLUID}*max(t - 1, 0)", follower=True
                )
            ],
            obstacles=[
                carom.Plane(name="below", point=(0.0, 0.0), normal=(0.0, 1.0)),
                carom.Plane(
                    name="above",
                    point=(0.0, 2.0 * RADIUS),
                    normal=(0.0, -1.0),
                    motion=carom.Displacement(y=f"{-2.0 * RADIUS * SQUEEZE}*min(t, 1)"),
                ),
                carom.Plane(name="wall", point=(WALL, 0.0), normal=(-1.0, 0.0)),
            ],
            contact=carom.Contact(friction=friction),
        )
        simulation = carom.Simulation(scenario)
        iterations = []
        squeezed = 0.0
        while not simulation.has_ended:
            iterations.append(simulation.step().iterations)
            if len(iterations) == STEPS:
                squeezed = -simulation.contacts.force("ring", by="above")[1]
        return _sealed(simulation, squeezed, iterations, process_time() - begun)


def _sealed(
    simulation: carom.Simulation, squeezed: float, iterations: list[int], time: float
) -> Sealed:
    contacts = simulation.contacts
    pressed = -contacts.force("ring", by="above")[1]
    at_plate = [
        node
        for node, target, reaction in zip(
            contacts.node, contacts.target, contacts.reaction, strict=True
        )
        if target == "above" and reaction[1] < 0.0
    ]
    radii = np.asarray(simulation.bodies["ring"].positions)[at_plate, 0]
    history = simulation.history
    return Sealed(
        squeezed=float(squeezed),
        pressed=float(pressed),
        wall=float(-contacts.force("ring", by="wall")[0]),
        seal=float(pressed / (pi * (radii.max() ** 2 - radii.min() ** 2))),
        defect=float(np.abs(history["defect"]).max() / history["strain"][-1]),
        iterations=float(np.mean(iterations)),
        time=time,
    )


def _disc(file: Path, divisions: int) -> Path:
    """Write the section: a square of cells within rings; the set wetted is on the left."""
    n, rings = divisions, max(divisions // 2, 1)
    core = 0.5 * np.linspace(-1.0, 1.0, n + 1)
    grid = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    points = [np.stack(np.meshgrid(core, core), axis=-1).reshape(-1, 2)]
    # The rim of the square, counter-clockwise, and the points of the circle that face it.
    rim = np.concatenate([grid[0, :-1], grid[:-1, -1], grid[-1, :0:-1], grid[:0:-1, 0]])
    angle = -0.75 * pi + 2.0 * pi * np.arange(4 * n) / (4 * n)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    cells = [_quads(grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1])]
    last = rim
    for k in range(1, rings + 1):
        ring = (n + 1) ** 2 + (k - 1) * 4 * n + np.arange(4 * n)
        points.append(points[0][rim] + (circle - points[0][rim]) * k / rings)
        cells.append(_quads(last, ring, np.roll(ring, -1), np.roll(last, -1)))
        last = ring
    x = np.concatenate(points) * RADIUS + [MIDDLE, RADIUS]
    elements = np.concatenate(cells) + 1
    lines = ["*NODE", *(f"{n}, {p[0]!r}, {p[1]!r}" for n, p in enumerate(x.tolist(), 1))]
    lines += ["*ELEMENT, TYPE=CAX4, ELSET=ring"]
    lines += [f"{e}, {', '.join(map(str, c))}" for e, c in enumerate(elements.tolist(), 1)]
    middles = angle + pi / (4 * n)
    on_left = np.abs(np.abs(np.angle(np.exp(1j * middles))) - pi) < WETTED
    outer = len(elements) - 4 * n + 1 + np.flatnonzero(on_left)
    lines += ["*SURFACE, NAME=wetted", *(f"{e}, S2" for e in outer.tolist())]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def _quads(a: Array, b: Array, c: Array, d: Array) -> Array:
    return np.stack([a.ravel(), b.ravel(), c.ravel(), d.ravel()], axis=-1)
