"""Whether penetration is measured as an independent geometry library sees it.

    pip install shapely manifold3d
    .venv/bin/python benchmarks/penetration.py [scenes] [first seed]

The scenes of `wild_scenes.py`, step by step: the outlines of all bodies as polygons of shapely or
as closed surfaces of manifold3d, which know nothing of carom. A step at whose end two bodies, or a
body and a wall, have an intersection that is deeper than round-off, or a body crosses itself, must
have a penetration in its row of the history; in the plane it must be as deep, in space not less
than a tenth of how thick what both have in common is. A row may tell of more: it has the deepest of
halved steps too, and of bodies in themselves. Prints a table, and ends with exit status 1
if an intersection was silent.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from scenes import judged
from wild_scenes import scene

import carom
from carom.building.build import build

try:
    from shapely import Point, Polygon
except ImportError:
    sys.exit("shapely is not installed: pip install shapely") if __name__ == "__main__" else None

PIECES = 200
"""Pieces of an edge whose ends are looked at."""

ROUND_OFF = 1e-12
"""Depth that is none, of a metre."""


def main() -> None:
    """Measure all scenes."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 500
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    found: dict[str, int] = defaultdict(int)
    least = np.inf
    for seed in range(first, first + count):
        scenario = scene(seed)
        if scenario.dimension == 3:
            row = judged(scenario)
            found["scenes in space"] += 1
            found["scenes in space with an intersection"] += row["seen"] > 0.0
            if row["silent"]:
                found["silent"] += 1
                time, told, seen = row["silent"]
                print(f"scene {seed}: at t = {time:.4g} s told {told:.3g} m, seen {seen:.3g} m")
            continue
        found["scenes in the plane"] += 1
        tells = True
        for told, seen, crosses in steps(scenario):
            found["steps"] += 1
            found["steps with an intersection"] += seen > ROUND_OFF
            # A body is looked at for itself when it has deformed by a twentieth of a cell.
            tells = told > 0.0 or not crosses
            if seen > ROUND_OFF and told < 0.5 * seen:
                found["silent"] += 1
                print(f"scene {seed}: told {told:.3g} m, seen {seen:.3g} m, crosses: {crosses}")
            elif not crosses and seen > 1e-9:
                least = min(least, told / seen)
        if not tells:
            found["silent"] += 1
            print(f"scene {seed}: crosses itself at its end, and the last row says nothing")
    for what, number in found.items():
        print(f"{what:37} {number}")
    print(f"{'least of what is seen that is told':37} {least:.6g}")
    raise SystemExit(found["silent"] > 0)


def steps(scenario: carom.Scenario) -> Iterator[tuple[float, float, bool]]:
    """Yield for every step how deep its row says, how deep shapely sees, whether a body crosses."""
    simulation = build(scenario, [])
    columns = simulation.history_columns()
    surface, mesh = simulation.surface(), simulation.mesh()
    outlines = list(rings(surface))
    simulation.take_history()
    dt = scenario.analysis.time_step
    for step in range(1, round(scenario.analysis.end_time / dt) + 1):
        try:
            simulation.advance((step - 0.5) * dt, 1e9)
        except carom.ConvergenceError:
            return
        rows = simulation.take_history()
        if len(rows) == 0:
            continue
        x = (mesh["points"] + simulation.fields()["displacement"])[:, :2]
        bodies = [Polygon(x[ring]) for ring in outlines]
        crosses = not all(body.is_valid for body in bodies)
        seen = 0.0 if crosses else deepest(bodies, scenario)
        yield float(rows[-1][columns.index("penetration")]), seen, crosses


def rings(surface: Mapping[str, Any]) -> Iterator[np.ndarray]:
    """Yield the nodes along the outline of every body."""
    segments = surface["connectivity"].reshape(-1, 2)
    for body in np.unique(surface["body"]):
        following = dict(segments[surface["body"] == body].tolist())
        ring = [next(iter(following))]
        while (node := following[ring[-1]]) != ring[0]:
            ring.append(node)
        yield np.array(ring)


def deepest(bodies: list[Polygon], scenario: carom.Scenario) -> float:
    """Return the largest depth of a point of an outline in another body or behind a wall [m]."""
    depth = 0.0
    for wall in scenario.obstacles:
        normal, point = np.array(wall.normal), np.array(wall.point)
        normal = normal / np.linalg.norm(normal)
        for body in bodies:
            depth = max(depth, *(-(np.array(body.exterior.coords) - point) @ normal))
    for a in bodies:
        for b in bodies:
            if a is b or not a.intersects(b):
                continue
            inside = a.exterior.intersection(b)
            for line in getattr(inside, "geoms", [inside]):
                for share in np.linspace(0.0, 1.0, PIECES + 1):
                    x = (
                        line
                        if isinstance(line, Point)
                        else line.interpolate(share, normalized=True)
                    )
                    depth = max(depth, b.exterior.distance(x))
    return depth


if __name__ == "__main__":
    main()
