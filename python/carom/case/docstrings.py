"""What the docstring of a class says about the class and its fields."""

from __future__ import annotations

import inspect
import re


def summary(model: type) -> str:
    """Return the first paragraph of the docstring of a class, on one line."""
    return " ".join((inspect.getdoc(model) or "").partition("\n\n")[0].split())


def documented(model: type) -> dict[str, str]:
    """Return what the docstring of a class says about each of its parameters.

    What it says of None is said of keys that are left out: no file can have a None.
    """
    _, _, body = (inspect.getdoc(model) or "").partition("Parameters\n----------\n")
    said: dict[str, str] = {}
    name = ""
    for line in body.splitlines():
        if line and not line.startswith(" "):
            name = line
            said[name] = ""
        else:
            said[name] = f"{said[name]} {line.strip()}".strip()
    return {key: re.sub(r"\bNone (is|takes) ", "left out: ", text) for key, text in said.items()}
