"""What is spoilt, and what each is handed to."""

from __future__ import annotations

import random
from abc import ABC, abstractmethod
from copy import deepcopy
from functools import cached_property
from pathlib import Path

import tomlkit

from fuzz import seeds
from fuzz.attempt import build_mesh, run_case, solve_problem
from fuzz.mutate import spoilt_bytes, spoilt_data


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
    def spoilt(self, seed: int) -> Path:
        """Write the spoilt file of a seed."""

    @abstractmethod
    def answer(self, file: Path) -> str:
        """Do with a file what the commands do; return what it was taken for."""


class CaseTables(Subject):
    """Case files whose tables and values are spoilt."""

    @cached_property
    def _seeds(self) -> list[dict]:
        return seeds.case_data(self.folder)

    def spoilt(self, seed: int) -> Path:  # noqa: D102 (as the base says)
        pick = random.Random(seed)
        data = deepcopy(pick.choice(self._seeds))
        spoilt_data(data, pick)
        file = self.folder / "case.toml"
        file.write_text(tomlkit.dumps(data), encoding="utf-8")
        return file

    def answer(self, file: Path) -> str:  # noqa: D102 (as the base says)
        return run_case(file)


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

    def answer(self, file: Path) -> str:  # noqa: D102 (as the base says)
        return run_case(file)


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

    def answer(self, file: Path) -> str:  # noqa: D102 (as the base says)
        return build_mesh(file)


class Problems(_Files):
    """Contact problems: FCLIB and text files."""

    def _written(self, folder: Path) -> list[Path]:
        return seeds.problems(folder)

    def answer(self, file: Path) -> str:  # noqa: D102 (as the base says)
        return solve_problem(file)


SUBJECTS: dict[str, type[Subject]] = {
    "tables of cases": CaseTables,
    "text of cases": CaseText,
    "meshes": Meshes,
    "contact problems": Problems,
}
