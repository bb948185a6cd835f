"""Looking at a run while it goes on, and stopping it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from carom.errors import InputError
from carom.running.schedule import SLACK, Beat, StepBeat
from carom.running.state import State


class Stop(Exception):  # noqa: N818 (no error, as StopIteration is none)
    """Raised by an observer to end a run here and keep its results.

    Parameters
    ----------
    reason
        Why, for ``summary.json``.
    """

    def __init__(self, reason: str = "") -> None:
        super().__init__(reason or "an observer stopped the run")


@dataclass(frozen=True)
class Observer:
    """A function that looks at a run as it goes: at its start, at a beat, and at its end.

    It does not change the motion. A run that is resumed calls it from there on.

    Parameters
    ----------
    look
        Called with the `State`; raises `Stop` to end the run.
    every
        Simulated time between two calls [s]: it is called at the end of the first step that
        reaches a multiple of it.
    steps
        Steps between two calls, in place of `every`; each step by default.

    Raises
    ------
    InputError
        Both are given, or one that is not positive.
    """

    look: Callable[[State], object]
    every: float | None = None
    steps: int | None = None

    def __post_init__(self) -> None:
        if self.every is not None and self.steps is not None:
            raise InputError("an observer has `every` or `steps`, not both")
        if self.every is not None and not 0.0 < self.every < math.inf:
            raise InputError(f"every = {self.every}: must be a time above 0 s")
        if self.steps is not None and self.steps < 1:
            raise InputError(f"steps = {self.steps}: must be 1 or more")


class ObserverError(Exception):
    """An observer raised something; `error` is what."""

    def __init__(self, error: Exception) -> None:
        super().__init__(str(error))
        self.error = error


class Observing:
    """The observers of a run, and when they are due.

    Parameters
    ----------
    observers
        Who looks.
    state
        What they are called with.

    Raises
    ------
    InputError
        One of them is no `Observer`.
    """

    def __init__(self, observers: Sequence[Observer], state: State) -> None:
        for observer in observers:
            if not isinstance(observer, Observer):
                raise InputError(
                    f"observers: {observer!r} says not when it is called; "
                    "give carom.Observer(look, every=…)"
                )
        self._state = state
        stages = state.scenario.full_stages()
        slack = SLACK * min(stage.analysis.time_step for stage in stages)
        self._beats: list[tuple[Callable[[State], object], Beat | StepBeat]] = []
        for observer in observers:
            beat: Beat | StepBeat
            if observer.every is None:
                steps = observer.steps or 1
                beat = StepBeat(steps, stages=stages, done=state.steps)
            else:
                beat = Beat(observer.every, slack=slack, time=state.time)
            self._beats.append((observer.look, beat))
        last = stages[-1]
        self._end = last.end_time - SLACK * last.analysis.time_step

    @property
    def next(self) -> float:
        """Time at which the first is due [s]."""
        return min(beat.next for _, beat in self._beats)

    def look(self, *, starts: bool = False) -> None:
        """Call those that are due: all of them where the run starts or ends.

        Raises
        ------
        Stop
            One of them wants the run to end; the others have looked.
        ObserverError
            One of them raised something else.
        """
        time, stop = self._state.time, None
        for look, beat in self._beats:
            is_due = (
                beat.is_due(self._state.steps) if isinstance(beat, StepBeat) else beat.is_due(time)
            )
            if not is_due and not starts and time < self._end:
                continue
            try:
                look(self._state)
            except Stop as wish:
                stop = stop or wish
            except Exception as error:
                raise ObserverError(error) from error
        if stop is not None:
            raise stop
