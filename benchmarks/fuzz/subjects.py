"""What is spoilt, and what each is handed to."""

from __future__ import annotations

import random
from abc import ABC, abstractmethod
from copy import deepcopy
from functools import cached_property
from pathlib import Path
from typing import Any

from fuzz import seeds
from fuzz.attempt import build_mesh, run_case, run_tables, solve_problem
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


SUBJECTS: dict[str, type[Subject]] = {
    "tables of cases": CaseTables,
    "text of cases": CaseText,
    "meshes": Meshes,
    "contact problems": Problems,
}
