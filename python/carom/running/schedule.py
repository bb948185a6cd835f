"""The moments at which a run stops to write."""

from __future__ import annotations

import math
from time import perf_counter

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
        self._end = scenario.analysis.end_time
        self._slack = SLACK * scenario.analysis.time_step
        self._every = scenario.output.resolved(scenario.analysis).fields_every or self._end
        # No frame for a rest that is only round-off.
        self._count = math.ceil(self._end / self._every * (1 - 1e-9))
        every = scenario.output.checkpoint_every
        self._checkpoints = None if every is None else Beat(every, slack=self._slack, time=time)
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
        frame = self._frame_time(self.frames + 1)
        return frame if self._checkpoints is None else min(frame, self._checkpoints.next)

    def frame_is_due(self, time: float) -> bool:
        """Return whether a frame is due at a time [s], and count it."""
        before = self.frames
        while not self.has_ended and time >= self._frame_time(self.frames + 1) - self._slack:
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

    def _frame_time(self, frame: int) -> float:
        return frame * self._every if frame < self._count else self._end
