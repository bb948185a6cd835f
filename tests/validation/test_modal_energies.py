"""The energy of an impact by modes: closed forms, and books that add up to those of the run."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from ringing_bar import EXACT, NUMBERS, bars, recorded, ringing
from runs import observed_order

import carom

WIDE = {"kind": "rectangle", "corner": [0.0, 1e-3], "size": [1.0, 0.4], "divisions": [3, 1]}
"""A mesh without a node inside."""


def test_a_bar_that_was_hit_rings_in_its_odd_modes(tmp_path):
    """Behind the impact the long bar moves at v/2 and is strained by v/2c everywhere.

    Mode n, cos nπx/L, has 8/(n²π²) of the m v²/8 that the strain is, for odd n; even modes have
    nothing. So it is as long as the bar flies.
    """
    errors, sizes = [], (50, 100, 200)
    for cells in sizes:
        bar = ringing(cells, tmp_path / str(cells))
        assert_allclose(bar.frequencies, 25.0 * NUMBERS, rtol=12.0 / cells**2)
        assert bar.change < 1e-3
        assert bar.off < 1e-10
        errors.append(abs(bar.shares - EXACT).max())
    assert bar.restitution == pytest.approx(0.5, rel=5e-3)
    assert errors[-1] < 1e-3
    assert observed_order([1.0 / cells for cells in sizes], errors) > 1.5


def test_all_modes_have_all_of_the_energy_of_a_small_strain(tmp_path):
    result = carom.run(bars(20, "gap"), out=tmp_path)
    size = result.summary["energy"]["initial"]
    rests = []
    for count in (5, 20, 1000):
        energies = carom.modal_energies(result, count=count)["long"]
        assert_allclose(energies.total, recorded(result, "long"), rtol=0, atol=1e-10 * size)
        rests.append(abs(energies.rest).max() / size)
    assert rests[0] > rests[1] > 1e-3
    assert rests[2] < 1e-11


def thrown(dimension, speed, **given):
    """Return a case of a block that turns and is thrown at a floor with friction."""
    size = [1.0, 0.7, 0.6][:dimension]
    spin = speed if dimension == 2 else [speed, -speed, 0.5 * speed]
    return carom.Scenario.from_dict(
        {
            "dimension": dimension,
            "analysis": {"end_time": 0.4, "time_step": 2e-3, "scheme": {"kind": "conserving"}},
            "output": {"history_every": 0.05, "fields_every": 0.05},
            "materials": {
                "soft": {
                    "kind": "saint-venant-kirchhoff",
                    "young": 2700.0,
                    "poisson": 0.3,
                    "density": 1.0,
                }
            },
            "bodies": [
                {
                    "name": "block",
                    "material": "soft",
                    "mesh": {
                        "kind": "rectangle" if dimension == 2 else "box",
                        "corner": [0.0, 1e-3, 0.0][:dimension],
                        "size": size,
                        "divisions": [3, 2, 2][:dimension],
                    },
                    "velocity": [0.3 * speed, -speed, 0.0][:dimension],
                    "spin": spin,
                }
                | given
            ],
            "obstacles": [
                {
                    "kind": "plane",
                    "name": "floor",
                    "point": [0.0] * dimension,
                    "normal": [0.0, 1.0, 0.0][:dimension],
                }
            ],
            "contact": {"condition": "midpoint", "friction": 0.3},
        }
    )


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_body_that_turns_and_rings_keeps_its_books_by_modes(tmp_path, dimension):
    """With all modes, what is left is what a finite strain has beside them."""
    rests = []
    for speed in (0.2, 0.05):
        result = carom.run(thrown(dimension, speed), out=tmp_path / f"{speed}")
        initial = result.summary["energy"]["initial"]
        energies = carom.modal_energies(result, count=500)["block"]
        assert_allclose(energies.total, recorded(result, "block"), rtol=0, atol=1e-10 * initial)
        rigid = result.history["block.translation"] + result.history["block.rotation"]
        assert_allclose(energies.rigid, rigid, rtol=0, atol=1e-10 * initial)
        rings = energies.energies.sum(axis=1).max()
        assert rings > 0.05 * initial
        rests.append(abs(energies.rest).max() / rings)
    assert rests[1] < 0.4 * rests[0] < 0.1


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_reduced_body_has_all_of_its_energy_in_its_vibrations(tmp_path, dimension):
    """Nothing else is in its books, whatever the strain; each keeps what it has in flight."""
    result = carom.run(thrown(dimension, 0.2, kind="reduced", modes=3), out=tmp_path)
    initial = result.summary["energy"]["initial"]
    for count in (2, 500):
        energies = carom.modal_energies(result, count=count)["block"]
        assert_allclose(energies.total, recorded(result, "block"), rtol=0, atol=1e-12 * initial)
        rigid = result.history["block.translation"] + result.history["block.rotation"]
        assert_allclose(energies.rigid, rigid, rtol=0, atol=1e-12 * initial)
        if count == 2:
            assert energies.energies.shape == (9, 2)
            assert energies.rest.max() > 0.02 * initial
    assert abs(energies.rest).max() == 0.0
    assert energies.energies.sum(axis=1).max() > 0.05 * initial
    (impact,) = result.summary["contacts"]
    flight = energies.times > impact["release"]
    assert flight.sum() > 2
    assert np.ptp(energies.energies[flight], axis=0).max() < 1e-10 * initial
    assert np.ptp(energies.kinetic[flight], axis=0).max() > 1e-3 * initial


def test_a_reduced_body_that_keeps_all_of_its_nodes_has_the_modes_of_the_whole(tmp_path):
    frequencies = []
    for given in ({}, {"kind": "reduced", "modes": 0}):
        case = thrown(2, 0.2, mesh=WIDE, **given)
        result = carom.run(case, out=tmp_path / given.get("kind", "whole"))
        frequencies.append(carom.modal_energies(result, count=500)["block"].frequencies)
    assert_allclose(*frequencies, rtol=1e-8)


def test_a_clamped_beam_swings_in_its_first_mode(tmp_path):
    """Euler and Bernoulli: ω₁ = 1.8751² √(EI/ρA)/L²; three nodes are pushed by 1 N for 1 s."""
    length, height, young = 10.0, 1.0, 1e4
    scenario = carom.Scenario.from_dict(
        {
            "analysis": {
                "end_time": 20.0,
                "time_step": 0.02,
                "scheme": {"kind": "conserving"},
            },
            "output": {"history_every": 0.5, "fields_every": 0.5},
            "materials": {
                "steel": {
                    "kind": "linear-elastic",
                    "young": young,
                    "poisson": 0.0,
                    "density": 1.0,
                }
            },
            "bodies": [
                {
                    "name": "beam",
                    "material": "steel",
                    "mesh": {
                        "kind": "rectangle",
                        "corner": [0.0, 0.0],
                        "size": [length, height],
                        "divisions": [10, 1],
                        "cell": "quad8",
                    },
                }
            ],
            "motions": [{"kind": "fixed", "body": "beam", "on": "left"}],
            "loads": [
                {"kind": "force", "body": "beam", "on": "right", "force": [0.0, "max(1-t, 0)"]}
            ],
        }
    )
    result = carom.run(scenario, out=tmp_path)
    energies = carom.modal_energies(result, count=10)["beam"]
    bending = 1.8751**2 * np.sqrt(young * height**2 / 12) / length**2 / (2 * np.pi)
    assert energies.frequencies[0] == pytest.approx(bending, rel=1e-2)  # shear takes 0.6 %
    late = energies.times > 1.01
    size = recorded(result, "beam")[late].max()
    assert_allclose(energies.total, recorded(result, "beam"), rtol=0, atol=1e-10 * size)
    # A mode that F pushes at the tip, where φ² = 4/m, has ½ φ² |∫ F e^(-iωt) dt|² from then on.
    omega = 2 * np.pi * energies.frequencies[0]
    pushed = 3.0 * (-1j / omega + (1.0 - np.exp(-1j * omega)) / omega**2)
    swings = 0.5 * 4.0 / (length * height) * abs(pushed) ** 2
    assert energies.energies[late, 0].mean() == pytest.approx(swings, rel=2e-2)
    assert np.ptp(energies.energies[late], axis=0).max() < 1e-3 * size
    assert abs(energies.rest[late]).max() < 0.05 * size
    assert energies.rigid.max() == 0.0
