"""How deep nodes are inside other bodies and obstacles, by outlines alone."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array, cross, einsum
from carom.auditing.bodies.body import AuditBody
from carom.auditing.mesh.facets import corners_of
from carom.auditing.model import AuditModel
from carom.auditing.targets.curve import Curve
from carom.auditing.targets.sheet import FlatPatches, Sheet

HALF = 0.5
"""Points that are wound around more often than that are inside."""


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
            if mine not in bodies or mine == other:
                continue
            body, depth = bodies[mine], np.zeros(1)
            nodes = position[body.span][np.unique(body.outline)]
            if other in obstacles:
                depth = -obstacles[other].distance(nodes, time)
            elif not bodies[other].images.size:  # Others are not closed.
                target = bodies[other]
                depth = _depths(nodes, position[target.span], target)
            depth = depth - _clearance(model, (a, b), time)
            deepest = max(deepest, float(depth.max(initial=0.0)))
    return deepest


def _clearance(model: AuditModel, pair: tuple[str, str], time: float) -> float:
    """Return how deep two may be inside one another by their interference [m]."""
    interference = model.interference(*pair)
    most = 0.0
    if interference.left(time) > 0.0:
        between = [(side.source, side.target) for side in model.sides]
        sides = [key for key in between if {model.name(n) for n in key} == set(pair)]
        most = max(model.deepest(*key) for key in sides)
    return max(-float(interference.at(time, most)), 0.0)


def _depths(points: Array, position: Array, body: AuditBody) -> Array:
    """Return how deep points are inside a body with nodes at `position` [m], shape [count]."""
    outline = position[body.outline]
    low, high = outline.min(axis=(0, 1)), outline.max(axis=(0, 1))
    near = np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
    depths = np.zeros(len(points))
    if len(near) and body.dimension == 2 and outline.shape[1] == 3:
        # Facets of second order are parabolas.
        curve = Curve(body.outline, body.points, smooth=False)
        depths[near] = np.maximum(-curve.signed_distance(points[near], position), 0.0)
    elif len(near) and body.dimension == 2:
        depths[near] = _in_outline(points[near], outline)
    elif len(near):
        sheet = Sheet(FlatPatches(body.outline))
        behind = np.maximum(-sheet.signed_distance(points[near], position), 0.0)
        inside = _windings(points[near], position[corners_of(body.outline, 3)]) > HALF
        depths[near] = np.where(inside, behind, 0.0)
    return depths


def _windings(points: Array, corners: Array) -> Array:
    """Return how often a closed surface goes around points, shape [count].

    Facets with these corners, shape [facet_count, corner, 3], are fans of triangles around their
    middles, whose solid angles are summed (Van Oosterom & Strackee 1983).
    """
    middle = np.broadcast_to(corners.mean(axis=1, keepdims=True), corners.shape)
    fans = np.stack([middle, corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 3, 3)
    total = np.zeros(len(points))
    for k, point in enumerate(points):
        a, b, c = (fans - point).transpose(1, 0, 2)
        la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
        volume = einsum("ti,ti->t", a, cross(b, c))
        around = la * lb * lc + einsum("ti,ti->t", a, b) * lc
        around = around + einsum("ti,ti->t", b, c) * la + einsum("ti,ti->t", c, a) * lb
        total[k] = 2.0 * np.arctan2(volume, around).sum()
    return total / (4.0 * np.pi)


def _in_outline(points: Array, segments: Array) -> Array:
    """Return how deep points are inside a closed outline [m], of shape [count]; outside 0.

    Segments have the shape [segment_count, 2, 2]. Inside is what the outline winds around: the ray
    to the right crosses it more often upwards than downwards.
    """
    start, along = segments[:, 0], segments[:, 1] - segments[:, 0]
    offset = points[:, None] - start
    share = np.clip((offset * along).sum(axis=2) / (along**2).sum(axis=1), 0.0, 1.0)
    distance = np.linalg.norm(offset - share[..., None] * along, axis=2).min(axis=1)
    below = segments[None, :, :, 1] <= points[:, None, None, 1]
    left = cross(np.broadcast_to(along, offset.shape), offset)[..., 0]
    up = below[..., 0] & ~below[..., 1] & (left > 0)
    down = ~below[..., 0] & below[..., 1] & (left < 0)
    inside: Array = np.where(up.sum(axis=1) > down.sum(axis=1), distance, 0.0)
    return inside
