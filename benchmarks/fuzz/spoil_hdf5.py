"""Spoiling what is in an HDF5 file, not its bytes."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

Values = NDArray[Any]

NUMBERS = (0.0, -0.0, 1.0, -1.0, 3.0, 0.5, 1e-300, 1e300, -1e300, np.nan, np.inf, -np.inf, 2.0**53)

INTEGERS = (0, 1, 2, 7, 255, 2**31, 2**32 - 1, 2**32, 2**63 - 1, 2**63, 2**64 - 1)

TYPES = ("float32", "float64", "int8", "int64", "uint64", "bool", "S3")


def spoilt_content(file: h5py.File, pick: random.Random) -> None:
    """Spoil one or two things in an open file."""
    for _ in range(pick.choice((1, 1, 2))):
        names: list[str] = []
        file.visit(names.append)
        if not names:
            return
        name = pick.choice(sorted(names))
        entry = file[name]
        if len(entry.attrs) and pick.random() < 0.3:
            _spoil_attribute(entry, pick)
        elif isinstance(entry, h5py.Dataset) and pick.random() < 0.8:
            values = pick.choice(_CHANGES)(np.asarray(entry[()]), pick)
            attributes = dict(entry.attrs)
            del file[name]
            file[name] = values
            file[name].attrs.update(attributes)
        else:
            _misplace(file, name, pick)


def _spoil_attribute(entry: h5py.HLObject, pick: random.Random) -> None:
    name = pick.choice(sorted(entry.attrs))
    if pick.random() < 0.3:
        del entry.attrs[name]
    else:
        entry.attrs[name] = pick.choice((*NUMBERS, "x", b"\xff\xfe", [1, 2, 3], -1, 10**6))


def _misplace(file: h5py.File, name: str, pick: random.Random) -> None:
    entry = file[name]
    match pick.randrange(4):
        case 0:
            del file[name]
        case 1:
            file.move(name, f"{name}-x")
        case 2:
            was_group = isinstance(entry, h5py.Group)
            del file[name]
            if was_group:
                file[name] = np.arange(3.0)
            else:
                file.create_group(name)
        case 3:
            file[f"{name}-more"] = np.arange(3.0)


def _other_type(values: Values, pick: random.Random) -> Values:
    with np.errstate(all="ignore"):
        return values.astype(pick.choice(TYPES))


def _other_shape(values: Values, pick: random.Random) -> Values:
    flat = values.reshape(-1)
    match pick.randrange(6):
        case 0:
            return flat[:-1]
        case 1:
            return np.concatenate([flat, flat[:1]])
        case 2:
            return values[np.newaxis]
        case 3:
            return flat[:0]
        case 4:
            return flat[0] if len(flat) else np.float64(1.0)
        case _:
            return np.concatenate([flat, flat])


def _other_values(values: Values, pick: random.Random) -> Values:
    """Return the values with one of them, or all, another one."""
    spoilt = np.array(values)
    flat = spoilt.reshape(-1)
    if not len(flat):
        return spoilt
    at = pick.choice((slice(None), pick.randrange(len(flat))))
    if np.issubdtype(spoilt.dtype, np.floating):
        flat[at] = pick.choice(NUMBERS)
    elif np.issubdtype(spoilt.dtype, np.integer):
        limits = np.iinfo(spoilt.dtype)
        flat[at] = min(max(pick.choice(INTEGERS), limits.min), limits.max)
    return spoilt


def _scaled_values(values: Values, pick: random.Random) -> Values:
    if not np.issubdtype(values.dtype, np.floating):
        return _other_values(values, pick)
    return values * pick.choice((-1.0, 1e-9, 0.5, 2.0, 1e9))


_CHANGES: tuple[Callable[[Values, random.Random], Values], ...] = (
    *(_other_type, _other_shape, _other_values, _other_values, _scaled_values),
)
