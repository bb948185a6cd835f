"""Checks of all states of a run: frame after frame, with the stored steps that end there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from carom.auditing.checks.case import check_given, check_links, check_start
from carom.auditing.checks.frames import FrameChecks
from carom.auditing.checks.ledger import LedgerChecks
from carom.auditing.checks.steps import StepChecks
from carom.auditing.checks.surface import SurfaceChecks
from carom.auditing.model import Begun
from carom.auditing.records.files import Files, Frame
from carom.auditing.records.parts import Part
from carom.auditing.report import Findings
from carom.auditing.steps.scales import Scales
from carom.auditing.steps.step import Step


class StageChecks:
    """The checks of a stage that go from state to state.

    Parameters
    ----------
    part, scales
        The stage, and its magnitudes.
    findings
        Where what is found goes.
    """

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

    def begin(self, frame: Frame, before: StageChecks | None) -> None:
        """Take the frame that the stage starts with."""
        self.model.begun = (
            Begun(frame.displacement, frame.time) if before is None else before.model.begun
        )
        for index, (body, supports) in enumerate(
            zip(self.model.bodies, self.model.supports, strict=True)
        ):
            held = None if before is None else before.model.supports[index]
            supports.begin(frame.displacement[body.span], frame.time, held)
            if before is not None:
                body.law.go_on(before.model.bodies[index].law)
        if before is not None:
            self.ledger.frame(frame)
            self.steps.go_on(before.steps)

    def forgets(self, frame: Frame, before: Frame, step: Mapping[str, Any] | None) -> bool:
        """Return whether something has flowed that no stored step since a frame tells of."""
        if not any(body.law.flows for body in self.model.bodies) or not frame.plastic_strain.any():
            return False
        return step is None or float(step["start"]["time"]) != before.time

    def advance(self, frame: Frame) -> None:
        """Let bodies remember what flowed up to a frame."""
        for body in self.model.bodies:
            body.advance(frame.displacement[body.span], body.growth.at(frame.time))


def stage_at(parts: Sequence[Part], time: float) -> int:
    """Return the stage that a time [s] is of; the end of one is its own."""
    ends = [part.model.stage.end_time for part in parts]
    return min(int(np.searchsorted(ends, time)), len(parts) - 1)


class StateChecks:
    """Checks of frames and of stored steps.

    Parameters
    ----------
    files
        The results.
    stages
        The checks of every stage.
    whole
        Those of the books of the whole run.
    findings
        Where what is found goes.
    """

    def __init__(
        self,
        files: Files,
        stages: Sequence[StageChecks],
        whole: LedgerChecks,
        findings: Findings,
    ) -> None:
        self._files, self._stages, self._whole, self._findings = files, stages, whole, findings
        one_way = not any(stage.model.gives_back for stage in stages)
        growing = one_way or files.summary["least_friction"] >= 0
        first = stages[0]
        self._surface = SurfaceChecks(
            first.model, first.scales, findings, files.facets(), growing=growing
        )
        self._rows = {float(time): index for index, time in enumerate(files.history["time"])}

    def all(self) -> None:
        """Check everything."""
        files, findings = self._files, self._findings
        surfaces, stored = files.surface_frames(), files.steps()
        before: Frame | None = None
        for stage, frame in self._staged():
            step = next(stored, None) if before is not None else None
            if before is not None and stage.forgets(frame, before, step):
                findings.leave(
                    "states once metal has flowed between stored steps",
                    store="output.fields_every = the time step, with output.audit = true",
                )
                return
            row = self._row(frame.time)
            stage.frames.frame(frame, row)
            stage.ledger.frame(frame)
            self._surface.frame(next(surfaces, None), frame, row, self._whole.friction_on)
            if before is not None and files.has_steps:
                self._step(stage, step, frame, before)
            stage.advance(frame)
            before = frame
        if next(surfaces, None) is not None:
            findings.check("surface: frames", 1.0, 0.0, "more frames than of the bodies")
        if not files.has_steps:
            findings.leave(
                "equations of motion, reactions, Coulomb's law: run with output.audit = true"
            )
        elif next(stored, None) is not None:
            findings.check("stored steps", 1.0, 0.0, "more steps than frames")

    def _staged(self) -> Iterator[tuple[StageChecks, Frame]]:
        """Yield the frames, each with its stage, which has begun."""
        parts, number = [stage.part for stage in self._stages], 0
        before: Frame | None = None
        for frame in self._files.frames():
            if before is None:
                first = self._stages[0]
                first.begin(frame, None)
                check_start(first.model, frame, first.scales, self._findings)
            while number < stage_at(parts, frame.time):
                number += 1
                if before is not None:
                    self._stages[number].begin(before, self._stages[number - 1])
            yield self._stages[number], frame
            before = frame

    def _row(self, time: float) -> dict[str, float] | None:
        """Return the row of the history of a time [s], if there is one."""
        index = self._rows.get(time)
        return None if index is None else self._files.row(index)

    def _step(
        self, stage: StageChecks, step: Mapping[str, Any] | None, frame: Frame, before: Frame
    ) -> None:
        """Check the stored step that ended at a frame."""
        findings, status = self._findings, self._files.summary["status"]
        given = np.zeros(len(frame.velocity), dtype=bool)
        if step is not None:
            given = check_given(stage.model, step, before, stage.scales, findings)
        read = np.zeros(len(given), dtype=bool)
        for body in stage.model.bodies:
            read[body.span] = body.modes is not None
        check_links(step, frame, before, status, findings, given=given, read=read)
        if step is None:
            return
        checked = Step(stage.model, step)
        stage.steps.step(checked)
        if not (given.any() or checked.settles):
            stage.ledger.step(checked)
        self._surface.borne(checked.touching.all, frame, stage.steps.turn(checked))
        row = self._row(frame.time)
        if row is not None:
            # What bodies are given is of the step in the rows, too.
            alone = not (given.any() or checked.settles)
            start = self._row(float(checked.start["time"])) if alone else None
            stage.steps.rows(checked, start, row)
