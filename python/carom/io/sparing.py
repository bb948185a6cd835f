"""What no command writes over, whatever it was told: the files from which a run is read."""

from __future__ import annotations

from pathlib import Path

from carom.errors import InputError
from carom.io import layout
from carom.system.existing import spare_existing

OF_A_RUN = frozenset(
    {
        layout.CASE,
        layout.SUMMARY,
        layout.HISTORY,
        layout.LEDGER,
        layout.FIELDS,
        layout.SURFACE,
        layout.AUDIT,
        layout.CHECKPOINT,
        layout.PREVIOUS_CHECKPOINT,
        layout.FRESH_CHECKPOINT,
        layout.END_STATE,
        layout.PROGRESS,
        layout.LOCK,
    }
)
"""Names of files that only the run itself can make again; pictures and pages are not among them."""


def spare_file(file: Path, *, force: bool) -> None:
    """Refuse a file to write that is there, before anything is computed for it.

    Parameters
    ----------
    file
        File to write.
    force
        Whether one that is there is replaced; files of a run are not even then.

    Raises
    ------
    InputError
        See `carom.system.existing.spare_existing`, or the file is of the results of a run.
    """
    ran = (layout.CASE, layout.HISTORY)
    if file.name in OF_A_RUN and file.is_file() and all((file.parent / n).exists() for n in ran):
        raise InputError(f"{file}: is of the results of a run; name another file")
    spare_existing(file, force=force)
