"""Arrays as text: quantised, sorted by bytes, deflated and in base64; `assets/codec.js` reads them.

A packed array is a mapping with ``kind`` (``"u4"``, ``"f4"``, ``"f8"`` as they are, or ``"q2"``,
quantised), ``shape`` and ``data``. The bytes of the numbers are stored plane by plane, all first
bytes, then all second ones, which deflates better. A ``"q2"`` array has ``low`` and ``step`` for
each component, its last axis: code c stands for low + c·step, `NOT_A_NUMBER` for what is not
finite. Along its first axis, the frames, differences of codes modulo 2¹⁶ are stored.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Packed = dict[str, Any]
"""An array as plain data for JSON."""

NOT_A_NUMBER = 0xFFFF
"""Code of a value that is not finite."""

_LARGEST = NOT_A_NUMBER - 1
_LEVEL = 6


def pack(array: NDArray[Any], kind: str) -> Packed:
    """Pack an array as it is, as ``"u4"``, ``"f4"`` or ``"f8"``."""
    return _packed(np.asarray(array).astype(f"<{kind}"), kind)


def pack_quantised(values: NDArray[np.floating[Any]]) -> Packed:
    """Pack values over time with 16 bits each, in equal parts of the range of each component.

    Parameters
    ----------
    values
        Shape [frame_count, row_count, component_count].
    """
    finite = np.isfinite(values)
    known = np.where(finite, values, np.nan)
    components = values.shape[-1]
    low, step = np.zeros(components), np.zeros(components)
    for index in range(components):
        column = known[..., index]
        if np.isfinite(column).any():
            low[index] = np.nanmin(column)
            step[index] = (np.nanmax(column) - low[index]) / _LARGEST
    with np.errstate(invalid="ignore"):
        codes = np.rint((known - low) / np.where(step > 0.0, step, 1.0))
    codes = np.where(finite, codes, NOT_A_NUMBER).astype(np.uint16)
    changes = codes.copy()
    changes[1:] -= codes[:-1]
    return {**_packed(changes.astype("<u2"), "q2"), "low": low.tolist(), "step": step.tolist()}


def unpack(packed: Mapping[str, Any]) -> NDArray[Any]:
    """Return the array that was packed; quantised values to within half a step."""
    kind, shape = packed["kind"], packed["shape"]
    dtype = np.dtype("<u2" if kind == "q2" else f"<{kind}")
    data = zlib.decompress(base64.b64decode(packed["data"]))
    planes = np.frombuffer(data, dtype=np.uint8).reshape(dtype.itemsize, -1)
    array: NDArray[Any] = np.ascontiguousarray(planes.T).view(dtype).reshape(shape)
    if kind != "q2":
        return array
    codes = np.cumsum(array, axis=0, dtype=np.uint16)
    values = np.array(packed["low"]) + codes * np.array(packed["step"])
    return np.where(codes == NOT_A_NUMBER, np.nan, values)


def size(packed: Mapping[str, Any]) -> int:
    """Return how many characters a packed array takes."""
    return len(packed["data"])


def _packed(array: NDArray[Any], kind: str) -> Packed:
    flat = np.ascontiguousarray(array).reshape(-1)
    planes = flat.view(np.uint8).reshape(-1, array.itemsize).T
    data = zlib.compress(np.ascontiguousarray(planes).tobytes(), _LEVEL)
    return {"kind": kind, "shape": list(array.shape), "data": base64.b64encode(data).decode()}
