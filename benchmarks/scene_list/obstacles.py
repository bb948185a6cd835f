"""Bodies on obstacles: with edges and corners, round and smaller than a cell, or long."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .making import Case, block, case, fixed, floor, scene, shaped, stl, turned


def plate() -> Case:
    """Return a plate of coarse cells, just above 0.3 m."""
    return block([-0.5, -0.5, 0.31], [1.0, 1.0, 0.2], [5, 5, 2])


@scene
def plate_over_a_post(_: Path) -> Case:
    """Return the scene: a coarse plate falls over a post narrower than its cells."""
    return case([plate()], [fixed("post", [-0.08, -0.08, 0.0], [0.16, 0.16, 0.3]), floor(3)])


@scene
def plate_over_a_post_in_the_plane(_: Path) -> Case:
    """Return the scene: the same in the plane."""
    plate = block([-0.5, 0.31], [1.0, 0.2], [5, 2])
    return case([plate], [fixed("post", [-0.08, 0.0], [0.16, 0.3]), floor(2)])


@scene
def plate_across_a_beam(_: Path) -> Case:
    """Return the scene: neither has a node over the other."""
    return case([plate()], [fixed("beam", [-1.0, -0.08, 0.0], [2.0, 0.16, 0.3]), floor(3)])


@scene
def plate_over_a_pyramid(folder: Path) -> Case:
    """Return the scene: a pyramid of triangles under the middle of a coarse plate."""
    base = [[-0.3, -0.3, 0.0], [0.3, -0.3, 0.0], [0.3, 0.3, 0.0], [-0.3, 0.3, 0.0]]
    triangles = [[0, 2, 1], [0, 3, 2], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]
    pyramid = stl(folder, [*base, [0.02, 0.03, 0.3]], triangles, "pyramid")
    return case([plate()], [pyramid, floor(3, -0.001)])


def round_posts(dimension: int, *, bars: bool = False) -> Case:
    """Return a coarse plate that falls on round posts smaller than its facets."""
    places = [[-0.2], [0.2]]
    if dimension == 3 and not bars:
        places = [[x, y] for x in (-0.2, 0.2) for y in (-0.2, 0.2)]
    bar = {"kind": "cylinder", "axis": [0.0, 1.0, 0.0]} if bars else {"kind": "sphere"}
    middle = "point" if bars else "centre"
    rest = [0.0, 0.2] if bars else [0.2]
    posts = [
        {"name": f"post-{k}", "radius": 0.1, **bar, middle: [*at, *rest]}
        for k, at in enumerate(places)
    ]
    aside = dimension - 1
    plate = block([-0.5] * aside + [0.31], [1.0] * aside + [0.2], [5] * aside + [2])
    return case([plate], [*posts, floor(dimension)])


@scene
def plate_on_small_discs(_: Path) -> Case:
    """Return the scene: discs touch a coarse plate between its nodes."""
    return round_posts(2)


@scene
def plate_on_small_balls(_: Path) -> Case:
    """Return the scene: balls touch facets of a coarse plate in their middles."""
    return round_posts(3)


@scene
def plate_on_thin_bars(_: Path) -> Case:
    """Return the scene: bars lie across the edges of its facets."""
    return round_posts(3, bars=True)


@scene
def square_in_a_notch(folder: Path) -> Case:
    """Return the scene: a square falls on its corner into a dent of a polygon that is narrower."""
    corners = [
        [-1.0, -0.5],
        [1.0, -0.5],
        [1.0, 0.1],
        [0.25, 0.0],
        [0.0, -0.3],
        [-0.2, 0.0],
        [-1.0, 0.0],
    ]
    notch = {"name": "notch", "kind": "polygon", "points": corners}
    form = turned([0.03, 0.75], np.pi / 4, [1.0, 1.0])
    return case([shaped(folder, form, [5, 5])], [notch], end=2.0)


@scene
def sliding_spool(folder: Path) -> Case:
    """Return the scene: a spool slides along two rails, between its flanges."""

    def form(x: np.ndarray) -> np.ndarray:
        across, along = 2.0 * x[:, :2] - 1.0, 2.0 * x[:, 2] - 1.0
        reach, length = np.abs(across).max(axis=1), np.linalg.norm(across, axis=1)
        round_ = (
            across * np.divide(reach, length, out=np.zeros_like(reach), where=length > 0)[:, None]
        )
        radius = np.where(np.abs(along) > 0.55, 0.3, 0.15)
        disc = round_ * radius[:, None]
        return np.stack([disc[:, 0], 0.8 * along, 0.651 + disc[:, 1]], axis=1)

    rails = [
        fixed("left", [-1.0, -0.35, 0.0], [4.0, 0.1, 0.5]),
        fixed("right", [-1.0, 0.25, 0.0], [4.0, 0.1, 0.5]),
    ]
    spool = shaped(folder, form, [4, 4, 8], velocity=[2.0, 0.3, 0.0])
    return case([spool], rails, end=0.8, friction=0.1)


@scene
def ball_rolls_far(_: Path) -> Case:
    """Return the scene: a ball rolls 100 m over the seams of a fine floor."""
    tops = [[0.1 * k - 1.0, 0.0] for k in range(1030, -1, -1)]
    ground = {"name": "ground", "kind": "polygon", "points": [[-1.0, -1.0], [102.0, -1.0], *tops]}
    mesh = {"kind": "disc", "centre": [0.0, 0.501], "radius": 0.5, "divisions": 8}
    ball = {"mesh": mesh, "velocity": [10.0, 0.0], "spin": -20.0}
    return case([ball, block([-0.95, 0.001], [0.2, 0.2], [2, 2])], [ground], end=10.0, damped=False)
