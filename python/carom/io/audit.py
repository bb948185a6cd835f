"""``audit.h5``: the last step before each output time as its two states, for `carom.audit`."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError
from carom.io.atomic import write_whole
from carom.io.damage import DAMAGE
from carom.io.journal import changed, going_on, shorter

SCHEMA = 6
"""Version of the layout; a reader refuses others."""

_ENDS = ("start", "end")
_ARRAYS = ("blend", "vibration", "landing", "settling")


class AuditWriter:
    """Writes pairs of consecutive states.

    The file is closed in between, so it can be opened during the run and after a crash.

    Parameters
    ----------
    path
        File to write.
    steps
        Steps of a file that is there and goes on; what it has beyond these is dropped. None starts
        a new one.
    """

    def __init__(self, path: Path, *, steps: int | None = None) -> None:
        self._path = path
        if steps is not None:
            self._cut(steps)
            return
        content = io.BytesIO()
        with h5py.File(content, "w") as file:
            file.attrs["schema"] = SCHEMA
            file.create_group("steps")
        write_whole(path, content.getvalue())

    def _cut(self, steps: int) -> None:
        with going_on(self._path) as file:
            names = sorted(file["steps"])
            if len(names) < steps:
                raise shorter(self._path, len(names), steps)
            for name in names[steps:]:
                del file[f"steps/{name}"]

    def append(self, steps: Sequence[Mapping[str, Any]]) -> None:
        """Add steps.

        Parameters
        ----------
        steps
            What `carom.Simulation.last_step` gives: ``start`` and ``end``, mappings of the time
            [s] and arrays; ``blend`` and ``vibration``, shape [body_count]; ``landing`` and
            ``settling``, the parts of the reactions at the end that are impulses there [N], each
            of shape [count, D];
            ``ledger``, energies by name [J].
        """
        with changed(self._path) as file:
            there = file["steps"]
            for number, step in enumerate(steps, start=len(there)):
                _write(there.create_group(f"{number:06d}"), step)


def _write(group: h5py.Group, step: Mapping[str, Any]) -> None:
    for end in _ENDS:
        state = group.create_group(end)
        for name, value in step[end].items():
            if name == "time":
                state.attrs["time"] = value
            else:
                state[name] = value
    for name in _ARRAYS:
        group[name] = step[name]
    group.create_group("ledger").attrs.update(step["ledger"])


def read_steps(path: Path) -> Iterator[dict[str, Any]]:
    """Yield the steps of a file as they were appended.

    Raises
    ------
    InputError
        The file is not of `AuditWriter`, or of another version of it.
    """
    try:
        with h5py.File(path, "r") as file:
            schema = file.attrs.get("schema")
            if schema != SCHEMA:
                raise InputError(
                    f"{path}: has schema {schema}, this version reads {SCHEMA}; run its case again"
                )
            for name in sorted(file["steps"]):
                yield _step(file["steps"][name])
    except InputError:
        raise
    except DAMAGE as error:
        raise InputError(f"{path}: not steps of carom: {error}") from error


def _step(group: h5py.Group) -> dict[str, Any]:
    step: dict[str, Any] = {end: _state(group[end]) for end in _ENDS}
    step |= {name: group[name][:] for name in _ARRAYS}
    step["ledger"] = {name: float(energy) for name, energy in group["ledger"].attrs.items()}
    return step


def _state(group: h5py.Group) -> dict[str, Any]:
    arrays: dict[str, NDArray[np.generic]] = {name: group[name][:] for name in group}
    return {"time": float(group.attrs["time"]), **arrays}
