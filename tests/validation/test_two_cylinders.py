"""Two cylinders in a rigid box, without and with friction: curves of the prototype until 5 s."""

import cylinders
import pytest

FRICTIONS = (0.0, 0.2)


@pytest.fixture
def frictionless(cylinders_run):
    return cylinders_run(friction=0.0)


@pytest.fixture
def frictional(cylinders_run):
    return cylinders_run(friction=0.2)


def test_first_cylinder_touches_the_floor(frictionless, frictional):
    for run in (frictionless, frictional):
        assert cylinders.first_wall_contact(run) == pytest.approx(1.50, abs=0.01)
        assert cylinders.onset(run, "left", "floor") == cylinders.first_wall_contact(run)


def test_friction_on_the_floor_delays_the_meeting(frictionless, frictional):
    assert cylinders.onset(frictionless, "left", "right") == pytest.approx(2.49, abs=0.03)
    assert cylinders.onset(frictional, "left", "right") == pytest.approx(2.83, abs=0.03)


def test_drift_without_friction_is_that_of_the_gap_condition(frictionless):
    assert 0.005 <= frictionless.energy("max_drift") <= 0.025
    assert frictionless.energy("friction") == 0.0


def test_friction_and_the_other_terms_account_for_the_loss(frictional):
    loss = -frictional.energy_change
    terms = ("friction", "viscous", "scheme", "normal_contact")
    accounted = sum(frictional.energy(term) for term in terms)
    assert accounted == pytest.approx(loss, abs=1e-3)
    assert frictional.energy("max_defect") <= 1e-3


def test_energy_at_the_end_with_friction(frictional):
    assert 1.0 + frictional.energy_change == pytest.approx(0.79, abs=0.02)


def test_energy_never_rises_by_more_than_the_defect(frictional):
    assert frictional.energy_rise <= frictional.energy("max_defect")
    assert frictional.rise_beyond_defect(until=cylinders.COMPARED) <= 1e-12


def test_without_friction_energy_rises_only_while_the_cylinders_touch(frictionless):
    # Within an impact of the two cylinders, normal reactions also do a little positive work
    # (3e-4 of the energy here, 5e-4 in the prototype); those of plane obstacles never do.
    meeting = cylinders.onset(frictionless, "left", "right")
    assert frictionless.rise_beyond_defect(until=meeting) <= 1e-12
    assert frictionless.energy_rise <= frictionless.energy("max_defect")


def test_cylinders_never_penetrate(frictionless, frictional):
    for run in (frictionless, frictional):
        assert run.summary["min_gap"] >= -1e-12


def test_coulombs_law_holds_in_every_step(frictionless, frictional):
    for run in (frictionless, frictional):
        assert run.summary["certificate"]["max_joule"] <= 1e-10


@pytest.mark.parametrize("friction", FRICTIONS)
@pytest.mark.parametrize(
    ("energy", "largest", "rms"),
    [
        # Kinetic and strain energy swap within 0.06 s in an impact, so a lag of one millisecond
        # counts as 1 %; their sum and the friction dissipation do not see it.
        ("E_c", 2e-2, 3e-3),
        ("E_e", 2e-2, 3e-3),
        ("E_t", 2e-3, 3e-4),
        ("D_fric", 2e-3, 3e-4),
    ],
)
def test_energies_follow_the_reference_curves(cylinders_run, friction, energy, largest, rms):
    distance = cylinders.distances(cylinders_run(friction=friction), friction=friction)[energy]
    assert distance.max <= largest
    assert distance.rms <= rms
