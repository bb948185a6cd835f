"""Which numbers of the history are only bounded, or believed, by what is stored."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from carom.auditing.arrays import AXES, Mask, turning_components
from carom.auditing.checks.events import PINNED
from carom.auditing.model import AuditModel
from carom.auditing.records.rows import Rows
from carom.auditing.report import Findings

EVERY_FRAME = "output.fields_every = the time step, with output.audit = true"
EVERY_ROW = "output.history_every = the time step"


def leave_rows(
    model: AuditModel,
    findings: Findings,
    rows: Rows,
    *,
    frames: Collection[float],
    stored: Collection[float],
    turning: Mask,
    pressing: Mask,
) -> None:
    """Say which numbers of the rows are not determined by anything else.

    Parameters
    ----------
    model
        The model.
    findings
        Where it goes.
    rows
        The history.
    frames, stored
        Times of frames, and of stored steps [s].
    turning
        Rows whose angular momentum is known without a frame, [row_count].
    pressing
        Rows whose normal force is known without a stored step, [row_count].
    """
    after = np.arange(len(rows)) > 0
    unseen = after & ~np.isin(rows.times, list(frames))
    unstored = after & ~np.isin(rows.times, list(stored))
    several = unseen & ~rows.single
    bodies = [body.name for body in model.bodies]

    def leave(where: Mask, what: str, *columns: str, store: str) -> None:
        if where.any():
            # Rows at output times are only named where they have the same want.
            at = "" if (where & ~unseen).any() else ", between output times"
            findings.leave(what, *(f"history.csv: {name}{at}" for name in columns), store=store)

    leave(
        unseen,
        "spins of rows between output times",
        *(
            column
            for name in bodies
            for column in turning_components(f"{name}.spin", model.dimension)
        ),
        store=EVERY_FRAME,
    )
    leave(
        unseen & ~turning,
        "angular momentum of rows between output times that the scheme does not keep, or that "
        "obstacles change",
        *turning_components("angular_momentum", model.dimension),
        store=EVERY_FRAME,
    )
    touching = rows.history["contacts"] > 0
    leave(
        unstored & touching,
        "how many contacts make up the force of a row without a stored step",
        "contacts",
        store=EVERY_FRAME,
    )
    leave(
        unstored & touching & ~pressing,
        f"normal forces of rows without a stored step, known no better than to {PINNED:.1%}",
        "normal_force",
        store=EVERY_FRAME,
    )
    leave(unseen, "smallest gaps of rows between output times", "min_gap", store=EVERY_FRAME)
    leave(
        after,
        "how deep edges were in one another, and nodes between output times",
        "penetration",
        store="",
    )
    leave(
        after,
        "certificates and residuals of rows, round-off that those of the summary bound",
        "certificate",
        "residual",
        *(("friction_defect",) if "friction_defect" in rows.history else ()),
        store="",
    )
    if model.stabilised:
        leave(
            rows.history["retried_steps"] > 0,
            "steps with inertia from one equilibrium to another, but for their sums",
            store="",
        )
    if model.coheres:
        leave(
            unstored,
            "how many contacts hold in rows without a stored step",
            "holding",
            store=EVERY_FRAME,
        )
    if model.blended:
        leave(unstored, "blends of rows without a stored step", "blend", store=EVERY_FRAME)
    leave(
        several,
        "motion in rows of several steps, where steps were halved or have no row",
        *(f"{name}.{axis}" for name in bodies for axis in AXES[: model.dimension]),
        *(
            f"{name}.{quantity}_{axis}"
            for name, _ in model.tracks()
            for quantity in ("u", "v", "vmid")
            for axis in AXES[: model.dimension]
        ),
        store=EVERY_ROW,
    )
    leave(
        after & ~rows.single,
        "the largest defect and the shortest step of rows of several steps",
        "step_defect",
        "shortest_step",
        store=EVERY_ROW,
    )
