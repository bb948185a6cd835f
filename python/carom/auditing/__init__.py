"""An audit of results: what a run has stored, checked by code that shares nothing with its core.

Energies, momenta, stresses, gaps, closest points and every equation of the stored steps are
computed here with NumPy alone, from the case and the stored states. docs/audit.md lists the checks.
"""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

import numpy as np

from carom.auditing.bodies.code import Code
from carom.auditing.checks.believed import leave_rows
from carom.auditing.checks.case import check_files, check_materials, check_mesh
from carom.auditing.checks.codes import leave_codes
from carom.auditing.checks.events import EventChecks
from carom.auditing.checks.ledger import LedgerChecks
from carom.auditing.checks.momenta import MomentumChecks
from carom.auditing.checks.rows import RowChecks
from carom.auditing.checks.states import StageChecks, StateChecks, stage_at
from carom.auditing.checks.summary import SummaryChecks
from carom.auditing.checks.warnings import check_warnings
from carom.auditing.records.files import Files
from carom.auditing.records.parts import parts_of
from carom.auditing.records.rows import Rows
from carom.auditing.report import Audit, Check, Findings, Unchecked
from carom.auditing.steps.scales import Scales
from carom.errors import InputError

__all__ = ["Audit", "Check", "Unchecked", "audit"]


def audit(directory: str | PathLike[str], *, bodies: Sequence[Code] = ()) -> Audit:
    """Check the results of a run.

    Parameters
    ----------
    directory
        A results directory, or the `Result` of one. With ``output.audit = true`` in its case the
        equations of the stored steps are checked, without it the states at output times and the
        books.
    bodies
        Every `carom.ForeignBody` of the run again, whose law no file holds. What depends on that of
        one which is not given cannot be checked, and is said not to be.

    Raises
    ------
    InputError
        The directory holds no results of a run that has ended, or of a kind that the auditor does
        not know; or a body is none of the run.
    """
    return audit_files(Files(Path(directory), bodies))


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
    parts = parts_of(files)
    models = [part.model for part in parts]
    scales = [Scales(model) for model in models]
    frames = []
    for frame in files.frames():
        own = scales[stage_at(parts, frame.time)]
        own.include(frame.displacement, frame.velocity, frame.time)
        frames.append(frame.time)
    for part, own in zip(parts, scales, strict=True):
        own.believe(part.rows.history)
    for own in scales:
        own.share(scales)
    certified = sum(float(part.rows.certified.sum()) for part in parts)
    reference = files.summary["certificate"].get("reference_joule", 0.0)
    force = float(files.history["normal_force"].max())
    for own in scales:
        own.certify(certified, reference, force)
    check_files(files.path, files.summary, findings)
    check_mesh(models[0], findings)
    check_materials(models[0], files.materials(), findings)
    stages = [StageChecks(part, own, findings) for part, own in zip(parts, scales, strict=True)]
    whole = LedgerChecks(
        models[-1], scales[-1], findings, files.ledger, history=files.history, summary=files.summary
    )
    whole.books()
    StateChecks(files, stages, whole, findings).all()
    stored = {time: pairs for stage in stages for time, pairs in stage.steps.pressed.items()}
    rows = Rows.joined([part.rows for part in parts], files.history, files.summary)
    SummaryChecks(parts, scales[-1], findings, rows, files.summary).all()
    check_warnings(models, files.summary, findings)
    leave_codes(models[0], findings)
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
        momenta = MomentumChecks(part.model, stage.scales, findings, part.rows, files.summary)
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
