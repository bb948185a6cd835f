"""Static contact against closed forms; the table is that of benchmarks/static_references.py."""

import frictional_bed
import o_ring
import pressed
import punches
import pytest
import wedges

import carom


def test_a_block_goes_up_and_down_a_slope_at_the_angle_of_friction():
    up, down = wedges.block_on_a_slope()
    # Measured: 5.1e-11 and 2.0e-10.
    assert abs(up.error) < 5e-10
    assert abs(down.error) < 2e-9
    assert up.iterations < 7


def test_a_wedge_in_a_gap_takes_what_balance_says():
    wedge = wedges.wedge_in_a_gap()
    # Measured: 7.3e-12.
    assert abs(wedge.error) < 7e-11
    assert wedge.iterations < 7


@pytest.mark.parametrize("discretisation", ["node-to-segment", "mortar"])
def test_a_wedge_under_a_weight_takes_what_balance_says_as_it_gets_stiff(discretisation):
    soft, stiff = (wedges.wedge_under_a_weight(discretisation, e) for e in (1e6, 1e8))
    # Measured: 7.6e-6 and 1.0e-5. What is left is strain, which turns the sides: P/(E A) is 1.7e-5.
    assert abs(stiff.error) < 5e-5
    assert abs(stiff.error) < 0.02 * abs(soft.error)


@pytest.mark.parametrize("discretisation", ["node-to-segment", "mortar"])
def test_a_stiff_wedge_under_a_weight_takes_what_rigid_bodies_do(discretisation):
    # Measured: 2.5e-7 and 2.9e-7, what is left of its stiffness.
    assert abs(wedges.wedge_under_a_weight(discretisation, 1e10).error) < 1e-6


def test_a_block_that_a_wedge_holds_is_not_said_not_to_be_held():
    """Symptom guarded against: an iteration that left it in the air was the last one allowed."""
    with pytest.raises(carom.ConvergenceError, match=r"Newton's iterations stopped after 10"):
        wedges.wedge_under_a_weight("node-to-segment", 1e10, max_iterations=10)


def test_a_bar_on_a_rough_bed_takes_the_same_in_every_cycle():
    first, last = frictional_bed.dissipation(100, 50)
    # Measured: 8.1e-4, of the mesh; and 4.9e-9 between the cycles.
    assert abs(last.error) < 2e-3
    assert last.value == pytest.approx(first.value, rel=4e-8)


def test_a_bar_on_a_rough_bed_tends_to_the_closed_form_with_the_mesh():
    coarse, fine = (frictional_bed.dissipation(2, cells)[1] for cells in (50, 100))
    # Of second order. Measured: 7.9e-4 and 1.8e-4.
    assert abs(fine.error) < 0.3 * abs(coarse.error)


def test_a_bar_that_is_only_pulled_takes_an_eighth():
    _, last = frictional_bed.dissipation(2, 50, low=0.0)
    assert abs(last.error) < 5e-3


def test_the_force_on_a_flat_punch_of_revolution_tends_to_that_of_a_half_space():
    coarse, fine = (
        punches.flat_of_revolution(cell, growth) for cell, growth in ((0.01, 1.3), (0.005, 1.15))
    )
    # Measured: 1.5e-2 and 5.7e-3.
    assert abs(coarse.error) < 0.03
    assert abs(fine.error) < 0.5 * abs(coarse.error)


def test_a_node_under_the_corner_of_a_punch_slides_below_it():
    """Symptom guarded against: the side of the punch held it, and the force was 2.8 % too large."""
    coarse, fine = (
        punches.flat_of_revolution(cell, growth, on_node=True)
        for cell, growth in ((0.02, 1.3), (0.01, 1.15))
    )
    # Measured: 1.4e-2 and 5.1e-3.
    assert abs(coarse.error) < 0.03
    assert abs(fine.error) < 0.5 * abs(coarse.error)


def test_the_pressure_under_a_flat_punch():
    # Measured: 2.9e-3.
    assert abs(punches.flat_in_the_plane(0.01, 1.3).error) < 0.01


def test_the_pressure_under_a_rounded_punch():
    # Measured: 2.2e-4.
    assert abs(punches.rounded_in_the_plane(0.05).error) < 1e-3


@pytest.mark.parametrize("compression", [0.3, 0.4, 0.5])
def test_plates_press_a_block_as_its_law_says(compression):
    block = pressed.between_plates(compression)
    # Measured: 1.5e-11.
    assert abs(block.error) < 1e-10
    # Measured: 6, and 9.4 at 50 %, close to where the free side buckles: 51.5 % on this mesh.
    assert block.iterations < 12


@pytest.mark.parametrize("compression", [0.4, 0.6])
def test_what_holds_a_block_pushes_by_the_slope_of_its_energy(compression):
    block = pressed.bonded(compression)
    # Measured: 1.2e-7, of the difference.
    assert abs(block.error) < 1e-6
    assert block.iterations < 5


@pytest.mark.parametrize("size", pressed.STRIPS)
def test_a_strip_bears_its_pressure(size):
    strip = pressed.strip(*size)
    # Measured: 7.7e-13.
    assert abs(strip.error) < 8e-12
    assert strip.iterations < 2


def test_a_fluid_presses_an_o_ring_on_its_plates():
    ring = o_ring.seal()
    # Measured: 937 N and 612 N, 1.53.
    assert ring.pressed > 1.4 * ring.squeezed
    assert ring.wall > 0.0
    # It is tight: it presses harder than the fluid.
    assert ring.seal > o_ring.FLUID
    # Measured: 7.9e-16.
    assert ring.defect < 7e-15
    # Measured: 8.1. Without the stiffness of the fluid's pressure it takes 108.
    assert ring.iterations < 12
