"""Checks of the warnings of the summary: what gave rise to them, and that none is missing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from carom.auditing.model import AuditModel
from carom.auditing.records.numbers import number
from carom.auditing.report import Findings
from carom.auditing.steps.scales import EPS, ROUND_OFF, SAFETY

LARGE_DEFECT = 0.02
"""Share of the energy that the ledger may miss without a word."""

MUCH_REPAID = 0.02
"""Share of the energy that vibrations may take or give without a word."""

AT_REST = 1e-9
"""Share of the work that reactions prevent in a step below which defects are round-off."""

Figures = tuple[float, float]
"""What a number is, and what it may be."""


def check_warnings(
    models: Sequence[AuditModel], summary: Mapping[str, Any], findings: Findings
) -> None:
    """Check the warnings of a summary by its other numbers and the case.

    Parameters
    ----------
    models
        The models of the stages.
    summary
        What ``summary.json`` says; one without warnings is of a version that wrote none.
    findings
        Where what is found goes.
    """
    if "warnings" not in summary:
        return
    written = {warning["code"]: warning for warning in summary["warnings"]}
    for code, where, (value, allowed) in _due(summary):
        warned = written.pop(code, None)
        findings.check("summary: warnings", float((value > allowed) != bool(warned)), 0.0, code)
        if warned:
            _compare(findings, code, warned, (value, allowed))
            findings.check("summary: warnings", float(warned["where"] != where), 0.0, code)
    for code, warning in written.items():
        if code == "coarse-step":
            steps = [model.analysis.time_step for model in models]
            step = min(steps, key=lambda one: abs(one - number(warning["value"])))
            _compare(findings, code, warning, (step, float(warning["allowed"] or 0.0)))
        elif code == "wave-speed":
            speeds = [body.law.wave_speed for body in models[0].bodies if body.carries_waves]
            error = min(abs(speed / number(warning["value"]) - 1) for speed in speeds)
            findings.check("summary: warnings", error, ROUND_OFF, code)
        findings.leave("what warnings say of the case", "summary.json: warnings")
    if summary["warnings"]:
        findings.leave("the wording of warnings", "summary.json: warnings")


def _due(summary: Mapping[str, Any]) -> Iterator[tuple[str, str, Figures]]:
    """Yield the codes of what other numbers of the summary decide, where, and the figures."""
    energy = summary["energy"]
    supplied = sum(abs(energy[name]) for name in ("initial", "external", "prescribed"))
    reference, defect = max(supplied, energy["max_drift"]), energy["max_defect"]
    parts = (defect, summary.get("repaid", 0.0))
    share, repaid = (
        part / reference if reference > 0 else (float("inf") if part > 0 else 0.0) for part in parts
    )
    held = summary["certificate"].get("reference_joule")
    if held is None or defect > AT_REST * held:
        yield "ledger-defect", "energy.max_defect", (share, LARGE_DEFECT)
    yield "much-repaid", "repaid", (repaid, MUCH_REPAID)
    worst = summary["penetration"]["worst"] or {"depth": 0.0, "allowed": 0.0}
    yield "penetration", "penetration.worst", (worst["depth"], worst["allowed"])
    free = summary.get("free_motion") or {"driving": 0.0}
    yield "free-motion", "free_motion.driving", (free["driving"], 0.0)
    second = summary["cross_check"] or {"disagreements": 0, "unsolved": 0}
    for code, key in (("contact-not-unique", "disagreements"), ("contact-unchecked", "unsolved")):
        yield code, f"cross_check.{key}", (float(second[key]), 0.0)


def _compare(findings: Findings, code: str, warning: Mapping[str, Any], figures: Figures) -> None:
    for key, figure in zip(("value", "allowed"), figures, strict=True):
        error = number(warning[key]) - figure
        off = SAFETY * EPS * abs(figure)
        findings.check("summary: warnings", error, off, f"{code}, {key}")
