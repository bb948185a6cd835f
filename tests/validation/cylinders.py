"""The paper's two cylinders in a rigid box: the case, and the figures that describe a run.

The box of 8 m × 8 m and the centres (2, 4) and (6, 4) are inferred: the paper shows them in a
figure only. It gives the times at which the cylinders meet.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from runs import Array, Run, example, reference, simulate

MEETING_IN_PAPER = {0.0: 2.45, 0.2: 2.8}
"""When the cylinders meet [s] by the coefficient of friction."""

COMPARED = 5.0
"""Until when runs are compared [s]: then the impacts depend on the mesh and on round-off."""

TWO_IMPACTS = 2.75
"""Until when the first two frictionless impacts are over, and no third one has begun [s]."""

ENERGIES = {"E_c": "kinetic", "E_e": "strain", "E_t": "total", "D_fric": "friction"}
"""Column of the reference curves to column of the history."""

CONSERVING = ('analysis.scheme={kind="conserving"}', "bodies.0.mesh.centre=[2.0, 4.0003]")
"""The energy–momentum scheme. The first cylinder starts 0.3 mm higher than in the example: a first
touch exactly at the end of a step would be decided by round-off."""


PRIZE = (*CONSERVING, "contact.targets=smooth")
"""With the condition ``massless``: the scheme and the targets that conserve."""

LOADED = (
    *PRIZE,
    "analysis.gravity=[0.0, -9.81]",
    "bodies.0.mesh.centre=[2.0, 1.3003]",
    "bodies.1.mesh.centre=[4.3, 1.2]",
)
"""The cylinders low above the floor and close to one another: all rub in the first second."""

QUIET = 460.0
"""Total variation of the normal force in the first two impacts if it hardly rings [N]: in either it
rises to its largest value and falls again."""


def run(
    *,
    friction: float,
    divisions: int = 8,
    condition: str = "gap",
    end_time: float = 15.0,
    overrides: Sequence[str] = (),
) -> Run:
    """Run ``examples/two_cylinders.toml``, every step recorded."""
    scenario = example(
        "two_cylinders.toml",
        f"contact.friction={friction}",
        f"contact.condition={condition}",
        f"bodies.0.mesh.divisions={divisions}",
        f"bodies.1.mesh.divisions={divisions}",
        f"analysis.end_time={end_time}",
        *overrides,
    )
    return simulate(
        scenario.with_overrides([f"output.history_every={scenario.analysis.time_step}"])
    )


def onset(run: Run, *pair: str) -> float:
    """Return when a pair first touches [s]."""
    contacts = run.summary["contacts"]
    return min(contact["onset"] for contact in contacts if set(contact["pair"]) == set(pair))


def first_wall_contact(run: Run) -> float:
    """Return when a cylinder first touches the box [s]."""
    contacts = run.summary["contacts"]
    both = {"left", "right"}
    return min(contact["onset"] for contact in contacts if set(contact["pair"]) != both)


def total_variation(run: Run) -> float:
    """Return Σ |ΔR_n| over the steps of the first two impacts, floor and other cylinder [N].

    R_n is the sum of the normal reactions of a step.
    """
    force = run.history["normal_force"][run.history["time"] < TWO_IMPACTS]
    return float(np.abs(np.diff(force)).sum())


def momentum_spread(run: Run) -> dict[str, float]:
    """Return how far the momenta vary from the rebound off the floor to the next touch of a wall.

    The impact of the two cylinders is in between. Relative to the largest value in the run; the
    angular momentum is about the origin.
    """
    time = run.history["time"]
    pairs = {tuple(c["pair"]): c for c in reversed(run.summary["contacts"])}
    start, end = pairs["left", "floor"]["release"], pairs["right", "east"]["onset"]
    meeting = pairs["left", "right"]
    if not start < meeting["onset"] < meeting["release"] < end:
        raise ValueError(f"the cylinders do not meet between {start} s and {end} s")
    between = (time > start) & (time < end - 1e-3)
    return {
        column: float(np.ptp(run.history[column][between]) / np.abs(run.history[column]).max())
        for column in ("momentum_x", "momentum_y", "angular_momentum")
    }


def reference_curves(friction: float) -> dict[str, Array]:
    """Return the prototype's energies [J] over time [s] until 5 s."""
    table = reference(f"cylinders_gap_friction_{friction:g}")
    return {name: table[name] for name in table.dtype.names}


class Distance(NamedTuple):
    """Distance of two energy curves relative to the initial energy: largest and RMS in time."""

    max: float
    rms: float


def distances(run: Run, *, friction: float) -> dict[str, Distance]:
    """Return how far the energies are from the reference curves until 5 s."""
    curves = reference_curves(friction)
    return {
        name: _distance(
            np.interp(curves["t"], run.history["time"], run.curve(column)),
            curves[name] / curves["E_t"][0],
        )
        for name, column in ENERGIES.items()
    }


def _distance(values: Array, expected: Array) -> Distance:
    difference = values - expected
    return Distance(max=float(np.abs(difference).max()), rms=float(np.sqrt(np.mean(difference**2))))
