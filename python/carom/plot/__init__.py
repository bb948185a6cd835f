"""Pictures of results, for papers and talks."""

from __future__ import annotations

from pathlib import Path

from carom.io import layout
from carom.plot.energy import energy_figure
from carom.plot.style import save
from carom.plot.track import track_figure
from carom.results.result import Result


def draw(result: Result) -> list[Path]:
    """Draw the energies and every tracked point into the results directory.

    Returns
    -------
    list of Path
        The files, the energies first.
    """
    energy = save(energy_figure(result), result.path / layout.ENERGY_PLOT)
    tracks = [
        save(track_figure(result, track=track.name), result.path / layout.track_plot(track.name))
        for track in result.scenario.output.track
    ]
    return [energy, *tracks]
