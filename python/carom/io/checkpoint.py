"""``checkpoint.h5``: all that it takes to go on with a run, and the one before it.

The file is HDF5 behind a block of text that has its schema, its length and its SHA-256. What is
truncated or has a flipped bit is found before the HDF5 library looks at it.
"""

from __future__ import annotations

import hashlib
import io
import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray
from typing_extensions import NotRequired, TypedDict

from carom._carom import CHECKPOINT_SCHEMA, __version__
from carom.errors import InputError
from carom.io import layout
from carom.io.atomic import write_whole
from carom.io.form import misfit
from carom.io.summary_types import WarningSummary

_BLOCK = 512
"""Size of the text in front of the HDF5 file: the smallest that HDF5 allows [bytes]."""

_MAGIC = "carom checkpoint"


class _Record(TypedDict):
    """How far the files of a run had come."""

    history: int
    ledger: int
    frames: int
    steps: int
    last_frame: float | None
    frames_due: int
    wall: float
    warnings: NotRequired[list[WarningSummary]]


class _Texts(TypedDict):
    """What is in a checkpoint beside arrays."""

    case: dict[str, object]
    record: _Record


class DamagedError(Exception):
    """A checkpoint that is not as it was written."""


@dataclass(frozen=True)
class Checkpoint:
    """A run at one moment.

    Parameters
    ----------
    case
        What is run, see `carom.running.restart.identity`.
    record
        How far its files had come, see `carom.running.recorder.Recorder`.
    arrays
        What the native simulation needs, by name.
    """

    case: dict[str, Any]
    record: dict[str, Any]
    arrays: dict[str, NDArray[Any]]

    @property
    def time(self) -> float:
        """Time of the run [s]."""
        return float(self.arrays["state/time"][0])


def write_checkpoint(directory: Path, checkpoint: Checkpoint) -> None:
    """Write a checkpoint in place of the last one, which stays as the one before.

    Raises
    ------
    OSError
        It could not be written; the ones that are there are as they were.
    """
    latest = directory / layout.CHECKPOINT
    fresh = directory / layout.FRESH_CHECKPOINT
    write_whole(fresh, _packed(checkpoint), durable=True)
    if latest.exists():
        latest.replace(directory / layout.PREVIOUS_CHECKPOINT)
    fresh.replace(latest)


def write_end_state(directory: Path, checkpoint: Checkpoint) -> None:
    """Write the state of a checkpoint, and nothing of what only a run that goes on needs."""
    arrays = {
        name: values
        for name, values in checkpoint.arrays.items()
        if name == "schema" or name.startswith("state/")
    }
    write_whole(directory / layout.END_STATE, _packed(replace(checkpoint, arrays=arrays)))


def read_checkpoint(path: Path) -> Checkpoint:
    """Read a checkpoint.

    Raises
    ------
    FileNotFoundError
        There is none.
    DamagedError
        It is not as it was written.
    InputError
        It is of another version of carom.
    """
    return _unpacked(path.read_bytes(), path)


def _packed(checkpoint: Checkpoint) -> bytes:
    buffer = io.BytesIO()
    with h5py.File(buffer, "w", userblock_size=_BLOCK) as file:
        file.attrs["version"] = __version__
        for name in ("case", "record"):
            value = json.dumps(getattr(checkpoint, name)).encode()
            file[name] = np.frombuffer(value, dtype=np.uint8)
        for name, values in checkpoint.arrays.items():
            file[f"simulation/{name}"] = values
    return signed(buffer.getvalue())


def signed(content: bytes) -> bytes:
    """Return an HDF5 file with the text in front of it that fits what is behind."""
    data = content[_BLOCK:]
    return _block(len(data), hashlib.sha256(data).hexdigest()) + data


def _block(length: int, digest: str) -> bytes:
    text = f"{_MAGIC} {CHECKPOINT_SCHEMA} {length} {digest}\n"
    return text.encode().ljust(_BLOCK, b"\0")


def _unpacked(content: bytes, path: Path) -> Checkpoint:
    words = content[:_BLOCK].rstrip(b"\0").decode("ascii", errors="replace").split()
    data = content[_BLOCK:]
    if len(words) != 5 or " ".join(words[:2]) != _MAGIC:
        raise DamagedError(f"{path} is not a checkpoint")
    _, _, schema, length, digest = words
    if length != str(len(data)):
        raise DamagedError(f"{path} has {len(data)} bytes of {length}")
    if hashlib.sha256(data).hexdigest() != digest:
        raise DamagedError(f"{path} is damaged: its checksum is another")
    if schema != str(CHECKPOINT_SCHEMA):
        raise InputError(
            f"{path}: has schema {schema}, this version reads {CHECKPOINT_SCHEMA}; go on with the "
            "version that wrote it, or start again with --force"
        )
    if content[:_BLOCK] != _block(len(data), digest):
        raise DamagedError(f"{path} is damaged: its first line is another")
    try:
        with h5py.File(io.BytesIO(content), "r") as file:
            version = str(file.attrs["version"])
            case, record = (json.loads(file[name][()].tobytes()) for name in ("case", "record"))
            arrays = _arrays(file["simulation"])
    except (AttributeError, KeyError, OSError, TypeError, ValueError) as error:
        raise DamagedError(f"{path} does not hold what a checkpoint has: {error}") from error
    if version != __version__:
        raise InputError(
            f"{path}: was written by carom {version}, this is {__version__}, whose numbers may "
            "differ; go on with that version, or start again with --force"
        )
    if wrong := misfit({"case": case, "record": record}, _Texts):
        raise DamagedError(f"{path} does not hold what a checkpoint has: {wrong}")
    return Checkpoint(case=case, record=record, arrays=arrays)


def _arrays(group: h5py.Group) -> dict[str, NDArray[Any]]:
    """Read all that is in a group, by names with slashes."""
    arrays: dict[str, NDArray[Any]] = {}

    def collect(name: str, entry: object) -> None:
        if isinstance(entry, h5py.Dataset):
            arrays[name] = entry[()]

    group.visititems(collect)
    return arrays
