"""What a results directory holds, whole or in part."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from carom.case.scenario import Scenario
from carom.errors import InputError
from carom.io import layout
from carom.io.frames import Frames
from carom.io.history import read_history
from carom.io.ledger import read_ledger
from carom.io.summary import read_summary
from carom.modes.energies import ModalEnergies
from carom.modes.table import read_modes
from carom.results.result import read_case

Columns = dict[str, NDArray[np.float64]]

Read = TypeVar("Read")

UNFINISHED = "unfinished"
"""Status of a run that has not written its summary: it goes on, or was killed."""


@dataclass(frozen=True)
class Source:
    """What was found; what was not is None or empty.

    Parameters
    ----------
    directory
        Where.
    summary
        What ``summary.json`` says.
    history, ledger
        Columns by title; those of the ledger for every body and pair.
    modes
        Energies of the bodies by their modes.
    frames, surface
        Fields in the bodies and on their boundaries.
    case_text, scenario
        The case as text, and as this version reads it.
    notes
        What could not be read, in sentences.
    """

    directory: Path
    summary: dict[str, Any] = field(default_factory=dict)
    history: Columns = field(default_factory=dict)
    ledger: dict[str, Columns] = field(default_factory=dict)
    modes: dict[str, ModalEnergies] = field(default_factory=dict)
    frames: Frames | None = None
    surface: Frames | None = None
    case_text: str | None = None
    scenario: Scenario | None = None
    notes: tuple[str, ...] = ()

    @property
    def status(self) -> str:
        """How the run ended."""
        return str(self.summary.get("status", UNFINISHED))

    @property
    def title(self) -> str:
        """Title of the case, or else the name of the directory."""
        title = self.summary.get("title") or (self.scenario.title if self.scenario else "")
        return str(title or self.directory.resolve().name)


def read_source(directory: Path) -> Source:
    """Read what there is.

    Raises
    ------
    InputError
        There is nothing that a run has written.
    """
    found = [
        name
        for name in (layout.SUMMARY, layout.HISTORY, layout.FIELDS)
        if (directory / name).is_file()
    ]
    if not found:
        raise InputError(
            f"{directory}: has no {layout.SUMMARY}, {layout.HISTORY} or {layout.FIELDS}; "
            "name a results directory of `carom run` or a study of `carom sweep`"
        )
    notes: list[str] = []
    if layout.SUMMARY not in found:
        notes.append(
            f"There is no {layout.SUMMARY}: the run goes on, or was killed before its end."
        )

    def read(name: str, reader: Callable[[Path], Read]) -> Read | None:
        return _read(directory / name, reader, notes)

    return Source(
        directory=directory,
        summary=read(layout.SUMMARY, read_summary) or {},
        history=read(layout.HISTORY, read_history) or {},
        ledger=read(layout.LEDGER, read_ledger) or {},
        modes=read(layout.MODES, read_modes) or {},
        frames=read(layout.FIELDS, Frames),
        surface=read(layout.SURFACE, Frames),
        case_text=read(layout.CASE, lambda path: path.read_text(encoding="utf-8")),
        scenario=read(layout.CASE, lambda path: read_case(path.parent)),
        notes=tuple(dict.fromkeys(notes)),
    )


def _read(path: Path, reader: Callable[[Path], Read], notes: list[str]) -> Read | None:
    """Read a file if it is there; note what is wrong with it."""
    if not path.is_file():
        return None
    try:
        return reader(path)
    except InputError as error:
        notes.append(f"{error}.")
    except (json.JSONDecodeError, KeyError, OSError, TypeError, ValueError) as error:
        notes.append(f"{path}: cannot be read: {error}.")
    return None
