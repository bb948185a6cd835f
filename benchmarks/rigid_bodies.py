"""Rigid bodies: a top, a ball that rolls, and heaps that come to rest.

    .venv/bin/python benchmarks/rigid_bodies.py [top | roll | heap] [boxes ...]

Prints

- how far an unstable top without torque drifts in energy and angular momentum over 10⁵ steps,
- how far a round body that rolls 100 m on a plane drifts in energy and speed,
- for heaps of so many boxes in the plane, let go turning: the kinetic energy at the end over the
  largest, the contacts, the largest depth in sizes of a box, iterations per step and the time.
"""

from __future__ import annotations

import sys
import tempfile
import warnings
from pathlib import Path
from time import process_time

import numpy as np

import carom

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "validation"))

from rolling_bodies import rolling

GRAVITY = 9.81


def main() -> None:
    """Print what is asked for."""
    warnings.simplefilter("ignore")
    words = sys.argv[1:]
    asked = {"top", "roll", "heap"} & set(words) or {"top", "roll", "heap"}
    if "top" in asked:
        top()
    if "roll" in asked:
        roll(2)
        roll(3)
    if "heap" in asked:
        for count in [int(word) for word in words if word.isdigit()] or [20, 100]:
            heap(count)


def ran(scenario: carom.Scenario) -> tuple[carom.Result, float]:
    """Run a scenario; return its result and the time that took [s]."""
    with tempfile.TemporaryDirectory() as place:
        start = process_time()
        result = carom.run(scenario, out=f"{place}/run")
        took = process_time() - start
        _ = result.history["time"]
        return result, took


def top() -> None:
    """Spin an asymmetric top about its middle axis."""
    steps, step = 100_000, 1e-3
    body = carom.RigidBody(
        name="top",
        density=1000.0,
        mesh=carom.Box(corner=[-0.5, -0.3, -0.2], size=[1.0, 0.6, 0.4], divisions=[1, 1, 1]),
        spin=[0.1, 5.0, 0.2],
    )
    result, took = ran(
        carom.Scenario(
            dimension=3,
            analysis=carom.Dynamic(end_time=steps * step, time_step=step),
            bodies=[body],
            output=carom.Output(history_every=steps * step / 20, fields_every=steps * step),
        )
    )
    history = result.history
    momentum = np.stack([history[f"angular_momentum_{axis}"] for axis in "xyz"])
    energy = np.ptp(history["total"]) / history["total"][0]
    turning = np.abs(momentum - momentum[:, :1]).max() / np.linalg.norm(momentum[:, 0])
    print(f"top, {steps} steps: energy {energy:.1e}, angular momentum {turning:.1e}, {took:.1f} s")


def roll(dimension: int) -> None:
    """Roll a disc or a ball for 100 m."""
    length = 100.0
    result, took = ran(rolling(dimension, length=length, condition="endpoint"))
    history = result.history
    energy = np.ptp(history["total"]) / history["total"][0]
    slower = abs(history["b.v_x"][-1] / history["b.v_x"][0] - 1.0)
    where = f"{length:g} m in {dimension}D"
    print(f"roll {where}: energy {energy:.1e}, speed {slower:.1e}, {took:.1f} s")


def heap(count: int) -> None:
    """Let boxes fall on one another between two walls and come to rest."""
    side, pitch, end, step = 0.4, 0.55, 3.0, 4e-3
    columns = max(round((1.6 * count) ** 0.5), 1)
    chance = np.random.default_rng(1)
    bodies = []
    for k in range(count):
        place = np.array([k % columns, k // columns]) * pitch + 0.05 + 0.03 * chance.random(2)
        mesh = carom.Rectangle(corner=list(place), size=[side, side], divisions=[1, 1])
        spin = float(chance.normal())
        bodies.append(carom.RigidBody(name=f"b{k}", density=1.0, mesh=mesh, spin=spin))
    width = columns * pitch + 0.1
    walls = [
        carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0]),
        carom.Plane(name="left", point=[0.0, 0.0], normal=[1.0, 0.0]),
        carom.Plane(name="right", point=[width, 0.0], normal=[-1.0, 0.0]),
    ]
    result, took = ran(
        carom.Scenario(
            analysis=carom.Dynamic(end_time=end, time_step=step, gravity=[0.0, -GRAVITY]),
            bodies=bodies,
            obstacles=walls,
            contact=carom.Contact(
                condition="endpoint",
                friction=0.4,
                solver=carom.FrictionSolver(tolerance=1e-8),
                certificate_tolerance=1e-3,
                penetration_tolerance=0.5,
            ),
            output=carom.Output(history_every=end / 20, fields_every=end),
        )
    )
    history, summary = result.history, result.summary
    left = history["kinetic"][-1] / np.max(history["kinetic"])
    each = summary["newton_iterations"] / summary["steps"]
    deep = np.max(history["penetration"]) / side
    print(
        f"heap of {count}: kinetic {left:.1e}, {history['contacts'][-1]:.0f} contacts, depth "
        f"{deep:.1e}, {each:.1f} iterations per step, {took:.0f} s",
        flush=True,
    )


if __name__ == "__main__":
    main()
