"""Solvers compared on a folder of contact problems, with another code beside them."""

from carom.friction.bench.case import Case, read_cases
from carom.friction.bench.comparison import Comparison, compare, geometric_mean
from carom.friction.bench.picture import PICTURE, draw_profile
from carom.friction.bench.report import CSV, JSON, MARKDOWN, markdown, parts, write_report
from carom.friction.bench.run import Run, run_solver
from carom.friction.bench.siconos import Siconos

__all__ = [
    "FILES",
    "Case",
    "Comparison",
    "Run",
    "Siconos",
    "compare",
    "draw_profile",
    "geometric_mean",
    "markdown",
    "parts",
    "read_cases",
    "run_solver",
    "write_report",
]

FILES = (MARKDOWN, CSV, JSON, PICTURE)
"""Names of what a comparison is written to."""
