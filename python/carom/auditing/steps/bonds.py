"""Contacts that nothing breaks: their stencils and normals stay those of the start of the run."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.model import AuditModel
from carom.auditing.steps.contacts import Contacts

At = tuple[Array, float]
"""Where nodes are [m], shape [node_count, D], and when [s]."""


def carried(model: AuditModel, tied: Contacts, start: At, now: At, found: Contacts) -> Contacts:
    """Return contacts that were tied at the start where they are now.

    Gaps are what motion has made of those of the start. What is stored of them is what it is of
    the same contacts as they were `found` now.
    """
    shift = np.zeros_like(tied.shift)
    for k, target in enumerate(tied.target):
        if target < 0:
            travel = model.obstacles[-1 - target].travel
            shift[k] = travel.displacement(now[1]) - travel.displacement(start[1])
    gap = tied.gap + tied.relative(now[0] - start[0], shift)[0]
    stored = found.gap_error + found.gap
    return replace(tied, gap=gap, gap_error=stored - gap)
