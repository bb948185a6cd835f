"""An audit of results: what a run has stored, checked by code that shares nothing with its core.

Energies, momenta, stresses, gaps, closest points and every equation of the stored steps are
computed here with NumPy alone, from the case and the stored states. docs/audit.md lists the checks.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from carom.auditing.checks.believed import leave_rows
from carom.auditing.checks.case import (
    check_files,
    check_links,
    check_materials,
    check_mesh,
    check_start,
)
from carom.auditing.checks.events import EventChecks
from carom.auditing.checks.frames import FrameChecks
from carom.auditing.checks.ledger import LedgerChecks
from carom.auditing.checks.momenta import MomentumChecks
from carom.auditing.checks.rows import RowChecks
from carom.auditing.checks.steps import StepChecks
from carom.auditing.checks.summary import SummaryChecks
from carom.auditing.checks.surface import SurfaceChecks
from carom.auditing.checks.warnings import check_warnings
from carom.auditing.model import AuditModel
from carom.auditing.records.files import Files, Frame
from carom.auditing.records.rows import Rows
from carom.auditing.report import Audit, Check, Findings, Unchecked
from carom.auditing.steps.scales import Scales
from carom.auditing.steps.step import Step
from carom.errors import InputError

__all__ = ["Audit", "Check", "Unchecked", "audit"]


def audit(directory: str | Path) -> Audit:
    """Check the results of a run.

    Parameters
    ----------
    directory
        A results directory. With ``output.audit = true`` in its case the equations of the stored
        steps are checked, without it the states at output times and the books.

    Raises
    ------
    InputError
        The directory holds no results of a run that has ended, or of a kind that the auditor does
        not know.
    """
    return audit_files(Files(Path(directory)))


def audit_files(files: Files) -> Audit:
    """Check results that have been read; see `audit`."""
    findings = Findings()
    try:
        # Tampered numbers may overflow; what is not finite is found as such.
        with np.errstate(all="ignore"):
            _check(files, findings)
    except InputError:
        raise
    except (KeyError, IndexError, TypeError, ValueError) as error:
        raise InputError(
            f"{files.path}: cannot be audited: {type(error).__name__}: {error}"
        ) from error
    return findings.audit(files.path)


def _check(files: Files, findings: Findings) -> None:
    model = files.model()
    if any(a == b for a, b in (pair["between"] for pair in files.summary["pairs"])):
        raise InputError("cannot audit a body in contact with itself yet")
    scales = Scales(model)
    frames = []
    for frame in files.frames():
        scales.include(frame.displacement, frame.velocity, frame.time)
        frames.append(frame.time)
    check_files(files.path, files.summary, findings)
    check_mesh(model, findings)
    check_materials(model, files.materials(), findings)
    ledger = LedgerChecks(
        model, scales, findings, files.ledger, history=files.history, summary=files.summary
    )
    ledger.all()
    pressed = _check_states(files, model, scales, ledger, findings)
    rows, events = Rows(model, files.history, files.summary), files.summary["contacts"]
    RowChecks(model, scales, findings, rows, files.summary).all()
    SummaryChecks(model, scales, findings, rows, files.summary).all()
    check_warnings(model, files.summary, findings)
    momenta = MomentumChecks(model, scales, findings, rows, events)
    momenta.all()
    contacts = EventChecks(
        model, scales, findings, rows, ledger=files.ledger, summary=files.summary, stored=pressed
    )
    contacts.all()
    leave_rows(
        model,
        findings,
        rows,
        frames=frames,
        stored=pressed,
        turning=momenta.angular,
        pressing=contacts.known,
    )


def _check_states(
    files: Files, model: AuditModel, scales: Scales, ledger: LedgerChecks, findings: Findings
) -> dict[float, dict[frozenset[str], float]]:
    """Check the frames, and with each the stored step that ended there; return forces of pairs."""
    frames = FrameChecks(model, scales, findings)
    steps = StepChecks(model, scales, findings)
    growing = not model.gives_back or files.summary["least_friction"] >= 0
    surface = SurfaceChecks(model, scales, findings, files.facets(), growing=growing)
    surfaces = files.surface_frames()
    rows = {float(time): index for index, time in enumerate(files.history["time"])}
    stored = files.steps()
    before: Frame | None = None
    for frame in files.frames():
        row = files.row(rows[frame.time]) if frame.time in rows else None
        frames.frame(frame, row)
        ledger.frame(frame)
        surface.frame(next(surfaces, None), frame, row, ledger.friction_on)
        if before is None:
            check_start(model, frame, scales, findings)
        elif files.has_steps:
            step = next(stored, None)
            check_links(step, frame, before, files.summary["status"], findings)
            if step is not None:
                checked = Step(model, step)
                steps.step(checked)
                ledger.step(checked)
                surface.borne(checked.touching.all, frame)
                if row is not None:
                    at = rows.get(checked.start["time"])
                    steps.rows(checked, None if at is None else files.row(at), row)
        before = frame
    if next(surfaces, None) is not None:
        findings.check("surface: frames", 1.0, 0.0, "more frames than of the bodies")
    if not files.has_steps:
        findings.leave(
            "equations of motion, reactions, Coulomb's law: run with output.audit = true"
        )
    elif next(stored, None) is not None:
        findings.check("stored steps", 1.0, 0.0, "more steps than frames")
    return steps.pressed
