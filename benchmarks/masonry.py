"""A semicircular arch of 27 stiff blocks in space, at its limits of thickness and of friction.

    .venv/bin/python benchmarks/masonry.py

Heyman's thinnest arch that stands under its own weight has a thickness of 0.1075 of its mean
radius, where friction is plenty (J. Heyman, Int. J. Solids Struct. 2, 1966, after G. Milankovitch,
1907). With a friction below 0.31 no thickness helps: its blocks slide (Gilbert, Casapulla & Ahmed,
Comput. Struct. 84, 2006). Each limit is met from both sides, 3 % off. Where the arch stands, prints
how fast its crown creeps after 20 s.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from scene_list.making import Map, shaped

import carom

BLOCKS = 27
DEPTH = 0.2
DAMPING = {"mass": 10.0, "stiffness": 1e-3}

FALLEN = 0.3
"""The crown of an arch that has fallen is this much lower, of its radius."""


def main() -> None:
    """Print a table."""
    print(f"{'thickness':>10} {'friction':>9} {'':10} {'at [s]':>7} {'crown [m]':>10}")
    for thickness, friction in ((0.1043, 1.0), (0.1107, 1.0), (0.22, 0.301), (0.22, 0.319)):
        simulation = arch(thickness, friction, end=6.0)
        crown, fell = stood(simulation, 6.0)
        word = "falls" if fell else "stands"
        print(
            f"{thickness:10} {friction:9} {word:10} {simulation.time:7.3g} {crown:10.2e}",
            flush=True,
        )
    simulation = arch(0.15, 1.0, end=21.0)
    before, _ = stood(simulation, 20.0)
    after, _ = stood(simulation, 21.0)
    print(f"creep of the crown at a thickness of 0.15 after 20 s: {abs(after - before):.1e} m/s")


def arch(thickness: float, friction: float, end: float) -> carom.Simulation:
    """Return an arch of mean radius 1 m."""
    with tempfile.TemporaryDirectory() as folder:
        bodies = [
            {
                "name": f"block-{k}",
                "material": "stone",
                **shaped(Path(folder), voussoir(k, thickness), [2, 1, 1]),
            }
            for k in range(BLOCKS)
        ]
        return carom.Simulation(
            carom.Scenario.from_dict(
                {
                    "dimension": 3,
                    "analysis": {"end_time": end, "time_step": 5e-3, "gravity": [0.0, 0.0, -9.81]},
                    "materials": {
                        "stone": {
                            "kind": "saint-venant-kirchhoff",
                            "young": 1e9,
                            "poisson": 0.2,
                            "density": 2000.0,
                            "damping": DAMPING,
                        }
                    },
                    "bodies": bodies,
                    "obstacles": [
                        {
                            "name": "ground",
                            "kind": "plane",
                            "point": [0.0, 0.0, 0.0],
                            "normal": [0.0, 0.0, 1.0],
                        }
                    ],
                    "contact": {"friction": friction},
                }
            )
        )


def voussoir(k: int, thickness: float) -> Map:
    """Return a map from the unit cube to block `k`, straight between its two faces."""

    def form(x: np.ndarray) -> np.ndarray:
        radius = 1.0 + thickness * (x[:, 0] - 0.5)
        ends = [np.pi * (1.0 - (k + end) / BLOCKS) for end in (0, 1)]
        faces = [np.stack([radius * np.cos(a), radius * np.sin(a)], 1) for a in ends]
        place = faces[0] * (1.0 - x[:, 2:]) + faces[1] * x[:, 2:]
        return np.stack([place[:, 0], -DEPTH * x[:, 1], place[:, 1]], 1)

    return form


def stood(simulation: carom.Simulation, until: float) -> tuple[float, bool]:
    """Return how far the crown has moved up by a time [m], and whether the arch fell before."""
    crown = simulation.bodies[f"block-{BLOCKS // 2}"]
    height = 0.0
    while simulation.time < until - 1e-9:
        simulation.step()
        height = float(crown.displacement[:, 2].mean())
        if height < -FALLEN:
            return height, True
    return height, False


if __name__ == "__main__":
    main()
