"""Make the pictures of the README from results of carom.

Both are examples/two_cylinders.toml. The impact is that case on a finer mesh, stopped while the
cylinders are in contact; the energies are those of the whole run.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import h5py
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

import carom
from carom.plot.energy import energy_figure
from carom.plot.style import ORANGE

HERE = Path(__file__).parent
CASE = HERE.parents[1] / "examples" / "two_cylinders.toml"

IMPACT = ["analysis.end_time=2.88", "bodies.0.mesh.divisions=16", "bodies.1.mesh.divisions=16"]
"""Overrides of the case for the picture of the impact."""

ARROW = 0.7
"""Length of the largest reaction's arrow [m]."""


def von_mises(stress: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return von Mises' stress [Pa], shape [cell_count], of xx yy zz xy yz xz in each row."""
    xx, yy, zz, xy, yz, xz = stress.T
    direct = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.sqrt(0.5 * direct + 3.0 * (xy**2 + yz**2 + xz**2))


def impact_figure(result: carom.Result) -> Figure:
    """Draw the last frame: deformed mesh, von Mises' stress and the contact reactions."""
    with h5py.File(result.fields_path) as file:
        root = file["VTKHDF"]
        points, cells = root["Points"][:, :2], root["Connectivity"][:].reshape(-1, 4)
        displacement = root["PointData/displacement"][-len(points) :, :2]
        reaction = root["PointData/reaction"][-len(points) :, :2]
        stress = von_mises(root["CellData/stress"][-len(cells) :])
        time = root["Steps/Values"][-1]
    position = points + displacement
    touched = np.linalg.norm(reaction, axis=1) > 0.0

    figure = Figure(figsize=(5.0, 3.3), layout="constrained")
    axes = figure.add_subplot()
    mesh = PolyCollection(
        position[cells], array=stress, cmap="YlGnBu", edgecolors="#00000055", linewidths=0.25
    )
    axes.add_collection(mesh)
    axes.quiver(
        *position[touched].T,
        *reaction[touched].T,
        color=ORANGE,
        angles="xy",
        scale_units="xy",
        scale=np.linalg.norm(reaction, axis=1).max() / ARROW,
        width=0.007,
        zorder=3,
    )
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_xlabel("$x$ [m]")
    axes.set_ylabel("$y$ [m]")
    axes.set_title(f"$t$ = {time:.2f} s, $\\mu$ = 0.2", fontsize=11, loc="left")
    axes.spines[["top", "right"]].set_visible(False)
    axes.text(0.02, 0.97, "contact reactions", color=ORANGE, va="top", transform=axes.transAxes)
    figure.colorbar(mesh, label="von Mises stress [Pa]", aspect=30, pad=0.02, shrink=0.88)
    return figure


def main() -> None:
    """Run the case twice and write the pictures beside this script."""
    scenario = carom.Scenario.from_toml(CASE)
    with TemporaryDirectory() as scratch:
        impact = carom.run(scenario.with_overrides(IMPACT), out=Path(scratch) / "impact")
        impact_figure(impact).savefig(HERE / "impact.png", dpi=160)
        whole = carom.run(scenario, out=Path(scratch) / "whole")
        energy_figure(whole).savefig(HERE / "energy.png", dpi=130)


if __name__ == "__main__":
    main()
