from pathlib import Path

from rich.console import Console

from carom.tables import summary_table


def printed(*, max_defect=0.0, min_gap=None, cross_check=None):
    energy = {"initial": 4.0, "final": 3.0, "friction": 0.9, "external": 1.0, "max_drift": 1.0}
    summary = {
        "title": "Drop",
        "status": "completed",
        "end_time": 1.0,
        "steps": 1000,
        "dofs": 8,
        "size": 2.0,
        "min_gap": min_gap,
        "wall_s": 0.1,
        "wall_s_per_step": 1e-4,
        "energy": energy | {"max_defect": max_defect},
        "certificate": {"max_joule": 1e-15, "tolerance_joule": 1e-9},
        "cross_check": cross_check,
        "contacts": [],
    }
    console = Console(width=200)
    with console.capture() as capture:
        console.print(summary_table(summary, where=Path("results")))
    return capture.get()


def test_books_that_miss_much_of_the_energy_are_warned_of():
    assert "misses 0.1 of the energy" in printed(max_defect=0.5)
    assert "warning" not in printed(max_defect=0.05)


def test_nodes_deep_inside_what_they_touch_are_warned_of():
    assert "up to 0.5 m inside" in printed(min_gap=-0.5)
    assert "warning" not in printed(min_gap=-0.01)


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


def test_a_second_opinion_is_shown_and_warns_where_it_is_another_one():
    assert "cross-check" not in printed()
    text = printed(cross_check=AGREED)
    assert "70 contact problems solved again by gauss-seidel and proximal" in text
    assert "warning" not in text
    differing = printed(cross_check={**AGREED, "disagreements": 3})
    assert "3 of 70 contact problems have a second answer" in differing
    assert "t = 0.25 s" in differing
    unsolved = printed(cross_check={**AGREED, "unsolved": 2})
    assert "2 of 70 contact problems were not solved by the second solver" in unsolved
    nothing = {**AGREED, "problems": 0, "solvers": {}, "max_difference": 0.0, "time_of_max": None}
    assert "no contact problem to solve again" in printed(cross_check=nothing)
