"""Cells that a file numbers the other way round, and cells that are inside out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from carom.display.counting import count
from carom.mesh_file.arrays import Indices, Refused, first_few
from carom.mesh_file.cells import KINDS, smallest_corner

Blocks = list[tuple[str, Indices]]


@dataclass(frozen=True)
class Upright:
    """Cells numbered as carom does.

    Parameters
    ----------
    blocks
        Kinds of cells, as meshio names them, and their nodes.
    turned
        How many cells the file numbers the other way round.
    which
        These as a message says it; empty if there are none.
    """

    blocks: Blocks
    turned: int
    which: str


def upright(points: NDArray[np.float64], blocks: Blocks) -> Upright:
    """Return the cells numbered as carom does, and which of them the file numbers otherwise.

    A cell of negative volume may be sound but numbered the other way round, or pushed through one
    of its sides. Turned, the first kind lies across its sides from its neighbours, the second kind
    on top of them: that tells them apart, without a tolerance. Where all cells are negative, all
    are numbered the other way round.

    Parameters
    ----------
    points
        Positions [m], shape [point_count, D].
    blocks
        Kinds of cells, as meshio names them, and their nodes.

    Raises
    ------
    Refused
        Cells are flat or inside out, whichever way they are numbered.
    """
    turned, bad = [], []
    upright_blocks: Blocks = []
    for name, nodes in blocks:
        kind = KINDS[name]
        wrong = np.flatnonzero(smallest_corner(kind, points, nodes) <= 0.0)
        mirrored = nodes[wrong][:, kind.mirror]
        sound = smallest_corner(kind, points, mirrored) > 0.0
        mine = nodes.copy()
        mine[wrong[sound]] = mirrored[sound]
        upright_blocks.append((name, mine))
        turned.append(_mask(len(nodes), wrong[sound]))
        bad.append(_mask(len(nodes), wrong[~sound]))
    some = any(block.any() for block in turned) and not all(block.all() for block in turned)
    if some:
        bad = [b | o for b, o in zip(bad, _on_top(upright_blocks, turned), strict=True)]
    if any(block.any() for block in bad):
        raise Refused(f"{_which(blocks, bad)} are inverted or flat; repair the mesh")
    number = sum(int(block.sum()) for block in turned)
    return Upright(upright_blocks, number, _which(blocks, turned) if number else "")


def _mask(length: int, members: Indices) -> NDArray[np.bool_]:
    mask = np.zeros(length, dtype=bool)
    mask[members] = True
    return mask


def _on_top(blocks: Blocks, turned: list[NDArray[np.bool_]]) -> list[NDArray[np.bool_]]:
    """Return which of the turned cells lie on the same side of one of their sides as a neighbour.

    Two cells on either side of a side run around it in opposite senses, if both are upright.
    """
    starts = np.cumsum([0, *(len(nodes) for _, nodes in blocks)])
    by_corners: dict[int, list[tuple[Indices, Indices]]] = {}
    for (name, nodes), start in zip(blocks, starts, strict=False):
        for side in KINDS[name].sides:
            owners = np.arange(start, start + len(nodes))
            by_corners.setdefault(len(side), []).append((nodes[:, side], owners))
    on_top = np.zeros(starts[-1], dtype=bool)
    for sides in by_corners.values():
        walk = np.concatenate([nodes for nodes, _ in sides])
        owner = np.concatenate([owners for _, owners in sides])
        _, number = np.unique(np.sort(walk, axis=1), axis=0, return_inverse=True)
        number = number.reshape(-1)
        number_and_sense = 2 * number + _sense(walk)
        again = np.bincount(number_and_sense, minlength=2 * number.max() + 2) > 1
        on_top[owner[again[number_and_sense]]] = True
    of_block = np.split(on_top, starts[1:-1])
    return [top & mine for top, mine in zip(of_block, turned, strict=True)]


def _sense(walk: Indices) -> Indices:
    """Return 0 or 1 for each side: which way a walk around it goes, wherever it begins."""
    if walk.shape[1] == 2:
        return np.asarray(walk[:, 0] < walk[:, 1], dtype=np.int64)
    rows, first = np.arange(len(walk)), np.argmin(walk, axis=1)
    after = walk[rows, (first + 1) % walk.shape[1]]
    return np.asarray(after < walk[rows, first - 1], dtype=np.int64)


def _which(blocks: Blocks, mask: list[NDArray[np.bool_]]) -> str:
    """Return how many cells are meant, and the first of them, as a message says it."""
    total = sum(len(nodes) for _, nodes in blocks)
    which = "; ".join(
        f"{KINDS[kind].name} {first_few(np.flatnonzero(block))}"
        for (kind, _), block in zip(blocks, mask, strict=True)
        if block.any()
    )
    number = sum(int(block.sum()) for block in mask)
    return f"{number:,} of {count(total, 'cell')} ({which} from 0 in their order in the file)"
