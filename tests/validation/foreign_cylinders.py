"""The paper's two cylinders as bodies of another code, of which carom knows the energy alone."""

from __future__ import annotations

import sys
from pathlib import Path

from cylinders import CONSERVING
from runs import Run, example, simulate

sys.path.insert(0, str(Path(__file__).parents[1]))

from foreign_case import foreign_bodies, with_bodies


def run(*, friction: float, end_time: float = 15.0) -> Run:
    """Run ``examples/two_cylinders.toml`` with triangles of the other code, every step recorded."""
    case = example(
        "two_cylinders.toml",
        f"contact.friction={friction}",
        "contact.condition=midpoint",
        "bodies.0.mesh.cell=tri3",
        "bodies.1.mesh.cell=tri3",
        f"analysis.end_time={end_time}",
        "output.history_every=1e-3",
        *CONSERVING,
    )
    return simulate(with_bodies(case, foreign_bodies(case)))
