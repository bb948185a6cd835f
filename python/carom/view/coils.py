"""What springs and dampers look like: lines along the way from one end to the other.

A shape is given once, as pieces between points (s, a, b): s along, from 0 at one end to 1 at the
other, a and b across, in widths. Pages, pictures and films lay it between ends that move.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from carom.view.connections import Connections, Link

Array = NDArray[np.float64]

WIDTH = 0.013
"""Half the width of a coil, as a share of the picture's diagonal."""

LEAD = 0.12
"""Of the length, that is straight at either end."""

TURNS = (4, 14)
"""Of a coil: fewest and most."""

MOST_COILED = 60
"""More springs than these are straight lines: coils would take long to draw, and not be seen."""

_AROUND = 10
"""Pieces in a turn of a coil in space."""

_UPRIGHT = 0.9
"""Of the direction of a link along z, from which on another axis tells what is across."""


def coil(turns: int, dimension: int) -> Array:
    """Return a spring: a zigzag in the plane, a helix in space, shape [piece_count, 2, 3]."""
    if dimension == 2:
        steps = np.arange(2 * turns)
        across = np.where(steps % 2 == 0, 1.0, -1.0)
        inner = np.column_stack([(steps + 0.5) / len(steps), across, np.zeros(len(steps))])
    else:
        angle = np.linspace(0.0, 2.0 * np.pi * turns, _AROUND * turns + 1)
        inner = np.column_stack([angle / angle[-1], np.cos(angle), np.sin(angle)])
    inner[:, 0] = LEAD + (1.0 - 2.0 * LEAD) * inner[:, 0]
    ends = [[0.0, 0.0, 0.0], [LEAD, 0.0, 0.0]], [[1.0 - LEAD, 0.0, 0.0], [1.0, 0.0, 0.0]]
    return _pieces(np.concatenate([ends[0], inner, ends[1]]))


def dashpot(dimension: int) -> Array:
    """Return a damper: a piston in a cup that is open, shape [piece_count, 2, 3]."""
    piston = [([0.0, 0.0], [0.52, 0.0]), ([0.52, -0.75], [0.52, 0.75])]
    cup = [([0.36, 1.0], [0.64, 1.0]), ([0.64, -1.0], [0.36, -1.0]), ([0.64, -1.0], [0.64, 1.0])]
    flat = np.array([*piston, *cup, ([0.64, 0.0], [1.0, 0.0])])
    nothing = np.zeros((*flat.shape[:2], 1))
    drawn = np.concatenate([flat, nothing], axis=2)
    if dimension == 2:
        return drawn
    turned = np.concatenate([flat[..., :1], nothing, flat[..., 1:]], axis=2)
    return np.concatenate([drawn, turned[1:-1]])


def straight() -> Array:
    """Return a line from end to end, shape [1, 2, 3]."""
    return _pieces(np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]))


def shapes(attached: Connections, size: float) -> list[Array]:
    """Return the shape of every link.

    Parameters
    ----------
    attached
        The links.
    size
        The picture's diagonal [m], which the width of coils is a share of. The longer a spring is
        as it is drawn, the more turns it has; as it stretches it keeps them.
    """
    links = attached.links
    if len(links) > MOST_COILED:
        return [straight()] * len(links)
    return [_shape(link, attached.dimension, size) for link in links]


def _shape(link: Link, dimension: int, size: float) -> Array:
    if link.kind == "damper":
        made = dashpot(dimension)
    else:
        pitch = 2.2 * WIDTH * size
        wanted = round((1.0 - 2.0 * LEAD) * link.drawn_length / pitch) if size > 0.0 else 0
        made = coil(int(np.clip(wanted, *TURNS)), dimension)
    bars = [_bar(float(k), dimension) for k, end in enumerate(link.ends) if end.is_fixed]
    return np.concatenate([made, *bars])


def _bar(along: float, dimension: int) -> Array:
    """Return what tells that an end stays where it is: a bar across, in space two."""
    bars = [([along, -1.0, 0.0], [along, 1.0, 0.0]), ([along, 0.0, -1.0], [along, 0.0, 1.0])]
    return np.array(bars[: dimension - 1])


def laid(made: Sequence[Array], ends: Array, *, width: float) -> Array:
    """Return shapes between ends, shape [all pieces, 2, D] [m].

    Parameters
    ----------
    made
        The shape of every link.
    ends
        Its ends [m], shape [link_count, 2, D].
    width
        What a and b are multiplied by [m].
    """
    dimension = ends.shape[2]
    laid_out = [np.empty((0, 2, dimension))]
    for shape, (start, end) in zip(made, ends, strict=True):
        along = end - start
        first, second = _across(along)
        laid_out.append(
            start
            + shape[..., :1] * along
            + width * (shape[..., 1:2] * first + shape[..., 2:] * second)
        )
    return np.concatenate(laid_out)


def _across(along: Array) -> tuple[Array, Array]:
    """Return two directions at right angles to a link; of no length where it has none itself."""
    length = float(np.linalg.norm(along))
    if length == 0.0:
        return np.zeros_like(along), np.zeros_like(along)
    unit = along / length
    if len(along) == 2:
        return np.array([-unit[1], unit[0]]), np.zeros(2)
    helper = np.eye(3)[2 if abs(unit[2]) < _UPRIGHT else 0]
    first = np.cross(helper, unit)
    first /= np.linalg.norm(first)
    return first, np.cross(unit, first)


def _pieces(line: Array) -> Array:
    """Return a line through points as pieces from each to the next."""
    return np.asarray(np.stack([line[:-1], line[1:]], axis=1), dtype=np.float64)
