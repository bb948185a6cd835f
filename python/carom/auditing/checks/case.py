"""Checks of what must agree before anything is computed: case and mesh, frames and steps."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask, turned, turning_axes
from carom.auditing.bodies.body import AuditBody
from carom.auditing.drives.supports import Supports
from carom.auditing.model import AuditModel
from carom.auditing.records.files import Frame
from carom.auditing.report import Findings
from carom.auditing.steps.scales import ROUND_OFF, Scales
from carom.io import layout
from carom.io.digest import digest


def check_files(path: Path, summary: Mapping[str, Any], findings: Findings) -> None:
    """Check that case and tables are the files that the run left."""
    if "files" not in summary:
        findings.leave("whether case and tables are those of the run, which wrote no digests")
        return
    for name in layout.DIGESTED:
        same = summary["files"].get(name) == digest(path / name)
        findings.check("files", float(not same), 0.0, name)


def check_mesh(model: AuditModel, findings: Findings) -> None:
    """Check sizes and numbers of cells of the bodies."""
    for body in model.known:
        tolerance = ROUND_OFF * (model.size + float(np.abs(body.points).max()))
        findings.check("mesh", body.drawn.misfit(body.points, body.outline), tolerance, body.name)
        cells = body.drawn.cell_count - len(body.cells.nodes)
        findings.check("mesh", float(cells), 0.0, f"{body.name}, number of cells")


def check_materials(model: AuditModel, stored: Indices | None, findings: Findings) -> None:
    """Check that every cell is of the material that the case says."""
    mine = np.concatenate([body.law.material for body in model.bodies])
    if stored is not None:
        findings.check("materials", stored - mine, 0.0, "fields")
        return
    several = [len(np.unique(body.law.material)) > 1 for body in model.bodies]
    findings.check("materials", float(any(several)), 0.0, "fields have no materials")


def check_start(model: AuditModel, frame: Frame, scales: Scales, findings: Findings) -> None:
    """Check the state at t = 0."""
    initial = model.scenario.initial
    if initial is not None:
        findings.leave("the state that the run starts from, which is that of other files")
        return
    findings.check("initial velocity", frame.displacement, 0.0, "displacement at t = 0")
    for body, supports in zip(model.bodies, model.supports, strict=True):
        if not body.known:
            continue
        wanted = body.initial_velocity() * (not model.static)
        wanted = _as_driven(body, supports, np.zeros_like(wanted), wanted, 0.0)
        error = frame.velocity[body.span] - wanted
        findings.check("initial velocity", error, ROUND_OFF * scales.speed, f"{body.name}, t = 0")


def check_links(
    step: Mapping[str, Any] | None,
    frame: Frame,
    before: Frame,
    status: str,
    findings: Findings,
    *,
    given: Mask,
    read: Mask,
) -> None:
    """Check that a stored step ends at a frame, and starts there if it starts at the one before.

    Nodes with `given` velocities, shape [node_count], have others than before. Those that are
    `read` from others, of reduced bodies, have round-off.
    """
    where = f"t = {frame.time:g} s"
    if step is None:
        # A step that failed leaves no pair behind.
        findings.check("stored steps", float(status != "failed"), 0.0, f"{where}, no step")
        return
    end, start = step["end"], step["start"]
    none = np.zeros(len(given), dtype=bool)
    pairs = [(end, frame, none)]
    if start["time"] == before.time:
        pairs.append((start, before, given))
    findings.check("stored steps", end["time"] - frame.time, 0.0, f"{where}, time")
    for state, fields, others in pairs:
        for name, theirs in (
            ("displacement", fields.displacement),
            ("velocity", fields.velocity),
            ("contact_force", fields.reaction),
        ):
            error = state[name] - theirs
            off = np.where(read, ROUND_OFF * np.abs(theirs).max(), 0.0)[:, None]
            if name == "velocity":
                error, off = error[~others], off[~others]
            findings.check("stored steps", error, off, f"{where}, {name}")


def check_given(
    model: AuditModel, step: Mapping[str, Any], before: Frame, scales: Scales, findings: Findings
) -> Mask:
    """Check the velocities that bodies are given when a stage starts; return whose they are.

    The mask is of nodes, of none where the step is not the first of the stage.
    """
    start, given = step["start"], np.zeros(len(model.points), dtype=bool)
    if start["time"] != before.time or before.time != model.stage.start_time:
        return given
    for entry in model.stage.velocities:
        number = next(i for i, b in enumerate(model.bodies) if b.name == entry.body)
        body, supports = model.bodies[number], model.supports[number]
        u = start["displacement"][body.span]
        spin = np.zeros(turning_axes(model.dimension)) if entry.spin is None else entry.spin
        wanted = turned(body.arms(u), np.atleast_1d(spin))
        wanted = wanted + (0.0 if entry.velocity is None else np.array(entry.velocity))
        given[body.span] = True
        wanted = _as_driven(body, supports, u, wanted, before.time)
        error = start["velocity"][body.span] - wanted
        if not body.rigid:
            error = np.where(supports.held, 0.0, error)
        at = f"{entry.body}, t = {before.time:g} s"
        findings.check("initial velocity", error, ROUND_OFF * scales.speed, at)
    return given


def _as_driven(
    body: AuditBody, supports: Supports, u: Array, velocity: Array, time: float
) -> Array:
    """Return velocities of nodes [m/s] at displacements u [m] with what is given of them then."""
    if supports.guide is None:
        return np.where(supports.held, supports.velocity(time), velocity)
    guiding = supports.guide.at(time)
    along = np.where(guiding.along, guiding.velocity, body.mass.mean(velocity))
    about = np.where(guiding.about, guiding.spin, body.spin(u, velocity))
    driven: Array = along + turned(body.arms(u), about)
    return driven
