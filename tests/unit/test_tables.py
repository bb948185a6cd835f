from pathlib import Path

from rich.console import Console

from carom.tables import summary_table


def printed(*, max_defect):
    energy = {"initial": 4.0, "final": 3.0, "friction": 0.9, "external": 1.0, "max_drift": 1.0}
    summary = {
        "title": "Drop",
        "status": "completed",
        "end_time": 1.0,
        "steps": 1000,
        "dofs": 8,
        "wall_s": 0.1,
        "wall_s_per_step": 1e-4,
        "energy": energy | {"max_defect": max_defect},
        "certificate": {"max_joule": 1e-15, "tolerance_joule": 1e-9},
        "contacts": [],
    }
    console = Console(width=100)
    with console.capture() as capture:
        console.print(summary_table(summary, where=Path("results")))
    return capture.get()


def test_books_that_miss_much_of_the_energy_are_warned_of():
    assert "misses 0.1 of the energy" in printed(max_defect=0.5)
    assert "warning" not in printed(max_defect=0.05)
