"""The results of a run, read from its directory."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.typing import NDArray
from rich.table import Table
from typing_extensions import Self

from carom.case.scenario import Scenario
from carom.errors import CaromWarning, InputError
from carom.io import layout
from carom.io.frames import Frames
from carom.io.history import read_history
from carom.io.ledger import read_ledger
from carom.io.summary import read_summary
from carom.io.summary_types import Summary
from carom.results.dataframe import Table as DataTable
from carom.results.dataframe import data_frame
from carom.results.doubts import written_doubts
from carom.results.fields import Fields, parts
from carom.results.notebook import result_html
from carom.results.outcome import summary_table

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True)
class Result:
    """What a run left in its directory.

    Parameters
    ----------
    path
        The directory.
    summary
        What ``summary.json`` says.
    history
        The columns of ``history.csv`` by title, SI units, each of shape [row_count].
    """

    path: Path
    summary: Summary
    history: dict[str, NDArray[np.float64]] = field(repr=False)

    @classmethod
    def open(cls, directory: str | Path) -> Self:
        """Read the results in a directory.

        Raises
        ------
        InputError
            The directory holds no results of a run that has ended.
        """
        path = Path(directory)
        try:
            return cls(
                path=path,
                summary=cast(Summary, read_summary(path / layout.SUMMARY)),
                history=read_history(path / layout.HISTORY),
            )
        except (FileNotFoundError, NotADirectoryError) as error:
            missing = Path(error.filename).name
            raise InputError(
                f"{path}: has no {missing}; name a directory that `carom run` has finished"
            ) from error

    @property
    def fields_path(self) -> Path:
        """The fields over time, a VTKHDF file for ParaView and PyVista."""
        return self.path / layout.FIELDS

    @property
    def surface_path(self) -> Path:
        """The fields on the boundaries over time, a VTKHDF file."""
        return self.path / layout.SURFACE

    @cached_property
    def fields(self) -> Fields:
        """The fields in the bodies over time, read when they are indexed.

        Raises
        ------
        InputError
            The file is not there.
        """
        frames, scenario = Frames(self.fields_path), self.scenario
        names = [body.name for body in scenario.bodies]
        return Fields(frames, parts(frames, names), dimension=scenario.dimension)

    @cached_property
    def surface(self) -> Fields:
        """The fields on the boundaries over time, read when they are indexed.

        Raises
        ------
        InputError
            The file is not there.
        """
        bodies, surface = Frames(self.fields_path), Frames(self.surface_path)
        scenario = self.scenario
        names = [body.name for body in scenario.bodies]
        return Fields(
            surface,
            parts(bodies, names, surface=surface),
            dimension=scenario.dimension,
            cell="facet",
        )

    @property
    def warnings(self) -> tuple[CaromWarning, ...]:
        """What speaks against the results; none of runs by versions that did not write it down."""
        return tuple(doubt.as_warning() for doubt in written_doubts(self.summary))

    @property
    def ledger(self) -> dict[str, dict[str, NDArray[np.float64]]]:
        """For every body and pair that touched, its energy terms over time [J]."""
        return read_ledger(self.path / layout.LEDGER)

    @property
    def scenario(self) -> Scenario:
        """The scenario as it was run, overrides included."""
        return read_case(self.path)

    def to_pandas(self, table: DataTable = "history") -> pandas.DataFrame:
        """Return a table of the run as a data frame.

        Parameters
        ----------
        table
            ``"history"``: the columns of ``history.csv`` by time. ``"ledger"``: the energy terms of
            bodies and pairs [J] by entry and time. ``"contacts"``: the contact events with onset
            and release [s], peak force [N], friction work [J], and what the impact did: impulses
            [N s], coefficients of restitution, changes of energy [J]. ``"bodies"`` and ``"pairs"``:
            their energy terms at the end [J]. ``"stages"``: when each began and ended [s], its
            steps and its own energy terms [J].

        Raises
        ------
        InputError
            There is no such table, or pandas is not installed.
        """
        return data_frame(self, table)

    def __fspath__(self) -> str:
        return str(self.path)

    def __repr__(self) -> str:
        summary = self.summary
        return (
            f"Result({str(self.path)!r}: {summary['status']}, {summary['steps']} steps, "
            f"t = {summary['end_time']:g} s)"
        )

    def __rich__(self) -> Table:
        return summary_table(self.summary, where=self.path)

    def _repr_html_(self) -> str:
        return result_html(self)


def read_case(directory: Path) -> Scenario:
    """Read the case of a results directory, whose run may still be going on.

    Raises
    ------
    InputError
        There is no case in the directory.
    """
    return Scenario.from_toml(directory / layout.CASE)
