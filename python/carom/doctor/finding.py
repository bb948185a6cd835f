"""What the doctor finds."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, Literal

Level = Literal["ok", "advice", "warning", "error"]
"""How grave a finding is: nothing to do, could be better, probably not meant, cannot run."""

LEVELS: tuple[Level, ...] = ("ok", "advice", "warning", "error")
"""From the least to the most grave."""


@dataclass(frozen=True)
class Finding:
    """One thing about a case, in plain language.

    Parameters
    ----------
    level
        How grave it is.
    key
        Dotted key of the case file that it is about.
    what
        The fact.
    remedy
        What to do about it; empty where there is nothing to do.
    """

    level: Level
    key: str
    what: str
    remedy: str = ""


@dataclass(frozen=True)
class Diagnosis:
    """All that the doctor has found.

    Parameters
    ----------
    title
        Title of the case.
    findings
        What was found, in the order of the examination.
    """

    title: str
    findings: tuple[Finding, ...]

    @property
    def worst(self) -> Level:
        """The level of the gravest finding."""
        return max((finding.level for finding in self.findings), key=LEVELS.index, default="ok")

    def as_dict(self) -> dict[str, Any]:
        """Return the same as plain data."""
        return {
            "title": self.title,
            "worst": self.worst,
            "findings": [asdict(finding) for finding in self.findings],
        }
