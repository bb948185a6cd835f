"""The time step: whether waves, impacts and their records are resolved."""

from __future__ import annotations

from collections.abc import Iterator

from carom.building.checking import COARSE_STEP, SPLIT
from carom.case.full_stage import FullStage
from carom.doctor.finding import Finding
from carom.doctor.patient import Patient

FINE_STEP = 0.05
"""Time step, in suggested ones, below which nothing is gained."""

STEPS_PER_IMPACT = 20.0
"""Steps that the shortest impact should take."""

ROWS_PER_IMPACT = 5.0
"""Rows of the history that it should have."""


def time_step(patient: Patient) -> Iterator[Finding]:
    """Compare the steps of every analysis with the time of waves and impacts."""
    for stage in patient.stages:
        yield from _of_stage(patient, stage)


def _of_stage(patient: Patient, stage: FullStage) -> Iterator[Finding]:
    step, length = stage.analysis.time_step, stage.duration
    if abs(length / step - round(length / step)) > SPLIT:
        yield Finding(
            "advice",
            f"{stage.key}analysis.end_time",
            f"{length:g} s is not a whole number of steps of {step:g} s: the last step is shorter",
            f"take end_time = {stage.start_time + round(length / step) * step:.6g}",
        )
    if not stage.is_dynamic:
        return
    key = f"{stage.key}analysis.time_step"
    durations = {
        body["name"]: patient.contact_duration(i)
        for i, body in enumerate(patient.description["bodies"])
        if not body["is_rigid"]
    }
    if not durations:
        # There are no waves in rigid bodies, and their impacts take no time.
        return
    yield _waves(patient, step, key)
    name, shortest = min(durations.items(), key=lambda item: item[1])
    fact = (
        f"the impact of {name} takes about {shortest:.3g} s (a wave through it, there and back): "
        f"{shortest / step:.3g} steps"
    )
    if shortest < STEPS_PER_IMPACT * step:
        yield Finding(
            "warning",
            key,
            fact,
            f"take a time_step of {shortest / STEPS_PER_IMPACT:.2g} s or less to see it",
        )
    else:
        yield Finding("ok", key, fact)
    if stage.history_every > shortest / ROWS_PER_IMPACT:
        yield Finding(
            "advice",
            f"{stage.key}output.history_every",
            f"the history has a row every {stage.history_every:.3g} s, and an impact takes "
            f"{shortest:.3g} s",
            f"take history_every = {max(step, shortest / 50):.2g} to see how forces rise and fall",
        )


def _waves(patient: Patient, step: float, key: str) -> Finding:
    suggested = patient.description["suggested_time_step"]
    ratio = step / suggested
    fact = (
        f"a pressure wave needs {suggested:.3g} s through the shortest edge; the step of {step:g} "
        f"s is {ratio:.3g} times that"
    )
    if ratio > COARSE_STEP:
        remedy = f"take about {suggested:.2g} s, or larger cells, if waves matter"
        return Finding("warning", key, f"{fact}: waves are not resolved", remedy)
    if ratio < FINE_STEP:
        remedy = f"take up to {suggested:.2g} s; a shorter step only costs time"
        return Finding("advice", key, fact, remedy)
    return Finding("ok", key, fact)
