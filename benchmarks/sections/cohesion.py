"""Surfaces that hold together."""

from __future__ import annotations

import tempfile
from pathlib import Path

import cohesive
import numpy as np

import carom
from sections.layout import power, table

STRESS, FRICTION, ANGLE = 1e3, 0.4, np.radians(40.0)

TEXT = """\
## Cohesion and bonds

Blocks on a floor that hold by a stress c, and two blocks that are glued
(`tests/validation/cohesive.py`; asserted in `test_cohesion.py`).

**Closed forms.** An elastic block is pulled off at c A: held at (1 − 1e-6) c A, where the support
pulls with that, and free at (1 + 1e-6) c A. A rigid one on a slope of 40° with μ = {friction:g},
where friction alone holds 21.8°, slides by ½ (g sin α − μ (g cos α + c A/m)) t². An elastic one is
pushed along the floor and slides at μ (N + c A). The largest relative error of force or way.

{forms}

**Thrown** on a floor that it sticks to, conserving: the largest defect of the ledger and what
normal reactions took, adhesion among them, relative to E₀.

{throws}

**Bonds of unlike meshes** that nothing breaks. The patch test, of uniform tension and shear by
static analysis: the largest error of a component of the stress in a cell, relative to it. In
flight, where the halves set out with velocities that do not fit and spin: how far energy, momentum
and angular momentum vary in 100 steps, relative to the largest.

{bonds}
"""


def section() -> str:
    """Pull, push and throw the blocks, in the plane and in space."""
    forms, throws, bonds = [], [], []
    for dimension in (2, 3):
        forms.append((f"{dimension}D", *map(power, closed_forms(dimension))))
        bonds.append((f"{dimension}D", *map(power, (*patches(dimension), *flight(dimension)))))
    for condition in ("midpoint", "gap", "endpoint"):
        cohesion = carom.Cohesion(stress=2e3, lasting=True)
        result = run(cohesive.bouncing(2, condition, cohesion))
        initial = result.summary["energy"]["initial"]
        taken = np.abs(result.history["normal_contact"]).max()
        defect = result.summary["energy"]["max_defect"]
        throws.append((f"`{condition}`", power(defect / initial), power(taken / initial)))
    return TEXT.format(
        friction=FRICTION,
        forms=table(("", "pulled off", "slope", "pushed"), forms),
        throws=table(("condition", "defect", "normal reactions"), throws),
        bonds=table(
            ("", "tension", "shear", "energy", "momentum", "angular momentum"),
            bonds,
        ),
    )


def run(scenario: carom.Scenario) -> carom.Result:
    """Run a case to nowhere that lasts."""
    return carom.run(scenario, out=Path(tempfile.mkdtemp()) / "results")


def closed_forms(dimension: int) -> tuple[float, float, float]:
    """Return the errors of a block that is pulled off, slides down and is pushed."""
    area = cohesive.area(dimension)
    limit = STRESS * area
    scenario = cohesive.pulled_off(dimension, STRESS, limit, condition="gap")
    force = np.abs(run(scenario).history["block.top.force_" + "xyz"[dimension - 1]])
    wanted = (1 - cohesive.NEAR) * limit
    pulled = max(abs(force[1] / wanted - 1.0), force[2] / wanted)
    history = run(cohesive.on_an_incline(dimension, ANGLE, FRICTION, 2.0 / area)).history
    resists = FRICTION * (cohesive.GRAVITY * np.cos(ANGLE) + 2.0)
    way = 0.5 * (cohesive.GRAVITY * np.sin(ANGLE) - resists) * history["time"] ** 2
    found = history["block.x"] - history["block.x"][0]
    slid = np.abs(found - way).max() / way[-1]
    history = run(cohesive.sheared(dimension, FRICTION, STRESS, condition="gap")).history
    along = np.abs(history["block.top.force_x"])[-3:]
    wanted = FRICTION * (np.abs(history["normal_force"])[-3:] + limit)
    return pulled, slid, np.abs(along / wanted - 1.0).max()


def patches(dimension: int) -> list[float]:
    """Return the errors of the patch test in tension and shear."""
    kinds = ("tension", "shear")
    results = {kind: run(cohesive.patch(dimension, kind)) for kind in kinds}
    return [cohesive.patch_error(results[kind], dimension, kind) for kind in kinds]


def flight(dimension: int) -> list[float]:
    """Return how far energy, momentum and angular momentum vary in flight."""
    divisions = cohesive.UNLIKE[dimension]
    history = run(cohesive.tumbling(dimension, divisions, discretisation="mortar")).history

    def varies(start: str) -> float:
        columns = [history[name] for name in history if name.startswith(start)]
        return max(np.ptp(column) for column in columns) / np.abs(columns).max()

    return [varies("total"), varies("momentum"), varies("angular_momentum")]
