"""Where a command prints whose work goes on, even when nobody can read of it any more."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from typing import Any, TextIO, cast


class _Lasting:
    """A file that takes what is written to it, and drops it once the system refuses it."""

    def __init__(self, file: TextIO) -> None:
        self._file = file
        self._is_gone = False

    def write(self, text: str) -> int:
        """Write, or drop."""
        if not self._is_gone:
            try:
                self._file.write(text)
            except OSError as error:
                self._give_up(error)
        return len(text)

    def flush(self) -> None:
        """Pass on what is in the buffer, or drop it."""
        if not self._is_gone:
            try:
                self._file.flush()
            except OSError as error:
                self._give_up(error)

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 (of any file)
        return getattr(self._file, name)

    def _give_up(self, error: OSError) -> None:
        self._is_gone = True
        # What is in its buffer would be refused again when Python ends.
        with suppress(OSError):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, self._file.fileno())
            os.close(nowhere)
        if not isinstance(error, BrokenPipeError):  # that is `| head`, and on purpose
            with suppress(OSError):
                sys.stderr.write(
                    f"standard output: {error.strerror or error}; the work goes on, untold\n"
                )


def lasting() -> TextIO:
    """Return standard output, of which a closed pipe or a full disk is no reason to stop a run."""
    return cast(TextIO, _Lasting(sys.stdout))
