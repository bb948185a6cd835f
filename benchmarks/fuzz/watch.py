"""Running many attempts in processes that may hang or die."""

from __future__ import annotations

import multiprocessing
import os
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from multiprocessing.sharedctypes import Synchronized
from pathlib import Path
from queue import Empty
from typing import Any

from fuzz.attempt import Defect, attempt
from fuzz.subjects import SUBJECTS

PATIENCE = 60.0
"""Time for one attempt, after which it hangs [s]; commands need milliseconds."""

MEMORY = 8 * 2**30
"""Address space of a process [byte]: what asks for more is a defect, not the end of the machine."""

CHUNK = 1000
"""Attempts of one process."""


REPORT = 50
"""Answers after which a process tells them: those since are lost if it dies."""


@dataclass
class Tally:
    """What came out.

    Parameters
    ----------
    outcomes
        How many attempts were answered how.
    defects
        The seeds of the others and what happened.
    """

    outcomes: Counter[str] = field(default_factory=Counter)
    defects: dict[int, str] = field(default_factory=dict)


def search(subject: str, seeds: range) -> Tally:
    """Attempt every seed of a subject."""
    tally = Tally()
    first = seeds.start
    while first < seeds.stop:
        chunk = range(first, min(first + CHUNK, seeds.stop))
        first = _watched(subject, chunk, tally)
    return tally


def _watched(subject: str, seeds: range, tally: Tally) -> int:
    """Attempt seeds in a process; return the first one that is left."""
    context = multiprocessing.get_context("fork")
    current, said = context.Value("q", seeds.start), context.Queue()
    worker = context.Process(target=_attempts, args=(subject, seeds, current, said))
    worker.start()
    seen, since = seeds.start, time.monotonic()
    reason = ""
    while True:
        try:
            kind, seed, text = said.get(timeout=1.0)
        except Empty:
            if current.value != seen:
                seen, since = current.value, time.monotonic()
            if not worker.is_alive() and said.empty():
                reason = f"the process died with exit code {worker.exitcode}"
            elif time.monotonic() - since > PATIENCE:
                reason = f"no answer within {PATIENCE:g} s"
                worker.kill()
            if not reason:
                continue
            worker.join()
            tally.defects[current.value] = reason
            return current.value + 1
        if kind == "defect":
            tally.defects[seed] = text
            continue
        tally.outcomes.update(text)
        if kind == "end":
            worker.join()
            return seeds.stop


def _attempts(subject: str, seeds: range, current: Synchronized[int], said: Any) -> None:
    _bound_memory()
    outcomes: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        tried = SUBJECTS[subject](Path(folder))
        for seed in seeds:
            current.value = seed
            try:
                outcomes[attempt(tried.answer, tried.spoilt(seed))] += 1
            except Defect as defect:
                said.put(("defect", seed, str(defect)))
            if len(outcomes) and sum(outcomes.values()) % REPORT == 0:
                said.put(("answers", seed, outcomes))
                outcomes = Counter()
        said.put(("end", 0, outcomes))


def _bound_memory() -> None:
    try:
        import resource  # noqa: PLC0415 (not on Windows)
    except ImportError:
        return
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
