"""``summary.json``: what came out of a run, in a page."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from carom.errors import InputError
from carom.io.atomic import write_whole
from carom.io.form import MAYBE_NUMBER, NUMBER, Form, misfit

_FORM: Form = {
    "status": str,
    "title": str,
    "steps": int,
    "dofs": int,
    "end_time": NUMBER,
    "wall_s": NUMBER,
    "wall_s_per_step": NUMBER,
    "min_gap": MAYBE_NUMBER,
    "energy": dict.fromkeys(
        (
            *("initial", "final", "kinetic", "strain", "friction", "viscous", "plastic", "scheme"),
            *("normal_contact", "prescribed", "external", "max_drift", "max_defect"),
        ),
        NUMBER,
    ),
    "certificate": {"max_joule": NUMBER, "tolerance_joule": NUMBER},
    "contacts": [
        {
            "pair": [str],
            "onset": NUMBER,
            "release": MAYBE_NUMBER,
            "peak_force": NUMBER,
            "friction_work": NUMBER,
        }
    ],
}
"""What every summary has."""

_CROSS_CHECK: Form = {
    "problems": int,
    "disagreements": int,
    "unsolved": int,
    "solvers": dict,
    "max_difference": NUMBER,
    "explained_difference": NUMBER,
    "max_certificate_joule": NUMBER,
    "time_of_max": MAYBE_NUMBER,
}
"""What it says of a second solver, if there was one."""


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
    except ValueError as error:
        raise InputError(f"{path}: not JSON: {error}") from error
    wrong = misfit(summary, _FORM)
    if wrong is None and summary.get("cross_check") is not None:
        wrong = misfit(summary["cross_check"], _CROSS_CHECK, "cross_check")
    if wrong is not None:
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
