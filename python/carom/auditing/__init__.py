"""An audit of results: what a run has stored, checked by code that shares nothing with its core.

Energies, momenta, stresses, gaps, closest points and every equation of the stored steps are
computed here with NumPy alone, from the case and the stored states. docs/audit.md lists the checks.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from carom.auditing.checks.believed import leave_rows
from carom.auditing.checks.case import (
    check_files,
    check_given,
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
from carom.auditing.records.files import Files, Frame
from carom.auditing.records.parts import Part, parts_of
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
    if any(a == b for a, b in (pair["between"] for pair in files.summary["pairs"])):
        raise InputError("cannot audit a body in contact with itself yet")
    parts = parts_of(files)
    models = [part.model for part in parts]
    scales = [Scales(model) for model in models]
    frames = []
    for frame in files.frames():
        own = scales[_stage_at(parts, frame.time)]
        own.include(frame.displacement, frame.velocity, frame.time)
        frames.append(frame.time)
    for own in scales:
        own.share(scales)
    check_files(files.path, files.summary, findings)
    check_mesh(models[0], findings)
    check_materials(models[0], files.materials(), findings)
    stages = [_Stage(part, own, findings) for part, own in zip(parts, scales, strict=True)]
    whole = LedgerChecks(
        models[-1], scales[-1], findings, files.ledger, history=files.history, summary=files.summary
    )
    whole.books()
    _check_states(files, stages, whole, findings)
    stored = {time: pairs for stage in stages for time, pairs in stage.steps.pressed.items()}
    rows = Rows.joined([part.rows for part in parts], files.history, files.summary)
    SummaryChecks(parts, scales[-1], findings, rows, files.summary).all()
    check_warnings(models, files.summary, findings)
    contacts = EventChecks(
        list(zip(parts, scales, strict=True)),
        findings,
        rows,
        ledger=files.ledger,
        summary=files.summary,
        stored=stored,
    )
    contacts.all()
    for stage in stages:
        part = stage.part
        RowChecks(part.model, stage.scales, findings, part.rows, part.summary).all()
        momenta = MomentumChecks(
            part.model, stage.scales, findings, part.rows, files.summary["contacts"]
        )
        momenta.all()
        leave_rows(
            part.model,
            findings,
            part.rows,
            frames=frames,
            stored=stored,
            turning=momenta.angular,
            pressing=contacts.known[part.first : part.first + len(part.rows)],
        )


class _Stage:
    """The checks of a stage that go from state to state."""

    def __init__(self, part: Part, scales: Scales, findings: Findings) -> None:
        self.part, self.model, self.scales = part, part.model, scales
        self.frames = FrameChecks(part.model, scales, findings)
        self.steps = StepChecks(part.model, scales, findings)
        self.ledger = LedgerChecks(
            part.model,
            scales,
            findings,
            part.ledger,
            history=part.rows.history,
            summary=part.summary,
            gives=len(part.model.stage.velocities) > 0,
        )
        self.ledger.all()

    def begin(self, frame: Frame, before: _Stage | None) -> None:
        """Take the frame that the stage starts with."""
        for index, (body, supports) in enumerate(
            zip(self.model.bodies, self.model.supports, strict=True)
        ):
            held = None if before is None else before.model.supports[index]
            supports.begin(frame.displacement[body.span], frame.time, held)
        if before is not None:
            self.ledger.frame(frame)
            self.steps.go_on(before.steps)


def _stage_at(parts: Sequence[Part], time: float) -> int:
    """Return the stage that a time [s] is of; the end of one is its own."""
    ends = [part.model.stage.end_time for part in parts]
    return min(int(np.searchsorted(ends, time)), len(parts) - 1)


def _check_states(
    files: Files, stages: Sequence[_Stage], whole: LedgerChecks, findings: Findings
) -> None:
    """Check the frames, and with each the stored step that ended there."""
    one_way = not any(stage.model.gives_back for stage in stages)
    growing = one_way or files.summary["least_friction"] >= 0
    first = stages[0]
    surface = SurfaceChecks(first.model, first.scales, findings, files.facets(), growing=growing)
    surfaces = files.surface_frames()
    rows = {float(time): index for index, time in enumerate(files.history["time"])}
    stored = files.steps()
    before: Frame | None = None
    parts, number = [stage.part for stage in stages], 0
    for frame in files.frames():
        if before is None:
            first.begin(frame, None)
            check_start(first.model, frame, first.scales, findings)
        while number < _stage_at(parts, frame.time):
            number += 1
            if before is not None:
                stages[number].begin(before, stages[number - 1])
        stage = stages[number]
        row = files.row(rows[frame.time]) if frame.time in rows else None
        stage.frames.frame(frame, row)
        stage.ledger.frame(frame)
        surface.frame(next(surfaces, None), frame, row, whole.friction_on)
        if before is not None and files.has_steps:
            step = next(stored, None)
            given = np.zeros(len(frame.velocity), dtype=bool)
            if step is not None:
                given = check_given(stage.model, step, before, stage.scales, findings)
            status = files.summary["status"]
            check_links(step, frame, before, status, findings, given=given)
            if step is not None:
                checked = Step(stage.model, step)
                stage.steps.step(checked)
                if not given.any():
                    stage.ledger.step(checked)
                surface.borne(checked.touching.all, frame, stage.steps.turn(checked))
                if row is not None:
                    # What bodies are given is of the step in the rows, too.
                    at = None if given.any() else rows.get(checked.start["time"])
                    stage.steps.rows(checked, None if at is None else files.row(at), row)
        before = frame
    if next(surfaces, None) is not None:
        findings.check("surface: frames", 1.0, 0.0, "more frames than of the bodies")
    if not files.has_steps:
        findings.leave(
            "equations of motion, reactions, Coulomb's law: run with output.audit = true"
        )
    elif next(stored, None) is not None:
        findings.check("stored steps", 1.0, 0.0, "more steps than frames")
