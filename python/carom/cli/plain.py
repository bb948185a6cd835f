"""JSON for other programs."""

from __future__ import annotations

import json
import math
from typing import Any


def json_text(data: Any) -> str:  # noqa: ANN401 (any JSON value)
    """Return plain data as JSON; what is not a finite number is null, as JSON has no other word."""
    return json.dumps(_finite(data), indent=2, ensure_ascii=False)


def _finite(value: Any) -> Any:  # noqa: ANN401 (any JSON value)
    if isinstance(value, dict):
        return {key: _finite(member) for key, member in value.items()}
    if isinstance(value, list):
        return [_finite(member) for member in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
