"""The energy of modes over time, as a picture."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from carom.display.colours import SEQUENTIAL
from carom.display.time_unit import time_unit
from carom.modes.energies import ModalEnergies
from carom.plot.style import figure

ROW = 3.0
"""Height of a body [inch]."""

DECADES = 5
"""Powers of ten of energy that have a colour."""

LABELS = 10
"""Modes that are told of by their frequency, at most."""


def modes_figure(bodies: Sequence[ModalEnergies]) -> Figure:
    """Draw the spectrogram of each body: a row of colours for every mode, the slowest below.

    Parameters
    ----------
    bodies
        Their energies.
    """
    with figure(height=ROW * len(bodies) + 0.4) as picture:
        diagrams = np.atleast_1d(picture.subplots(len(bodies), 1, sharex=True))
        unit = time_unit(float(bodies[0].times[-1]))
        for one, axes in zip(bodies, diagrams, strict=True):
            energies = one.energies
            largest = float(energies.max(initial=0.0)) or 1.0
            numbers = np.arange(1, len(one.frequencies) + 1)
            mesh = axes.pcolormesh(
                one.times / unit.seconds,
                numbers,
                np.maximum(energies, largest * 10.0**-DECADES).T,
                norm=LogNorm(largest * 10.0**-DECADES, largest),
                cmap=SEQUENTIAL,
                shading="nearest",
                rasterized=True,
            )
            told = numbers[:: -(-len(numbers) // LABELS)]
            axes.set_yticks(told, [f"{k}: {one.frequencies[k - 1]:.3g} Hz" for k in told])
            axes.set_title(one.body, parse_math=False)
            picture.colorbar(mesh, ax=axes, label="energy [J]")
        diagrams[-1].set_xlabel(f"time [{unit.symbol}]")
    return picture
