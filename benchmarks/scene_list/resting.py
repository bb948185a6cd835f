"""Boxes that stack, lean, tip over, or stand on an edge."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .making import Case, block, case, fixed, floor, on_corner, scene, shaped, turned


@scene
def stack_in_the_plane(_: Path) -> Case:
    """Return the scene: five flush boxes of unequal meshes."""
    sizes = [4, 6, 4, 6, 4]
    return case(
        [block([0.0, float(k)], [1.0, 1.0], [n, n]) for k, n in enumerate(sizes)], [floor(2)]
    )


@scene
def stack_in_space(_: Path) -> Case:
    """Return the scene: three flush boxes of unequal meshes."""
    up = [block([0.0, 0.0, float(k)], [1.0] * 3, [n] * 3) for k, n in enumerate((2, 3, 2))]
    return case(up, [floor(3)])


@scene
def inset_stack(_: Path) -> Case:
    """Return the scene: boxes that get smaller upwards."""
    sizes = [1.0, 0.73, 0.41]
    bodies = [
        block([0.5 - s / 2, 0.5 - s / 2, sum(sizes[:k])], [s] * 3, [2] * 3)
        for k, s in enumerate(sizes)
    ]
    return case(bodies, [floor(3)])


@scene
def pyramid_of_boxes(_: Path) -> Case:
    """Return the scene: four, three, two, one."""
    bodies = [
        block([1.1 * i + 0.55 * row, float(row)], [1.0, 1.0], [3, 3])
        for row in range(4)
        for i in range(4 - row)
    ]
    return case(bodies, [floor(2)], friction=0.6)


@scene
def house_of_cards(folder: Path) -> Case:
    """Return the scene: thin cards lean on one another in two storeys."""
    length, thin, angle, apart = 1.0, 0.03, np.radians(70.0), 1e-3
    along, across = length * np.cos(angle), thin * np.sin(angle)
    height = length * np.sin(angle) + thin * np.cos(angle)

    def leaning(middle: float, low: float) -> list[Case]:
        aside = 0.5 * (along + across) + apart
        return [
            shaped(
                folder,
                turned(
                    [middle + s * aside, low + height / 2],
                    np.pi / 2 + s * (np.pi / 2 - angle),
                    size,
                ),
                [20, 2],
            )
            for s, size in ((-1, [length, thin]), (1, [length, thin]))
        ]

    pitch = 2.0 * (along + across) + 0.05
    deck = block([-0.15, height + apart], [pitch + 0.3, thin], [20, 2])
    cards = [*leaning(0.0, apart), *leaning(pitch, apart), deck]
    cards += leaning(0.5 * pitch, height + thin + 2.0 * apart)
    made = case(cards, [floor(2)], friction=0.6)
    made["materials"]["m"]["young"] = 2e9
    return made


@scene
def box_on_its_edge(folder: Path) -> Case:
    """Return the scene: a square that falls over its corner."""
    form = turned([0.0, 0.8], np.pi / 4 + 0.05, [1.0, 1.0])
    return case([shaped(folder, form, [6, 6])], [floor(2)], end=2.0)


@scene
def cube_on_its_corner(folder: Path) -> Case:
    """Return the scene: a cube that falls on its corner."""
    return case([shaped(folder, on_corner([0.0, 0.0, 0.9], 1.0), [3] * 3)], [floor(3)])


@scene
def corner_on_corner(folder: Path) -> Case:
    """Return the scene: a square on its corner falls on that of another."""
    below = turned([0.0, 0.72], np.pi / 4, [1.0, 1.0])
    above = turned([0.0, 2.25], np.pi / 4, [1.0, 1.0])
    walls = [fixed("left", [-1.2, 0.0], [0.6, 0.4]), fixed("right", [0.6, 0.0], [0.6, 0.4])]
    held = shaped(folder, below, [5, 5])
    return case([held, shaped(folder, above, [5, 5])], [floor(2), *walls], end=1.0)


@scene
def block_slides_off_a_table(_: Path) -> Case:
    """Return the scene: it tips over the edge."""
    sliding = block([-0.6, 0.5], [0.4, 0.2], [6, 3], velocity=[2.0, 0.0])
    return case(
        [sliding], [fixed("table", [-2.0, 0.0], [2.0, 0.5]), floor(2)], end=1.0, friction=0.1
    )


@scene
def cliff_edges(_: Path) -> Case:
    """Return the scene: a cube comes down half over the edge of another, edge along edge."""
    below, above = block([0.0] * 3, [1.0] * 3, [3] * 3), block([0.5, 0.0, 1.05], [1.0] * 3, [3] * 3)
    return case([below, above], [floor(3)])


@scene
def internal_edges(_: Path) -> Case:
    """Return the scene: a cube slides over the seam between two cubes that stand side by side."""
    below = [block([float(k), 0.0, 0.0], [1.0] * 3, [2] * 3) for k in range(2)]
    slider = block([0.1, 0.25, 1.0], [0.5] * 3, [2] * 3, velocity=[2.0, 0.0, 0.0])
    return case([*below, slider], [floor(3)], end=0.6, friction=0.1)
