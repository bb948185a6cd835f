"""Packages that carom does without until they are asked for."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from carom.errors import InputError


def needed(module: str, *, of: str, extra: str) -> Any:  # noqa: ANN401 (any module)
    """Import a package that is an extra.

    Parameters
    ----------
    module
        Its name.
    of
        What needs it.
    extra
        The extra of carom that has it.

    Raises
    ------
    InputError
        It is not installed, or cannot be imported.
    """
    try:
        return import_module(module)
    except ImportError as error:
        raise InputError(f"{of} needs {module} ({error}): pip install 'carom[{extra}]'") from error
