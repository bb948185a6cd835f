"""What the run takes: unknowns, memory, time and space on the disk."""

from __future__ import annotations

import math
import os
import sys
import time
from collections.abc import Iterator

from carom.display.counting import count
from carom.doctor.finding import Finding
from carom.doctor.patient import Patient
from carom.errors import ConvergenceError

TRIAL = 1.0
"""Wall time for the steps that are taken to measure one [s]."""

LONG = 3600.0
"""Run time that is worth a word [s]."""

LARGE_OUTPUT = 2e9
"""Size of the fields that is worth a word [byte]."""

HIGH_SHARE = 0.7
"""Share of the machine's memory above which a run is in danger."""

NODE_VALUES = 9
"""Numbers per node in a frame: displacement, velocity and reaction as vectors in space."""

CELL_VALUES = 14
"""Numbers per cell in a frame: stress, strain, energy and plastic strain."""


def cost(patient: Patient) -> Iterator[Finding]:
    """Take a few steps and say what the whole run will take; last, as it moves the case."""
    simulation, steps = patient.simulation, patient.description["steps"]
    start = time.perf_counter()
    try:
        simulation.advance(patient.scenario.end_time, TRIAL)
    except ConvergenceError as error:
        stage = patient.stages[simulation.stage]
        yield Finding(
            "error",
            f"{stage.key}analysis.time_step",
            f"the trial failed at step {simulation.step + 1}: {error}",
            "take a shorter step, or check materials and "
            + ("velocities" if stage.is_dynamic else "how loads and supports grow"),
        )
        return
    taken = max(simulation.step, 1)
    each = (time.perf_counter() - start) / taken
    total = each * steps
    memory = _peak_memory()
    fact = (
        f"{count(patient.description['dofs'], 'unknown')}, {count(steps, 'step')}; about "
        f"{_duration(total)} here by the first {count(taken, 'step')} ({1e3 * each:.3g} ms each; "
        "steps in contact take longer)"
    )
    yield Finding(
        "advice" if total > LONG else "ok",
        "analysis",
        fact,
        "take larger cells or steps, or a shorter run, to try things out" if total > LONG else "",
    )
    if memory is not None:
        yield _memory(memory)
    yield from _output(patient)


def _memory(used: float) -> Finding:
    there = _machine_memory()
    fact = f"about {used / 1e9:.2g} GB of memory"
    if there is not None and used > HIGH_SHARE * there:
        remedy = "take larger cells: a run that outgrows the memory is killed by the system"
        return Finding("warning", "bodies", f"{fact} of {there / 1e9:.3g} GB here", remedy)
    return Finding("ok", "bodies", fact)


def _output(patient: Patient) -> Iterator[Finding]:
    frames = 1 + sum(math.ceil(s.duration / s.fields_every) for s in patient.stages)
    bodies = patient.description["bodies"]
    values = sum(NODE_VALUES * b["nodes"] + CELL_VALUES * b["cells"] for b in bodies)
    size = 8.0 * frames * values
    fact = f"{frames:,} frames of fields, up to {size / 1e6:.3g} MB"
    if size > LARGE_OUTPUT:
        longest = max(stage.duration for stage in patient.stages)
        remedy = f"take fields_every = {longest / 200:.2g}, 200 frames"
        yield Finding("warning", "output.fields_every", fact, remedy)
    else:
        yield Finding("ok", "output.fields_every", fact)


def _duration(seconds: float) -> str:
    if seconds < 120:
        return f"{max(seconds, 0.1):.2g} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"


def _peak_memory() -> float | None:
    """Return the most that this process has used [byte], None where that is not told."""
    try:
        import resource  # noqa: PLC0415 (not on Windows)
    except ImportError:
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return float(peak) * (1.0 if sys.platform == "darwin" else 1024.0)


def _machine_memory() -> float | None:
    """Return how much memory there is [byte], None where that is not told."""
    try:
        return float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (AttributeError, ValueError, OSError):
        return None
