"""Colours that tell bodies apart."""

from __future__ import annotations

import numpy as np
from matplotlib.colors import to_rgba_array
from numpy.typing import NDArray

PALETTE = ("#8FB8DE", "#F2B98A", "#9CCFB4", "#D9A9CC", "#E6CF7E", "#A9A6D9", "#B9C3CF")
"""Pale, so that lines and arrows stand out; no two that follow look alike."""

PLAIN = "#E9EDF2"
"""Of bodies that have colours on their boundaries alone."""


def body_colours(body: NDArray[np.int64], *, plain: bool = False) -> NDArray[np.float64]:
    """Return the colour of each face by its body, shape [face_count, 4]."""
    table = to_rgba_array((PLAIN,) if plain else PALETTE)
    return np.asarray(table[body % len(table)])
