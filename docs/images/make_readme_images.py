"""Make the pictures of the README from one run of examples/two_cylinders.toml, as it is shipped.

`carom run examples/two_cylinders.toml` gives the same results: no value of the case is replaced.
The impact is the frame in which the cylinders press each other hardest.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

import carom
from carom.display.colours import ORANGE
from carom.plot.energy import energy_figure

HERE = Path(__file__).parent
CASE = HERE.parents[1] / "examples" / "two_cylinders.toml"

ARROW = 0.7
"""Length of the largest reaction's arrow [m]."""


def von_mises(stress: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return von Mises' stress [Pa], shape [cell_count], of xx yy zz xy yz xz in each row."""
    xx, yy, zz, xy, yz, xz = stress.T
    direct = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.sqrt(0.5 * direct + 3.0 * (xy**2 + yz**2 + xz**2))


def hardest(result: carom.Result) -> int:
    """Return the frame of the largest reaction while the first two bodies that meet touch."""
    names = {body.name for body in result.scenario.bodies}
    meeting = next(c for c in result.summary["contacts"] if names.issuperset(c["pair"]))
    during = (result.fields.times >= meeting["onset"]) & (result.fields.times <= meeting["release"])
    forces = {
        k: np.linalg.norm(result.fields["reaction"][k], axis=1) for k in np.flatnonzero(during)
    }
    return int(max(forces, key=lambda k: forces[k].max()))


def impact_figure(result: carom.Result) -> Figure:
    """Draw the impact: deformed mesh, von Mises' stress and the contact reactions."""
    fields, frame = result.fields, hardest(result)
    cells, time = fields.connectivity, fields.times[frame]
    reaction, stress = fields["reaction"][frame], von_mises(fields["stress"][frame])
    position = fields.points + fields["displacement"][frame]
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
    friction = result.scenario.contact.friction
    axes.set_title(f"$t$ = {time:.2f} s, $\\mu$ = {friction:g}", fontsize=11, loc="left")
    axes.spines[["top", "right"]].set_visible(False)
    axes.text(0.02, 0.97, "contact reactions", color=ORANGE, va="top", transform=axes.transAxes)
    figure.colorbar(mesh, label="von Mises stress [Pa]", aspect=30, pad=0.02, shrink=0.88)
    return figure


def main() -> None:
    """Run the case and write the pictures beside this script."""
    with TemporaryDirectory() as scratch:
        result = carom.run(carom.Scenario.from_toml(CASE), out=Path(scratch) / "run")
        impact_figure(result).savefig(HERE / "impact.png", dpi=160)
        energy_figure(result).savefig(HERE / "energy.png", dpi=130)


if __name__ == "__main__":
    main()
