import re
from pathlib import Path

from rich.console import Console

from carom.results.outcome import summary_table


def printed(*, cross_check=None, **more):
    energy = {"initial": 4.0, "final": 3.0, "friction": 0.9, "external": 1.0, "max_drift": 1.0}
    summary = {
        "title": "Drop",
        "status": "completed",
        "end_time": 1.0,
        "steps": 1000,
        "dofs": 8,
        "size": 2.0,
        "min_gap": None,
        "wall_s": 0.1,
        "wall_s_per_step": 1e-4,
        "energy": energy | {"max_defect": 0.0},
        "certificate": {"max_joule": 1e-15, "tolerance_joule": 1e-9},
        "cross_check": cross_check,
        "contacts": [],
        **more,
    }
    console = Console(width=200)
    with console.capture() as capture:
        console.print(summary_table(summary, where=Path("results")))
    return capture.get()


def test_the_warnings_of_the_summary_are_shown():
    one = {"code": "deep", "message": "[far] inside", "where": "min_gap"}
    shown = printed(warnings=[{**one, "value": 1.0, "allowed": 0.5}])
    assert re.search(r"warning +│ \[far\] inside", shown)
    assert "warning" not in printed(warnings=[])
    assert "warning" not in printed()


AGREED = {
    "problems": 70,
    "solvers": {"gauss-seidel": 10, "proximal": 60},
    "unsolved": 0,
    "disagreements": 0,
    "max_difference": 1e-12,
    "explained_difference": 1e-5,
    "time_of_max": 0.25,
    "max_certificate_joule": 1e-15,
}


def test_a_second_opinion_is_shown():
    assert "cross-check" not in printed()
    text = printed(cross_check=AGREED)
    assert "70 contact problems solved again by gauss-seidel and proximal" in text
    nothing = {**AGREED, "problems": 0, "solvers": {}, "max_difference": 0.0, "time_of_max": None}
    assert "no contact problem to solve again" in printed(cross_check=nothing)
