"""What is spoilt, and what each is handed to."""

from __future__ import annotations

import io
import json
import random
import shutil
from abc import ABC, abstractmethod
from copy import deepcopy
from functools import cached_property
from pathlib import Path
from typing import Any

import h5py

from carom.io import layout
from carom.io.checkpoint import signed
from fuzz import seeds
from fuzz.attempt import (
    READERS,
    build_mesh,
    read_results,
    resume,
    run_case,
    run_tables,
    solve_problem,
)
from fuzz.mutate import spoilt_bytes, spoilt_data
from fuzz.spoil_hdf5 import spoilt_content


class Subject(ABC):
    """A kind of input.

    Parameters
    ----------
    folder
        Where files are written.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    @abstractmethod
    def spoilt(self, seed: int) -> Any:
        """Return the spoilt input of a seed: tables, or a file that is written."""

    @abstractmethod
    def answer(self, given: Any) -> str:
        """Do with it what the commands do; return what it was taken for."""


class CaseTables(Subject):
    """Case files whose tables and values are spoilt."""

    @cached_property
    def _seeds(self) -> list[dict]:
        return seeds.case_data(self.folder)

    def spoilt(self, seed: int) -> dict[str, Any]:  # noqa: D102 (as the base says)
        pick = random.Random(seed)
        data = deepcopy(pick.choice(self._seeds))
        spoilt_data(data, pick)
        return data

    def answer(self, given: dict[str, Any]) -> str:  # noqa: D102 (as the base says)
        return run_tables(given)


class CaseText(Subject):
    """Case files whose bytes are spoilt."""

    @cached_property
    def _seeds(self) -> list[bytes]:
        return seeds.cases(self.folder)

    def spoilt(self, seed: int) -> Path:  # noqa: D102 (as the base says)
        pick = random.Random(seed)
        file = self.folder / "case.toml"
        file.write_bytes(spoilt_bytes(pick.choice(self._seeds), pick))
        return file

    def answer(self, given: Path) -> str:  # noqa: D102 (as the base says)
        return run_case(given)


class _Files(Subject):
    @cached_property
    def _seeds(self) -> list[tuple[str, bytes]]:
        origins = self.folder / "valid"
        origins.mkdir(exist_ok=True)
        return [(file.name, file.read_bytes()) for file in self._written(origins)]

    @abstractmethod
    def _written(self, folder: Path) -> list[Path]:
        """Write the valid files."""

    def spoilt(self, seed: int) -> Path:
        pick = random.Random(seed)
        name, content = pick.choice(self._seeds)
        file = self.folder / name
        file.write_bytes(spoilt_bytes(content, pick))
        return file


class Meshes(_Files):
    """Mesh files and surfaces."""

    def _written(self, folder: Path) -> list[Path]:
        return seeds.meshes(folder)

    def answer(self, given: Path) -> str:  # noqa: D102 (as the base says)
        return build_mesh(given)


class Problems(_Files):
    """Contact problems: FCLIB and text files."""

    def _written(self, folder: Path) -> list[Path]:
        return seeds.problems(folder)

    def answer(self, given: Path) -> str:  # noqa: D102 (as the base says)
        return solve_problem(given)


class Checkpoints(Subject):
    """Checkpoints: their bytes, and what is in them behind a checksum that is right."""

    @cached_property
    def _seed(self) -> Path:
        return seeds.stopped(self.folder)

    def spoilt(self, seed: int) -> Path:  # noqa: D102 (as the base says)
        pick = random.Random(seed)
        directory = _copied(self._seed, self.folder / "run")
        file = directory / layout.CHECKPOINT
        content = file.read_bytes()
        if pick.random() < 0.3:
            file.write_bytes(spoilt_bytes(content, pick))
        else:
            file.write_bytes(signed(_with_spoilt_content(content, pick)))
        return directory

    def answer(self, given: Path) -> str:  # noqa: D102 (as the base says)
        return resume(given)


class Results(Subject):
    """The files of results, for all that reads them."""

    @cached_property
    def _seed(self) -> Path:
        return seeds.finished(self.folder)

    def spoilt(self, seed: int) -> tuple[str, Path]:  # noqa: D102 (as the base says)
        pick = random.Random(seed)
        directory = _copied(self._seed, self.folder / "read")
        names = sorted(file.name for file in directory.iterdir() if file.suffix != ".png")
        # Each once: what has been spoilt can no longer be spoilt by its meaning.
        for name in pick.sample(names, pick.choice((1, 1, 2))):
            _spoil_file(directory / name, pick)
        return pick.choice(sorted(READERS)), directory

    def answer(self, given: tuple[str, Path]) -> str:  # noqa: D102 (as the base says)
        return read_results(given)


def _copied(directory: Path, to: Path) -> Path:
    shutil.rmtree(to, ignore_errors=True)
    return shutil.copytree(directory, to)


def _spoil_file(file: Path, pick: random.Random) -> None:
    """Spoil a file of results, by its meaning where it has one."""
    if pick.random() < 0.1:
        file.unlink(missing_ok=True)
        return
    if not file.exists():
        return
    content = file.read_bytes()
    if pick.random() < 0.5 or file.suffix not in (".json", ".vtkhdf", ".h5"):
        file.write_bytes(spoilt_bytes(content, pick))
    elif file.suffix == ".json":
        data = json.loads(content)
        spoilt_data(data, pick)
        file.write_text(json.dumps(data, default=str), encoding="utf-8")
    else:
        file.write_bytes(_with_spoilt_content(content, pick))


def _with_spoilt_content(content: bytes, pick: random.Random) -> bytes:
    buffer = io.BytesIO(content)
    with h5py.File(buffer, "r+") as file:
        spoilt_content(file, pick)
    return buffer.getvalue()


SUBJECTS: dict[str, type[Subject]] = {
    "tables of cases": CaseTables,
    "text of cases": CaseText,
    "meshes": Meshes,
    "contact problems": Problems,
    "checkpoints": Checkpoints,
    "results": Results,
}
