"""How deep nodes are inside other bodies and obstacles, by outlines alone."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array, cross
from carom.auditing.model import AuditModel


def deepest_node(model: AuditModel, position: Array, time: float) -> float:
    """Return the largest depth of a node in what it may touch [m], where nodes are at `position`.

    Edges may be deeper between their ends.
    """
    bodies = {body.name: body for body in model.bodies}
    names = (obstacle.name for obstacle in model.scenario.obstacles)
    obstacles = dict(zip(names, model.obstacles, strict=True))
    deepest = 0.0
    for a, b in model.pairs():
        for mine, other in ((a, b), (b, a)):
            if mine not in bodies:
                continue
            body, depth = bodies[mine], np.zeros(1)
            nodes = position[body.span][np.unique(body.outline)]
            if other in obstacles:
                depth = -obstacles[other].distance(nodes, time)
            elif not bodies[other].images.size:  # Others are not closed.
                target = bodies[other]
                depth = _depths(nodes, position[target.span][target.outline])
            deepest = max(deepest, float(depth.max(initial=0.0)))
    return deepest


def _depths(points: Array, segments: Array) -> Array:
    """Return how deep points are inside a closed outline [m], of shape [count]; outside 0.

    Segments have the shape [segment_count, 2, 2]. Inside is what the outline winds around: the ray
    to the right crosses it more often upwards than downwards.
    """
    start, along = segments[:, 0], segments[:, 1] - segments[:, 0]
    offset = points[:, None] - start
    share = np.clip((offset * along).sum(axis=2) / (along**2).sum(axis=1), 0.0, 1.0)
    distance = np.linalg.norm(offset - share[..., None] * along, axis=2).min(axis=1)
    below = segments[None, :, :, 1] <= points[:, None, None, 1]
    left = cross(along[None], offset)
    up = below[..., 0] & ~below[..., 1] & (left > 0)
    down = ~below[..., 0] & below[..., 1] & (left < 0)
    inside: Array = np.where(up.sum(axis=1) > down.sum(axis=1), distance, 0.0)
    return inside
