"""Runs of bodies of several materials are confirmed, and a cell of the wrong one is found."""

import shutil

import h5py
import pytest

import carom

SOFT = {"kind": "saint-venant-kirchhoff", "young": 3e3, "poisson": 0.3, "density": 1.0}
STIFF = {"kind": "neo-hookean", "young": 9e3, "poisson": 0.2, "density": 3.0}


def dropped(*, damping=None, **contact):
    """A disc of two materials falls on a block of two, and both on a floor."""
    soft = {**SOFT, "damping": {"mass": 0.1, "stiffness": damping}} if damping else SOFT
    stiff = {**STIFF, "damping": {"mass": 0.1}} if damping else STIFF
    block = {
        "name": "block",
        "material": "soft",
        "mesh": {
            "kind": "rectangle",
            "corner": [0.0, 0.05],
            "size": [1.0, 1.0],
            "divisions": [6, 6],
        },
        "velocity": [0.5, -2.0],
        "regions": [{"material": "stiff", "corner": [0.5, 0.0], "size": [0.6, 1.1]}],
    }
    disc = {
        "name": "disc",
        "material": "stiff",
        "mesh": {"kind": "disc", "centre": [0.4, 1.6], "radius": 0.45, "divisions": 4},
        "velocity": [0.0, -4.0],
        "regions": [{"material": "soft", "corner": [0.0, 1.1], "size": [1.0, 0.4]}],
    }
    return carom.Scenario.from_dict(
        {
            "title": "two bodies of two materials",
            "analysis": {
                "end_time": 0.2,
                "time_step": 5e-4,
                "scheme": {"kind": "conserving"},
                "gravity": [0.0, -2.0],
            },
            "materials": {"soft": soft, "stiff": stiff},
            "bodies": [block, disc],
            "obstacles": [{"kind": "plane", "name": "floor", "point": [0, 0], "normal": [0, 1]}],
            "contact": {"friction": 0.3, **contact},
            "output": {"fields_every": 0.01, "history_every": 5e-4, "audit": True},
        }
    )


@pytest.mark.parametrize(
    "given",
    [
        {"condition": "midpoint"},
        {"condition": "gap", "damping": 1e-4},
        {"condition": "massless", "targets": "faceted", "damping": 1e-4},
    ],
    ids=lambda given: given["condition"],
)
def test_bodies_of_several_materials_are_confirmed(tmp_path, given):
    carom.run(dropped(**given), out=tmp_path / "run")
    audit = carom.audit(tmp_path / "run")
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["materials"].count == 84
    assert checks["equation of motion"].count > 1000


def test_a_cell_of_the_wrong_material_is_found(tmp_path):
    carom.run(dropped(), out=tmp_path / "run")
    shutil.copytree(tmp_path / "run", tmp_path / "changed")
    with h5py.File(tmp_path / "changed" / "fields.vtkhdf", "r+") as file:
        file["VTKHDF/CellData/material"][7] ^= 1
    refuted = {check.name for check in carom.audit(tmp_path / "changed").refuted}
    assert refuted == {"materials"}


def test_a_density_that_is_not_the_run_s_is_found(tmp_path):
    carom.run(dropped(), out=tmp_path / "run")
    text = (tmp_path / "run" / "case.toml").read_text()
    assert "density = 3.0" in text
    (tmp_path / "run" / "case.toml").write_text(text.replace("density = 3.0", "density = 3.1"))
    refuted = {check.name for check in carom.audit(tmp_path / "run").refuted}
    assert {"equation of motion", "kinetic energy"} & refuted
