"""Who writes the results of a run on several ranks, and what the others do meanwhile."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from typing_extensions import Self

from carom import _carom
from carom.io import layout
from carom.results.doubts import Doubt
from carom.results.result import Result
from carom.running.recorder import Recorder, taken
from carom.system.progress import Progress

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from carom.friction import Problem
    from carom.ranks.engine import Engine


class Following:
    """Follows the `carom.running.recorder.Recorder` of the first rank, call by call.

    Fields of cells are asked for where it asks: all ranks have a part of them.
    """

    def __init__(
        self,
        directory: Path,
        simulation: _carom.Simulation,
        engine: Engine,
        *,
        keeps_steps: bool,
        last_frame: float | None,
    ) -> None:
        self._directory, self._simulation, self._engine = directory, simulation, engine
        self._keeps_steps, self._last_frame = keeps_steps, last_frame
        self._start = perf_counter()

    @property
    def wall(self) -> float:
        """Wall time since it began [s]."""
        return perf_counter() - self._start

    def doubt(self, doubt: Doubt) -> None:
        """Leave it to the first rank to tell of it."""

    def progress(self, progress: Progress) -> None:
        """Leave it to the first rank to tell of it."""

    def checkpoint(self, *, frames_due: int) -> None:
        """Leave it to the first rank, which has all that it takes."""

    def history(self) -> None:
        """Forget the rows recorded since the last call."""
        self._simulation.take_history()
        self._simulation.take_ledger()

    def frame(self) -> None:
        """Have a part in the fields of the current state, once."""
        self._frame(with_step=True)

    def _frame(self, *, with_step: bool) -> None:
        if self._simulation.time != self._last_frame:
            taken(self._simulation, with_step=with_step and self._keeps_steps)
            self._last_frame = self._simulation.time

    def failed_problem(
        self, problem: Problem, *, guess: NDArray[np.float64] | None, reason: str
    ) -> Path:
        """Return where the first rank writes the contact problem that a step could not solve."""
        return self._directory / layout.FAILED_PROBLEM

    def close(self, *, status: str, reason: str | None = None) -> Result:
        """Return the results once the first rank has written them."""
        self._simulation.finish()
        self.history()
        self._frame(with_step=status != "failed")
        self._engine.wait()
        return Result.open(self._directory)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pass


class Leading(Recorder):
    """The `Recorder` of the first rank, which lets the others go on once the results are there."""

    def __init__(self, *where: Any, engine: Engine, **what: Any) -> None:  # noqa: ANN401 (as there)
        super().__init__(*where, **what)
        self._engine = engine

    def close(self, *, status: str, reason: str | None = None) -> Result:
        """Write the last state and all that is made of the run, see `Recorder.close`."""
        result = super().close(status=status, reason=reason)
        self._engine.wait()
        return result
