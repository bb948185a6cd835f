"""The paper's cylinders as bodies of another code, of which carom knows no law."""

import foreign_cylinders
import pytest


def test_the_books_of_foreign_bodies_close_over_the_first_impact():
    run = foreign_cylinders.run(friction=0.2, end_time=1.8)
    assert len(run.summary["contacts"]) == 1
    assert run.energy("friction") > 0.01
    assert run.energy("max_defect") <= 1e-12
    certificate = run.summary["certificate"]
    assert certificate["max_joule"] <= certificate["tolerance_joule"]


@pytest.mark.long
def test_foreign_bodies_keep_their_energy_over_all_impacts():
    run = foreign_cylinders.run(friction=0.0)
    assert len(run.summary["contacts"]) >= 8
    assert run.energy("max_drift") <= 1e-11


@pytest.mark.long
def test_the_books_of_foreign_bodies_close_with_friction():
    run = foreign_cylinders.run(friction=0.2)
    assert run.energy("friction") > 0.1
    assert run.energy("max_defect") <= 1e-10
