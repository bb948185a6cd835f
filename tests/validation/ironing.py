"""Shallow ironing: a stiff iron with a round sole is pressed into a slab and drawn across it.

The slab is 12 m × 4 m, the iron 1.2 m × 0.75 m and ten times as stiff, μ = 0.3. It goes 1 m down in
1 s and 10 m across in another: Fischer & Wriggers, Comput. Methods Appl. Mech. Engrg. 195 (2006)
5020–5036.
"""

from __future__ import annotations

import tempfile
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import grids
import numpy as np
from runs import Array

import carom

LENGTH, HEIGHT = 12.0, 4.0  # m, of the slab
WIDTH, DEPTH, RADIUS = 1.2, 0.75, 0.975  # m, of the iron
YOUNG, POISSON = 68.96e7, 0.32
DOWN, ACROSS = 1.0, 10.0  # m
SLIDING = (1.2, 1.8)  # s
DENSITY = 1.0  # kg/m³: a wave crosses the slab in 0.4 ms
START = 1.0  # m, the middle of the iron
STEP = 0.01  # s
WAYS = ("static", "stabilised")
RUNS = (("node-to-segment", "static"), ("mortar", "static"), ("mortar", "stabilised"))


@dataclass(frozen=True)
class Ironing:
    """What an ironing gave.

    Parameters
    ----------
    status
        Of the run, with the reason where it failed.
    history
        Columns of the history by title.
    summary
        The native summary.
    """

    status: str
    history: dict[str, Array]
    summary: dict[str, Any]

    @property
    def forces(self) -> tuple[Array, Array]:
        """Along and across the slab [N/m], row by row: what draws the iron and what presses it."""
        return self.history["iron.top.force_x"], -self.history["iron.top.force_y"]

    @property
    def slides_to_the_end(self) -> bool:
        """Whether the iron gets as far as means are taken."""
        return bool(self.history["time"][-1] > SLIDING[1])

    def sliding(self) -> Array:
        """Return which rows are far from the ends of the slab."""
        time = self.history["time"]
        return (time > SLIDING[0]) & (time < SLIDING[1])

    def scatter(self) -> tuple[float, float]:
        """Standard deviation over mean of both forces while the iron slides."""
        rows = self.sliding()
        along, across = (f[rows] for f in self.forces)
        return float(along.std() / along.mean()), float(across.std() / across.mean())

    def means(self) -> tuple[float, float]:
        """Mean of both forces while the iron slides [N/m]."""
        rows = self.sliding()
        along, across = (f[rows] for f in self.forces)
        return float(along.mean()), float(across.mean())


def scenario(
    folder: Path,
    analysis: carom.Static,
    discretisation: str,
) -> carom.Scenario:
    """Return the case; the mesh of the iron is written to `folder`."""
    x, share = np.meshgrid(np.linspace(-WIDTH / 2, WIDTH / 2, 13), np.linspace(0.0, 1.0, 7))
    sole = RADIUS - np.sqrt(RADIUS**2 - x**2)
    y = sole + (DEPTH - sole) * share
    # A hair's breadth above the slab.
    file = grids.write(folder / "iron.inp", START + x, HEIGHT + 1e-6 + y)
    driven = {"time": [0.0, 1.0, 2.0], "value": [0.0, 0.0, ACROSS]}
    pressed = {"time": [0.0, 1.0], "value": [0.0, -DOWN]}
    return carom.Scenario(
        title="Shallow ironing",
        analysis=analysis,
        output=carom.Output(history_every=analysis.time_step, fields_every=0.1),
        materials={
            "slab": carom.NeoHookean(young=YOUNG, poisson=POISSON, density=DENSITY),
            "iron": carom.NeoHookean(young=10.0 * YOUNG, poisson=POISSON, density=DENSITY),
        },
        bodies=[
            carom.Body(
                name="slab",
                material="slab",
                mesh=carom.Rectangle(corner=[0.0, 0.0], size=[LENGTH, HEIGHT], divisions=[36, 9]),
            ),
            carom.Body(name="iron", material="iron", mesh=carom.MeshFile(file=str(file))),
        ],
        motions=[
            carom.Fixed(body="slab", on="bottom"),
            carom.Prescribed(body="iron", on="top", x=driven, y=pressed),
        ],
        contact=carom.Contact(condition="gap", friction=0.3, discretisation=discretisation),
    )


def iron(analysis: carom.Static, discretisation: str) -> Ironing:
    """Draw the iron across the slab, as far as it gets."""
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        case = scenario(Path(folder), analysis, discretisation)
        out = Path(folder) / "out"
        try:
            status = carom.run(case, out=out).summary["status"]
        except carom.CaromError as error:
            status = str(error)
        result = carom.Result.open(out)
        history = {name: np.asarray(result.history[name]) for name in result.history}
        return Ironing(status, history, result.summary)


def analysis(way: str) -> carom.Static:
    """Return one of the ways to go about it."""
    stabilisation = "dynamic" if way == "stabilised" else "none"
    return carom.Static(end_time=2.0, time_step=STEP, stabilisation=stabilisation)


def all_runs() -> dict[tuple[str, str], Ironing]:
    """Draw the iron across; node to segment only without bridges, of which it takes minutes."""
    return {(d, way): iron(analysis(way), d) for d, way in RUNS}
