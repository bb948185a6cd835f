"""``summary.json``: what came out of a run, in a page."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from carom.errors import InputError
from carom.io.atomic import write_whole
from carom.io.form import misfit
from carom.io.summary_types import Summary


def write_summary(path: Path, summary: Mapping[str, Any]) -> None:
    """Write the summary whole or not at all; what is not a finite number is written as null."""
    text = json.dumps(_json(summary), indent=2, ensure_ascii=False, allow_nan=False)
    write_whole(path, f"{text}\n".encode())


def read_summary(path: Path) -> dict[str, Any]:
    """Read a summary.

    Raises
    ------
    InputError
        The file is not a summary.
    """
    try:
        summary: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:  # the latter of a thousand brackets
        raise InputError(f"{path}: not JSON: {error}") from error
    if wrong := misfit(summary, Summary):
        raise InputError(f"{path}: not a summary of carom: {wrong}")
    return summary


def _json(value: Any) -> Any:  # noqa: ANN401 (any JSON value)
    if isinstance(value, Mapping):
        return {key: _json(member) for key, member in value.items()}
    if isinstance(value, list | tuple):
        return [_json(member) for member in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
