"""Pushes of stabilised load steps, by which bodies leave a state that is not stable."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.model import AuditModel

PUSH = 1e-8
"""The kinetic energy of a push, in terms of the strain energy."""


def beyond_pushes(model: AuditModel, history: Mapping[str, Array], error: Array) -> Array:
    """Return what of the external work of rows no pushes can have brought [J], shape [row_count].

    Where load steps failed there may have been as many as of these, and none takes energy.

    Parameters
    ----------
    model
        The model.
    history
        The history by columns.
    error
        What the external work has more than that of weights [J], shape [row_count].
    """
    if not model.stabilised:
        return error
    most = PUSH * float(history["strain"].max()) * np.cumsum(history["retried_steps"])
    beyond: Array = error - np.clip(error, 0.0, most)
    return beyond
