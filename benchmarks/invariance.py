"""Random small scenes told in other words: what is the same must move the same.

    .venv/bin/python benchmarks/invariance.py [scenes per setting] [setting ...]

Two or three blocks are thrown at one another and a floor, on meshes of their own. Every scene is
run as it is, with nodes and cells in another order, bodies in another order, turned, mirrored,
shifted, and in millimetres and milliseconds. Settings are the contact conditions, and mortar pairs
with those that know them. Prints for every setting and every such change the largest difference of
an energy term at any time, relative to the largest energy, and where.
"""

from __future__ import annotations

import contextlib
import sys
import tempfile
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import meshio
import numpy as np

import carom
from carom.building.build import build

TERMS = ("kinetic", "strain", "friction")
STEPS = 60
SETTINGS: dict[str, dict[str, Any]] = {
    **{name: {"condition": name} for name in ("midpoint", "gap", "endpoint", "massless")},
    **{
        f"mortar-{name}": {"condition": name, "discretisation": "mortar"}
        for name in ("midpoint", "gap", "endpoint")
    },
}
SHIFT = np.array([3.0, -2.0, 1.5])


@dataclass(frozen=True)
class Block:
    """A body: its mesh and how it is thrown."""

    points: np.ndarray
    cells: np.ndarray
    velocity: np.ndarray


@dataclass(frozen=True)
class Scene:
    """Some blocks over a floor; one of lengths and one of times say its units."""

    blocks: list[Block]
    point: np.ndarray
    normal: np.ndarray
    gravity: np.ndarray
    metre: float = 1.0
    second: float = 1.0


def made(rng: np.random.Generator, dimension: int) -> Scene:
    """Return a random scene."""
    up = np.eye(dimension)[-1]
    blocks, height = [], 0.0
    for k in range(int(rng.integers(2, 4))):
        size = rng.uniform(0.4, 1.0, dimension)
        size[-1] *= 0.6
        divisions = rng.integers(3, 5, dimension)
        points, cells = grid(size, divisions)
        low = rng.uniform(-0.2, 0.2, dimension) - size / 2
        low[-1] = height + 0.004
        height = low[-1] + size[-1]
        velocity = rng.uniform(-0.3, 0.3, dimension)
        velocity[-1] = -0.4 * (k + 1)
        blocks.append(Block(points + low, cells, velocity))
    return Scene(blocks, 0.0 * up, up, -9.81 * up)


def grid(size: np.ndarray, divisions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes and cells of a box between 0 and its size."""
    axes = [np.linspace(0.0, s, n + 1) for s, n in zip(size, divisions, strict=True)]
    nodes = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    number = np.arange(nodes[..., 0].size).reshape(nodes.shape[:-1])
    around = [(0, 0), (1, 0), (1, 1), (0, 1)]
    if len(size) == 3:
        around = [(*xy, z) for z in (0, 1) for xy in around]
    parts = [
        number[tuple(slice(c, c + n) for c, n in zip(corner, divisions, strict=True))].ravel()
        for corner in around
    ]
    return nodes.reshape(-1, len(size)), np.stack(parts, axis=1)


def renumbered(scene: Scene, rng: np.random.Generator) -> Scene:
    """Return the scene with nodes and cells in another order, and cells from another corner on."""
    blocks = []
    for block in scene.blocks:
        order = rng.permutation(len(block.points))
        place = np.argsort(order)
        cells = place[block.cells[rng.permutation(len(block.cells))]]
        half = cells.shape[1] // (2 if cells.shape[1] == 8 else 1)
        cells = np.concatenate(
            [np.roll(part, 1, axis=1) for part in np.split(cells, cells.shape[1] // half, axis=1)],
            axis=1,
        )
        blocks.append(replace(block, points=block.points[order], cells=cells))
    return replace(scene, blocks=blocks)


def reordered(scene: Scene, _: np.random.Generator) -> Scene:
    """Return the scene with its last body first."""
    return replace(scene, blocks=scene.blocks[::-1])


def mapped(scene: Scene, matrix: np.ndarray, shift: np.ndarray | float = 0.0) -> Scene:
    """Return the scene under a map of all of space."""
    blocks = []
    for block in scene.blocks:
        cells = block.cells
        if np.linalg.det(matrix) < 0:
            half = cells.shape[1] // (2 if cells.shape[1] == 8 else 1)
            cells = np.concatenate(
                [part[:, ::-1] for part in np.split(cells, cells.shape[1] // half, axis=1)], axis=1
            )
        blocks.append(Block(block.points @ matrix.T + shift, cells, matrix @ block.velocity))
    return replace(
        scene,
        blocks=blocks,
        point=matrix @ scene.point + shift,
        normal=matrix @ scene.normal,
        gravity=matrix @ scene.gravity,
    )


def turned(scene: Scene, rng: np.random.Generator) -> Scene:
    """Return the scene turned."""
    dimension = len(scene.point)
    matrix = np.linalg.qr(rng.normal(size=(dimension, dimension)))[0]
    matrix[0] *= np.sign(np.linalg.det(matrix))
    return mapped(scene, matrix)


def mirrored(scene: Scene, _: np.random.Generator) -> Scene:
    """Return the scene in a mirror."""
    matrix = np.eye(len(scene.point))
    matrix[0, 0] = -1.0
    return mapped(scene, matrix)


def shifted(scene: Scene, _: np.random.Generator) -> Scene:
    """Return the scene some metres away."""
    dimension = len(scene.point)
    return mapped(scene, np.eye(dimension), SHIFT[:dimension])


def in_other_units(scene: Scene, _: np.random.Generator) -> Scene:
    """Return the scene in millimetres and milliseconds."""
    return replace(scene, metre=1e3, second=1e3)


CHANGES: dict[str, Callable[[Scene, np.random.Generator], Scene]] = {
    "renumbered": renumbered,
    "reordered": reordered,
    "turned": turned,
    "mirrored": mirrored,
    "shifted": shifted,
    "in other units": in_other_units,
}


def energies(scene: Scene, contact: dict[str, Any]) -> np.ndarray:
    """Return the terms over time [J], shape [steps, terms], as far as the run came."""
    dimension, m, s = len(scene.point), scene.metre, scene.second
    scheme = {"scheme": {"kind": "conserving"}} if contact["condition"] != "endpoint" else {}
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        bodies = []
        for k, block in enumerate(scene.blocks):
            file = Path(folder) / f"{k}.vtu"
            points = np.pad(block.points * m, ((0, 0), (0, 3 - dimension)))
            kind = "quad" if dimension == 2 else "hexahedron"
            meshio.write_points_cells(file, points, [(kind, block.cells)])
            bodies.append(
                {
                    "name": f"block-{k}",
                    "material": "m",
                    "mesh": {"kind": "file", "file": str(file)},
                    "velocity": list(block.velocity * m / s),
                    **({"thickness": m} if dimension == 2 else {}),
                }
            )
        material = {"kind": "neo-hookean", "young": 1e7 / m / s**2, "poisson": 0.3}
        material["density"] = 1e3 / m**3
        case = {
            "dimension": dimension,
            "analysis": {
                "kind": "dynamic",
                "end_time": STEPS * 2e-3 * s,
                "time_step": 2e-3 * s,
                "gravity": list(scene.gravity * m / s**2),
                **scheme,
            },
            "materials": {"m": material},
            "bodies": bodies,
            "obstacles": [
                {
                    "name": "floor",
                    "kind": "plane",
                    "point": list(scene.point * m),
                    "normal": list(scene.normal),
                }
            ],
            "contact": {"friction": 0.3, **contact},
        }
        simulation = build(carom.Scenario.model_validate(case), [])
        columns = simulation.history_columns()
        with contextlib.suppress(carom.ConvergenceError):
            simulation.advance(1e9, 1e9)
        rows = np.array(simulation.take_history())
    kept = np.full((STEPS + 1, len(TERMS)), np.nan)
    for k, name in enumerate(TERMS):
        kept[: len(rows), k] = rows[: STEPS + 1, columns.index(name)] * (s / m) ** 2
    return kept


def differences(setting: str, seed: int) -> dict[str, tuple[float, int]]:
    """Return for every change of a scene how far it moves otherwise, and from which step on.

    The first is the largest difference of an energy term at any time, relative to the largest
    energy; infinite where the one run came farther than the other.
    """
    rng = np.random.default_rng(seed)
    scene = made(rng, 2 + seed % 2)
    base = energies(scene, SETTINGS[setting])
    apart = {}
    for name, change in CHANGES.items():
        other = energies(change(scene, rng), SETTINGS[setting])
        by = np.abs(other - base) / np.nanmax(np.abs(base))
        if (np.isnan(other) != np.isnan(base)).any():
            by[0, 0] = np.inf
        value = float(np.nanmax(by))
        apart[name] = value, int(np.argmax((by > 0.1 * value).any(axis=1)))
    return apart


def main() -> None:
    """Print the table."""
    words = sys.argv[1:]
    count = next((int(word) for word in words if word.isdigit()), 10)
    for setting in [word for word in words if word in SETTINGS] or SETTINGS:
        worst = dict.fromkeys(CHANGES, (0.0, ""))
        for seed in range(count):
            for name, (value, step) in differences(setting, seed).items():
                if value > worst[name][0]:
                    worst[name] = value, f"scene {seed}, from step {step}"
        for name, (value, where) in worst.items():
            print(f"{setting:16} {name:16}{value:10.1e}  {where}", flush=True)


if __name__ == "__main__":
    main()
