"""``audit.h5``: the last step before each output time as its two states, for `carom.audit`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError

SCHEMA = 2
"""Version of the layout; a reader refuses others."""

_ENDS = ("start", "end")


class AuditWriter:
    """Writes pairs of consecutive states.

    The file is closed between steps, so it can be opened during the run and after a crash.

    Parameters
    ----------
    path
        File to write.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        with h5py.File(path, "w") as file:
            file.attrs["schema"] = SCHEMA
            file.create_group("steps")

    def append(self, step: Mapping[str, Any]) -> None:
        """Add a step.

        Parameters
        ----------
        step
            What `carom.Simulation.last_step` gives: ``start`` and ``end``, mappings of the time
            [s] and arrays; ``blend``, shape [body_count]; ``ledger``, energies by name [J].
        """
        with h5py.File(self._path, "r+") as file:
            steps = file["steps"]
            # Under another name until it is whole.
            group = steps.create_group("unfinished")
            for end in _ENDS:
                state = group.create_group(end)
                for name, value in step[end].items():
                    if name == "time":
                        state.attrs["time"] = value
                    else:
                        state[name] = value
            group["blend"] = step["blend"]
            group.create_group("ledger").attrs.update(step["ledger"])
            steps.move("unfinished", f"{len(steps) - 1:06d}")


def read_steps(path: Path) -> Iterator[dict[str, Any]]:
    """Yield the steps of a file as they were appended.

    Raises
    ------
    InputError
        The file is not of `AuditWriter`, or of another version of it.
    """
    try:
        with h5py.File(path, "r") as file:
            if file.attrs.get("schema") != SCHEMA:
                raise InputError(
                    f"{path}: has schema {file.attrs.get('schema')}, this version reads {SCHEMA}"
                )
            for name in sorted(file["steps"]):
                if name != "unfinished":
                    yield _step(file["steps"][name])
    except (OSError, KeyError) as error:
        raise InputError(f"{path}: not steps of carom: {error}") from error


def _step(group: h5py.Group) -> dict[str, Any]:
    step: dict[str, Any] = {end: _state(group[end]) for end in _ENDS}
    step["blend"] = group["blend"][:]
    step["ledger"] = {name: float(energy) for name, energy in group["ledger"].attrs.items()}
    return step


def _state(group: h5py.Group) -> dict[str, Any]:
    arrays: dict[str, NDArray[np.generic]] = {name: group[name][:] for name in group}
    return {"time": float(group.attrs["time"]), **arrays}
