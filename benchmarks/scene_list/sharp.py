"""Spikes, needles and wedges, most of them from Erleben's set."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .making import Case, Map, block, case, fixed, floor, scene, shaped


def spike(centre: list[float], height: float, *, down: bool = False, ridge: bool = False) -> Map:
    """Return a map from the unit cube to a spike, or a wedge with a ridge along y."""

    def form(x: np.ndarray) -> np.ndarray:
        width = 0.5 * (1.0 - 0.96 * x[:, 2])
        out = (x - [0.5, 0.5, 0.0]) * [1.0, 1.0, height]
        out[:, 0] *= width
        out[:, 1] *= 0.5 if ridge else width
        if down:
            out[:, 1:] *= -1.0
        return out + centre

    return form


@scene
def wedge_between_two_blocks(folder: Path) -> Case:
    """Return the scene: a sharp wedge is driven into the gap between two blocks."""

    def form(x: np.ndarray) -> np.ndarray:
        width = 0.02 + 0.5 * x[:, 1]
        return np.stack([(x[:, 0] - 0.5) * width, 1.0 + x[:, 1]], axis=1)

    blocks = [block([-1.0, 0.0], [0.99, 1.0], [5, 5]), block([0.01, 0.0], [0.99, 1.0], [5, 5])]
    wedge = shaped(folder, form, [2, 8], velocity=[0.0, -3.0])
    return case([*blocks, wedge], [floor(2)], end=0.5, step=1e-3)


def needle(folder: Path, cells: int) -> Case:
    """Return a needle that falls on a sheet held at its rim."""
    sheet = block([-0.5, -0.5, 0.0], [1.0, 1.0, 0.1], [cells, cells, 1])
    pin = shaped(
        folder, spike([0.03, 0.02, 0.62], 0.5, down=True), [1, 1, 3], velocity=[0, 0, -3.0]
    )
    rims = [
        fixed("rim-a", [-0.6, -0.6, -0.3], [1.2, 0.2, 0.3]),
        fixed("rim-b", [-0.6, 0.4, -0.3], [1.2, 0.2, 0.3]),
    ]
    return case([sheet, pin], rims, end=0.4, step=1e-3)


@scene
def needle_on_a_coarse_sheet(folder: Path) -> Case:
    """Return the scene: facets much larger than the tip."""
    return needle(folder, 3)


@scene
def needle_on_a_fine_sheet(folder: Path) -> Case:
    """Return the scene: facets about as large as the tip is wide higher up."""
    return needle(folder, 10)


def standing(folder: Path, below: Map, above: Map) -> Case:
    """Return one shape that falls on another which stands on the floor."""
    bodies = [
        shaped(folder, below, [2, 2, 4]),
        shaped(folder, above, [2, 2, 4], velocity=[0, 0, -1.0]),
    ]
    return case(bodies, [floor(3)], end=0.8, step=1e-3)


@scene
def spikes(folder: Path) -> Case:
    """Return the scene: tip on tip, nearly."""
    return standing(folder, spike([0, 0, 0], 0.8), spike([0.004, 0.003, 1.62], 0.8, down=True))


@scene
def spike_and_wedge(folder: Path) -> Case:
    """Return the scene: a tip on a ridge."""
    above = spike([0.0, 0.1, 1.62], 0.8, down=True)
    return standing(folder, spike([0, 0, 0], 0.8, ridge=True), above)


@scene
def wedges(folder: Path) -> Case:
    """Return the scene: ridge across ridge."""

    def above(x: np.ndarray) -> np.ndarray:
        form = spike([0.0, 0.0, 1.62], 0.8, down=True, ridge=True)(x)
        return np.stack([-form[:, 1], form[:, 0], form[:, 2]], axis=1)

    return standing(folder, spike([0, 0, 0], 0.8, ridge=True), above)


@scene
def spike_in_a_crack(folder: Path) -> Case:
    """Return the scene: a tip goes into the gap between two blocks."""
    blocks = [
        block([-1.02, -0.5, 0.0], [1.0] * 3, [2] * 3),
        block([0.02, -0.5, 0.0], [1.0] * 3, [2] * 3),
    ]
    above = shaped(folder, spike([0, 0, 1.85], 0.8, down=True), [2, 2, 4], velocity=[0, 0, -1.0])
    return case([*blocks, above], [floor(3)], end=0.8, step=1e-3)


@scene
def wedge_in_a_crack(folder: Path) -> Case:
    """Return the scene: a ridge goes into the gap between two blocks, along it."""
    blocks = [
        block([-1.02, -0.5, 0.0], [1.0] * 3, [2] * 3),
        block([0.02, -0.5, 0.0], [1.0] * 3, [2] * 3),
    ]
    above = spike([0, 0, 1.85], 0.8, down=True, ridge=True)
    body = shaped(folder, above, [2, 2, 4], velocity=[0, 0, -1.0])
    return case([*blocks, body], [floor(3)], end=0.8, step=1e-3)


@scene
def spike_in_a_hole(folder: Path) -> Case:
    """Return the scene: a tip goes into the hole between four rigid posts and a floor."""
    at = [(-0.55, -0.05), (0.05, -0.05), (-0.05, -0.55), (-0.05, 0.05)]
    sizes = [(0.5, 0.1), (0.5, 0.1), (0.1, 0.5), (0.1, 0.5)]
    posts = [
        fixed(f"post-{k}", [*a, 0.0], [*s, 0.6])
        for k, (a, s) in enumerate(zip(at, sizes, strict=True))
    ]
    above = shaped(
        folder, spike([0.0, 0.0, 1.42], 0.8, down=True), [2, 2, 4], velocity=[0, 0, -1.0]
    )
    return case([above], [*posts, floor(3, -0.001)], end=0.8, step=1e-3)
