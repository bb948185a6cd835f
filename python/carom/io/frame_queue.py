"""Writing frames on another thread, several at a time, while the native core steps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.io.audit import AuditWriter
from carom.io.vtkhdf import FieldsWriter

PERIOD = 1.0
"""Wall time after which frames that wait are written [s]: for those who look on meanwhile."""

ROOM = 64 << 20
"""Size of the frames that wait, beyond which they are written at once [bytes]."""


@dataclass(frozen=True)
class Frame:
    """What is written of one moment.

    Parameters
    ----------
    time
        Time [s].
    fields, surface
        Arrays of the bodies and of their boundaries, see `carom.io.vtkhdf.FieldsWriter.append`.
    step
        The step that led to it, see `carom.io.audit.AuditWriter.append`; None if that is not kept.
    """

    time: float
    fields: Mapping[str, NDArray[np.float64]]
    surface: Mapping[str, NDArray[np.float64]]
    step: Mapping[str, Any] | None

    def arrays(self) -> Iterator[NDArray[np.float64]]:
        """Yield the arrays that go into every frame."""
        yield from self.fields.values()
        yield from self.surface.values()


class FrameQueue:
    """Hands frames to the writers of their files.

    Opening and closing an HDF5 file takes longer than what a frame of a small model adds to it, so
    frames wait for others. At most one batch is being written while the next one gathers: whoever
    is quicker than the disk waits for it.

    Parameters
    ----------
    fields, surface
        Writers of the bodies and of their boundaries.
    audit
        Writer of steps, if they are kept.
    """

    def __init__(
        self, fields: FieldsWriter, surface: FieldsWriter, audit: AuditWriter | None
    ) -> None:
        self._fields = fields
        self._surface = surface
        self._audit = audit
        self._waiting: list[Frame] = []
        self._since = 0.0
        self._writing: Future[None] | None = None
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="carom-frames")

    @property
    def keeps_steps(self) -> bool:
        """Whether the steps of frames are written."""
        return self._audit is not None

    def put(self, frame: Frame) -> None:
        """Take a frame; as `write_due`."""
        if not self._waiting:
            self._since = perf_counter()
        self._waiting.append(frame)
        self.write_due()

    def write_due(self) -> None:
        """Begin to write the frames that wait, if they have waited long or are large.

        Raises
        ------
        OSError
            Frames before them could not be written.
        """
        if not self._waiting:
            return
        size = sum(array.nbytes for frame in self._waiting[:1] for array in frame.arrays())
        if perf_counter() - self._since > PERIOD or len(self._waiting) * size > ROOM:
            self._hand_over()

    def flush(self) -> None:
        """Wait until every frame is in its file.

        Raises
        ------
        OSError
            Frames could not be written.
        """
        self._hand_over()
        self._wait()

    def close(self) -> None:
        """Write what waits, unless writing has failed, and end the thread."""
        try:
            self.flush()
        finally:
            self._thread.shutdown()

    def _hand_over(self) -> None:
        self._wait()
        if self._waiting:
            self._writing = self._thread.submit(self._write, self._waiting)
            self._waiting = []

    def _wait(self) -> None:
        writing, self._writing = self._writing, None
        if writing is None:
            return
        try:
            writing.result()
        except Exception:
            self._waiting.clear()  # behind a gap nobody wants them
            raise

    def _write(self, frames: list[Frame]) -> None:
        times = [frame.time for frame in frames]
        self._fields.append(times, [frame.fields for frame in frames])
        self._surface.append(times, [frame.surface for frame in frames])
        if self._audit is not None:
            self._audit.append([frame.step for frame in frames if frame.step is not None])
