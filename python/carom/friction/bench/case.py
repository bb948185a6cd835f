"""The problems of a folder."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path

from carom.errors import InputError
from carom.friction.files import FCLIB_SUFFIXES, TEXT_SUFFIXES, read
from carom.friction.global_problem import GlobalProblem
from carom.friction.problem import Problem
from carom.friction.symmetry import AsymmetryWarning


@dataclass(frozen=True)
class Case:
    """A problem that every solver gets in the same form.

    Parameters
    ----------
    name
        Path of the file in its folder.
    problem
        The problem in local form, symmetrised as `Problem` does it; global ones are condensed,
        which is not timed for anybody.
    """

    name: str
    problem: Problem


def read_cases(folder: Path) -> tuple[list[Case], dict[str, str]]:
    """Return the problems in a folder and below it, and why files are not among them, by name.

    Raises
    ------
    InputError
        If there is no problem at all.
    """
    if not folder.is_dir():
        raise InputError(f"{folder}: is no folder")
    cases, refused = [], {}
    suffixes = {*FCLIB_SUFFIXES, *TEXT_SUFFIXES}
    for path in sorted(path for path in folder.rglob("*") if path.suffix in suffixes):
        name = path.relative_to(folder).as_posix()
        try:
            cases.append(Case(name, _local(path)))
        except InputError as error:
            refused[name] = str(error).removeprefix(f"{path}: ")
    if not cases:
        raise InputError(f"{folder}: has no contact problem ({', '.join(sorted(suffixes))})")
    return cases, refused


def _local(path: Path) -> Problem:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AsymmetryWarning)
        problem = read(path)
    if isinstance(problem, GlobalProblem):
        return problem.condense()
    # Here, and not in the middle of a comparison, where a solver gives up.
    problem.refuse_if_indefinite()
    return problem
