"""Pictures of bodies for the gallery, as ``carom picture`` draws them."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import Any

import matplotlib.pyplot as plt

import carom

WIDTH = 190.0
"""Of a strip [mm]; of a single picture half of it."""


def draw(
    result: carom.Result,
    times: Sequence[float],
    *,
    field: str,
    **look: Any,  # noqa: ANN401 (whatever carom.picture takes)
) -> None:
    """Draw the bodies of a run at some times [s], side by side, in the colours of a field.

    Keywords are those of `carom.picture`, as ``magnification`` and ``camera``.
    """
    width = WIDTH if len(times) > 1 else WIDTH / 2
    drawn = carom.picture(result, times=times, field=field, width=width, **look)
    file = BytesIO()
    drawn.savefig(file, format="png", dpi=200)
    file.seek(0)
    # The gallery shows the figures of pyplot, of which those of carom are none.
    figure = plt.figure(figsize=drawn.get_size_inches(), dpi=200)
    figure.figimage(plt.imread(file))
