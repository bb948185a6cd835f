"""The bodies over time as the page draws them: faces, displacements, and fields for colours."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.io.frames import Frames
from carom.report.codec import Packed, pack, pack_quantised, size, unpack
from carom.view.colouring import Colouring, colourings
from carom.view.fields import TITLES, UNITS
from carom.view.outline import Outline, outline

BUDGET = 9_000_000
"""Characters that the fields may take in the page."""

READ_BUDGET = 20_000_000
"""Values over time that are held in memory at once, at most."""

ORDER = ("von-mises", "displacement", "velocity", "energy_density", "strain", "plastic_strain")
"""What comes first in the list."""

_VECTORS = ("displacement", "reaction")


@dataclass(frozen=True)
class _Channel:
    """One array over time that goes into the page.

    Parameters
    ----------
    key
        What it is called there.
    place
        ``points``, ``faces`` or ``rim``: what it has a row for.
    field
        What the page says about it; None for the vectors.
    rows
        The values of a frame, shape [row_count, component_count].
    """

    key: str
    place: str
    field: dict[str, Any] | None
    rows: Callable[[int], NDArray[np.float64]]


@dataclass(frozen=True)
class Bodies:
    """What the page needs to draw the bodies.

    Parameters
    ----------
    data
        Plain data for JSON.
    frames
        Numbers of the frames that were taken.
    recorded
        Frames that the run has recorded.
    low, high
        Corners of the box around the bodies in all these frames [m], shape [D].
    """

    data: dict[str, Any]
    frames: NDArray[np.int64]
    recorded: int
    low: NDArray[np.float64]
    high: NDArray[np.float64]


def bodies(
    frames: Frames,
    surface: Frames | None,
    *,
    budget: int = BUDGET,
    most_fields: int | None = None,
) -> Bodies:
    """Return the bodies with as many evenly spaced frames as the budget allows, two at least.

    Parameters
    ----------
    frames, surface
        Fields in the bodies and on their boundaries.
    budget
        Characters that the fields may take in the page.
    most_fields
        How many there may be for colours, the first of the list; all if not given.
    """
    seen = outline(frames, surface)
    vectors, colours = _vectors(frames, seen), _colours(frames, surface, seen)
    channels = [*vectors, *islice(colours, most_fields)]
    recorded = len(frames.times)
    values_per_frame = max(len(seen.points), len(seen.cell)) * seen.dimension
    stride = max(1, math.ceil(recorded * values_per_frame / READ_BUDGET))
    while True:
        taken = _every(recorded, stride)
        packed = {channel.key: _packed(channel, taken) for channel in channels}
        total = sum(size(array) for array in packed.values())
        if total <= budget or len(taken) <= 2:
            break
        stride = max(stride + 1, math.ceil(stride * total / budget))
    return _assembled(frames, seen, channels, packed, taken)


def _every(count: int, stride: int) -> NDArray[np.int64]:
    """Return evenly spaced numbers of frames with the first and the last."""
    intervals = max(1, (count - 1) // stride) if count > 1 else 0
    return np.unique(np.rint(np.linspace(0, count - 1, intervals + 1)).astype(np.int64))


def _vectors(frames: Frames, seen: Outline) -> Iterator[_Channel]:
    for name in _VECTORS:
        if name in frames.names:
            yield _Channel(name, "points", None, _vector(frames, name, seen))


def _colours(frames: Frames, surface: Frames | None, seen: Outline) -> Iterator[_Channel]:
    made = colourings(frames, surface, seen)
    for name in sorted(made, key=_place_in_list):
        if name not in _VECTORS:  # of which the page takes the length
            yield _scalar(made[name])


def _place_in_list(name: str) -> int:
    return ORDER.index(name) if name in ORDER else len(ORDER)


def _described(name: str, place: str) -> dict[str, Any]:
    return {
        "key": name,
        "place": place,
        "title": TITLES.get(name, name),
        "unit": UNITS.get(name, ""),
    }


def _vector(frames: Frames, name: str, seen: Outline) -> Callable[[int], NDArray[np.float64]]:
    return lambda frame: frames.field(name, frame)[seen.points, : seen.dimension]


def _scalar(colouring: Colouring) -> _Channel:
    name, place = colouring.name, colouring.place
    return _Channel(
        name,
        place,
        _described(name, place),
        lambda frame: colouring.rows(frame).reshape(-1, 1),
    )


def _packed(channel: _Channel, taken: NDArray[np.int64]) -> Packed:
    return pack_quantised(
        np.stack([channel.rows(int(frame)) for frame in taken]).astype(np.float32)
    )


def _assembled(
    frames: Frames,
    seen: Outline,
    channels: list[_Channel],
    packed: dict[str, Packed],
    taken: NDArray[np.int64],
) -> Bodies:
    points = frames.points[seen.points, : seen.dimension]
    fields = [
        _described(name, "points") for name in _VECTORS if name in packed and _varies(packed[name])
    ]
    fields += [c.field for c in channels if c.field is not None and _varies(packed[c.key])]
    # Where nothing moves there is still a picture: of a displacement that is zero.
    fields = fields or [_described("displacement", "points")]
    fields.sort(key=lambda field: _place_in_list(field["key"]))
    wanted = {*_VECTORS, *(field["key"] for field in fields)}
    data = {
        "dimension": seen.dimension,
        "times": pack(frames.times[taken], "f8"),
        "points": pack(points, "f4"),
        "triangles": pack(seen.triangles, "u4"),
        "face": pack(seen.face, "u4"),
        "body": pack(seen.body, "u4"),
        "edges": pack(seen.edges, "u4"),
        "rim": pack(seen.rim, "u4"),
        "fields": fields,
        "arrays": {key: array for key, array in packed.items() if key in wanted},
    }
    low, high = _corners(points, packed["displacement"])
    return Bodies(data, taken, len(frames.times), low, high)


def _varies(packed: Packed) -> bool:
    """Whether an array has anything but zeros."""
    return any(packed["low"]) or any(packed["step"])


def _corners(
    points: NDArray[np.float64], displacement: Packed
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the corners of the box in which the points stay."""
    places = points + np.nan_to_num(unpack(displacement))
    return places.min(axis=(0, 1)), places.max(axis=(0, 1))
