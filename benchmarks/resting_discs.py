"""Ten damped discs that come to rest in a box: whether their velocities are those of their motion.

    .venv/bin/python benchmarks/resting_discs.py [condition ...]

With θ = ½ velocities of closed contacts may change sign in every step and be those of no motion.
Prints for every condition, once a second, the largest speed of a node, the largest change of a
displacement in the step over its length, by how much the two differ [m/s], and the kinetic energy
over m g h. While the motion decays, one is that of the end of the step, the other of its middle.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator

import numpy as np

import carom

CONDITIONS = ("midpoint", "gap")
GRAVITY = 9.81
RADIUS = 0.25
STEP = 1e-3
END = 6


def main() -> None:
    """Print the table."""
    print(f"{'condition':10}{'t [s]':>7}{'|v|':>10}{'|Δu|/Δt':>10}{'apart':>10}{'kinetic':>10}")
    for condition in sys.argv[1:] or CONDITIONS:
        for time, speed, motion, kinetic in rest(condition):
            apart = abs(speed - motion)
            numbers = "".join(f"{x:10.1e}" for x in (speed, motion, apart, kinetic))
            print(f"{condition:10}{time:7.2f}{numbers}", flush=True)


def scenario(condition: str) -> carom.Scenario:
    """Return ten discs, not quite above one another, in a box without a lid."""
    walls = {
        "floor": ([0.0, 0.0], [0, 1]),
        "left": ([0.0, 0.0], [1, 0]),
        "right": ([1.7, 0.0], [-1, 0]),
    }
    bodies = [
        {
            "name": f"disc-{k}",
            "material": "rubber",
            "mesh": {
                "kind": "disc",
                "centre": [0.3 + 0.52 * (k % 3) + 0.04 * (k // 3), 0.3 + 0.52 * (k // 3)],
                "radius": RADIUS,
                "divisions": 4,
            },
        }
        for k in range(10)
    ]
    rubber = {"kind": "neo-hookean", "young": 1e6, "poisson": 0.3, "density": 1000.0}
    rubber["damping"] = {"mass": 10.0, "stiffness": 1e-3}
    case = {
        "analysis": {"end_time": END, "time_step": STEP, "gravity": [0.0, -GRAVITY]},
        "materials": {"rubber": rubber},
        "bodies": bodies,
        "obstacles": [
            {"name": name, "kind": "plane", "point": point, "normal": normal}
            for name, (point, normal) in walls.items()
        ],
        "contact": {"friction": 0.3, "condition": condition},
    }
    return carom.Scenario.from_dict(case)


def rest(condition: str) -> Iterator[tuple[float, float, float, float]]:
    """Yield time [s], largest speed, largest change of a displacement over Δt [m/s], T / m g h."""
    simulation = carom.Simulation(scenario(condition))
    weight = 1000.0 * np.pi * RADIUS**2 * 10 * GRAVITY * 2.0
    for second in range(1, END + 1):
        simulation.advance(second - 1.5 * STEP)
        before = displacements(simulation)
        simulation.step()
        velocity = np.concatenate([body.velocity for body in simulation.bodies.values()])
        change = (displacements(simulation) - before) / STEP
        largest = [float(np.linalg.norm(x, axis=1).max()) for x in (velocity, change)]
        yield simulation.time, *largest, simulation.energy.kinetic / weight


def displacements(simulation: carom.Simulation) -> np.ndarray:
    """Return those of all nodes [m]."""
    return np.concatenate([body.displacement for body in simulation.bodies.values()])


if __name__ == "__main__":
    main()
