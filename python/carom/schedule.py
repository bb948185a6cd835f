"""The moments at which a run stops to write."""

from __future__ import annotations

import math
from time import perf_counter

from carom.scenario import Scenario

WALL_INTERVAL = 600.0
"""Wall time between two checkpoints where the case does not say how often [s]."""


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
        # As the native run has it: what is nearer than this is reached.
        self._slack = 1e-6 * scenario.analysis.time_step
        self._every = scenario.output.resolved(scenario.analysis).fields_every or self._end
        # No frame for a rest that is only round-off.
        self._count = math.ceil(self._end / self._every * (1 - 1e-9))
        self._checkpoint_every = scenario.output.checkpoint_every
        self._wall = perf_counter()
        self.frames = frames
        """Frames after the first that were due so far."""
        self._checkpoints = 0
        self.checkpoint_is_due(time)

    @property
    def has_ended(self) -> bool:
        """Whether the last frame was due: it is the end of the run."""
        return self.frames >= self._count

    @property
    def next(self) -> float:
        """Time of what is due next [s]."""
        return min(self._frame_time(self.frames + 1), self._checkpoint_time())

    def frame_is_due(self, time: float) -> bool:
        """Return whether a frame is due at a time [s], and count it."""
        before = self.frames
        while not self.has_ended and time >= self._frame_time(self.frames + 1) - self._slack:
            self.frames += 1
        return self.frames > before

    def checkpoint_is_due(self, time: float) -> bool:
        """Return whether a checkpoint is due at a time [s], and count it."""
        if self._checkpoint_every is None or time < self._checkpoint_time() - self._slack:
            return False
        self._checkpoints = math.floor((time + self._slack) / self._checkpoint_every)
        return True

    def wall_checkpoint_is_due(self) -> bool:
        """Return whether one is due because none was made for a long time, and count it."""
        now = perf_counter()
        if self._checkpoint_every is not None or now - self._wall < WALL_INTERVAL:
            return False
        self._wall = now
        return True

    def _frame_time(self, frame: int) -> float:
        return frame * self._every if frame < self._count else self._end

    def _checkpoint_time(self) -> float:
        if self._checkpoint_every is None:
            return math.inf
        return (self._checkpoints + 1) * self._checkpoint_every
