"""`carom modes`: what it prints, writes, draws and refuses."""

import csv

import numpy as np
import pytest
from numpy.testing import assert_allclose
from typer.testing import CliRunner

import carom
import staging
from carom.cli import app
from carom.modes import basis
from carom.modes.basis import modes

SOFT = {"kind": "saint-venant-kirchhoff", "young": 2700.0, "poisson": 0.3, "density": 1.0}
BLOCK = {"kind": "rectangle", "corner": [0.0, 0.01], "size": [1.0, 1.0], "divisions": [3, 3]}


def case(**given):
    block = {"name": "block", "material": "soft", "mesh": BLOCK, "velocity": [0.0, -1.0], **given}
    body = {key: value for key, value in block.items() if value is not None}
    return carom.Scenario.from_dict(
        {
            "analysis": {"end_time": 0.1, "time_step": 5e-3},
            "output": {"fields_every": 0.02},
            "materials": {
                "soft": SOFT,
                "metal": {**SOFT, "kind": "j2-plasticity", "yield_stress": 1e3},
            },
            "bodies": [body],
            "contact": {"condition": "midpoint"},
            "obstacles": [
                {"kind": "plane", "name": "floor", "point": [0.0, 0.0], "normal": [0.0, 1.0]}
            ],
        }
    )


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return carom.run(case(), out=tmp_path_factory.mktemp("modes") / "run").path


def test_the_table_has_every_joule(results, tmp_path):
    table, picture = tmp_path / "modes.csv", tmp_path / "modes.png"
    call = ["modes", str(results), "--count", "6", "--csv", str(table), "--out", str(picture)]
    done = CliRunner().invoke(app, call)
    assert done.exit_code == 0, done.output
    assert "block, at the last frame" in done.output
    assert picture.read_bytes().startswith(b"\x89PNG")
    with table.open() as file:
        rows = list(csv.DictReader(file))
    energies = carom.modal_energies(results, count=6)["block"]
    assert len(rows) == len(energies.times) * 8
    last = [row for row in rows if float(row["time"]) == energies.times[-1]]
    total = sum(float(row["kinetic"]) + float(row["strain"]) for row in last)
    assert total == pytest.approx(energies.total[-1], rel=1e-14)
    assert [row["part"] for row in last] == ["rigid", *map(str, range(1, 7)), "rest"]
    again = CliRunner().invoke(app, call)
    assert again.exit_code == 2
    assert "is there" in again.output


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        ({"material": "metal"}, "its material flows"),
        ({"growth": "1e-3*t"}, "it grows"),
        ({"initial_stress": {"xx": 1.0}}, "it is under an initial stress"),
        ({"mesh": {**BLOCK, "periodic": True}}, "it is periodic"),
        ({"kind": "rigid", "material": None, "density": 1.0}, "it is rigid"),
    ],
)
def test_a_body_whose_energy_has_no_modes_is_refused_by_reason(tmp_path, body, reason):
    result = carom.run(case(**body), out=tmp_path / "run")
    with pytest.raises(carom.InputError, match=f"block has no modes .*: {reason}"):
        carom.modal_energies(result, bodies=["block"])
    with pytest.raises(carom.InputError, match="no body has modes: none deforms and is elastic"):
        carom.modal_energies(result)


def test_what_is_asked_wrongly_is_refused(results, tmp_path):
    with pytest.raises(carom.InputError, match="brick: no such body"):
        carom.modal_energies(results, bodies=["brick"])
    with pytest.raises(carom.InputError, match="0 modes: ask for 1 at least"):
        carom.modal_energies(results, count=0)


def test_stages_may_hold_a_body_otherwise_and_have_no_modes(tmp_path):
    result = carom.run(staging.scenario(), out=tmp_path)
    with pytest.raises(carom.InputError, match="modes are of a case of one analysis"):
        carom.modal_energies(result)


@pytest.mark.parametrize("condition", ["midpoint", "massless"])
def test_the_slowest_of_many_modes_are_those_of_all(condition, monkeypatch):
    """Shift and inversion finds what the dense problem has, where nodes have no mass too."""
    from carom.building.build import build

    fine = case(mesh={**BLOCK, "divisions": [10, 10]})
    fine = fine.with_overrides([f"contact.condition={condition}"])
    simulation = build(fine)
    matrices = simulation.matrices(0)
    monkeypatch.setattr(basis, "DENSE", 200)
    few = modes(matrices, 5, slow=50.0)
    every = modes(matrices, 2 * 11 * 11 - 5, slow=50.0)
    assert few.rigid == every.rigid == 3
    assert len(few.frequencies) == 8
    assert_allclose(few.frequencies, every.frequencies[:8], rtol=1e-9)
    gram = [few.amplitudes(shape) for shape in few.shapes]
    assert_allclose(gram, np.eye(8), atol=1e-9)
