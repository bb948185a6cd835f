"""The moments at which a run stops to write."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from time import perf_counter

from carom.case.full_stage import FullStage
from carom.case.scenario import Scenario

WALL_INTERVAL = 600.0
"""Wall time between two checkpoints where the case does not say how often [s]."""


SLACK = 1e-6
"""What a moment may be early by and is reached, in time steps: as the native run has it."""


class Beat:
    """The multiples of an interval.

    Parameters
    ----------
    every
        The interval [s].
    slack
        What a time may be early by [s].
    time
        Time from which they count [s]; one at this time is past.
    """

    def __init__(self, every: float, *, slack: float, time: float) -> None:
        self._every, self._slack = every, slack
        self._past = self._count(time)

    @property
    def next(self) -> float:
        """The next multiple [s]."""
        return (self._past + 1) * self._every

    def is_due(self, time: float) -> bool:
        """Return whether a new multiple is reached at a time [s], and count it."""
        before, self._past = self._past, self._count(time)
        return self._past > before

    def _count(self, time: float) -> int:
        return math.floor((time + self._slack) / self._every)


class StepBeat:
    """Every so many steps of a run, whatever their length.

    Parameters
    ----------
    steps
        So many.
    stages
        The analyses of the case.
    done
        Steps that are done; those up to here are past.
    """

    def __init__(self, steps: int, *, stages: Sequence[FullStage], done: int) -> None:
        self._steps, self._stages = steps, stages
        self._past = done // steps

    @property
    def next(self) -> float:
        """When the next is due [s]."""
        left = (self._past + 1) * self._steps
        for stage in self._stages:
            count = math.ceil(stage.duration / stage.analysis.time_step - SLACK)
            if left <= count:
                return min(stage.start_time + left * stage.analysis.time_step, stage.end_time)
            left -= count
        return self._stages[-1].end_time

    def is_due(self, done: int) -> bool:
        """Return whether so many steps are enough for a new one, and count it."""
        before, self._past = self._past, done // self._steps
        return self._past > before


@dataclass(frozen=True)
class _Frames:
    """The frames of an analysis after that at its start."""

    start: float
    end: float
    every: float
    slack: float

    @property
    def count(self) -> int:
        """How many there are; none for a rest that is only round-off."""
        return math.ceil((self.end - self.start) / self.every * (1 - 1e-9))

    def time(self, number: int) -> float:
        return self.start + number * self.every if number < self.count else self.end


class Schedule:
    """When the next frame of fields is due, and the next checkpoint.

    Parameters
    ----------
    scenario
        What is run.
    time
        Time that the run starts from [s].
    frames
        Frames after the first that were due until then.
    """

    def __init__(self, scenario: Scenario, *, time: float, frames: int) -> None:
        stages = scenario.full_stages()
        self._parts = [
            _Frames(s.start_time, s.end_time, s.fields_every, SLACK * s.analysis.time_step)
            for s in stages
        ]
        self._count = sum(part.count for part in self._parts)
        every = scenario.output.checkpoint_every
        slack = min(part.slack for part in self._parts)
        self._checkpoints = None if every is None else Beat(every, slack=slack, time=time)
        self._wall = perf_counter()
        self.frames = frames
        """Frames after the first that were due so far."""

    @property
    def has_ended(self) -> bool:
        """Whether the last frame was due: it is the end of the run."""
        return self.frames >= self._count

    @property
    def next(self) -> float:
        """Time of what is due next [s]."""
        frame, _ = self._frame(self.frames + 1)
        return frame if self._checkpoints is None else min(frame, self._checkpoints.next)

    def frame_is_due(self, time: float) -> bool:
        """Return whether a frame is due at a time [s], and count it."""
        before = self.frames
        while not self.has_ended:
            frame, slack = self._frame(self.frames + 1)
            if time < frame - slack:
                break
            self.frames += 1
        return self.frames > before

    def checkpoint_is_due(self, time: float) -> bool:
        """Return whether a checkpoint is due at a time [s], and count it."""
        return self._checkpoints is not None and self._checkpoints.is_due(time)

    def wall_checkpoint_is_due(self) -> bool:
        """Return whether one is due because none was made for a long time, and count it."""
        now = perf_counter()
        if self._checkpoints is not None or now - self._wall < WALL_INTERVAL:
            return False
        self._wall = now
        return True

    def _frame(self, number: int) -> tuple[float, float]:
        """Return when a frame is due, and what it may be early by [s]."""
        for part in self._parts[:-1]:
            if number <= part.count:
                return part.time(number), part.slack
            number -= part.count
        last = self._parts[-1]
        return last.time(number), last.slack
