"""Runs with other cells, forms and laws than the plainest are confirmed, false ones are found."""

import shutil

import h5py
import numpy as np
import pytest
from two_discs import scenario

import carom
from carom.auditing.materials.dilatation import MeanDilatation
from carom.auditing.materials.laws import Law
from carom.auditing.materials.plane_stress import PlaneStress

OGDEN = carom.Ogden(mu=[600.0, 30.0, -40.0], alpha=[1.8, 4.5, -1.7], bulk=3000.0, density=1.0)
FOAM = carom.BlatzKo(shear=1000.0, poisson=0.3, fraction=0.3, density=1.0)
NEARLY_ALL_VOLUME = {"kind": "neo-hookean", "young": 2700.0, "poisson": 0.45, "density": 1.0}
SHEET = {"bodies.0.hypothesis": "plane-stress", "bodies.0.thickness": 0.3}


def given(material):
    return material.model_dump(mode="json", exclude_none=True)


@pytest.mark.parametrize(
    "changes",
    [
        {"materials.m": given(OGDEN)},
        {"materials.m": given(FOAM)},
        {**SHEET, "materials.m.damping": {"mass": 0.0, "stiffness": 1e-4}},
        {**SHEET, "materials.m.kind": "neo-hookean"},
        {**SHEET, "materials.m.kind": "linear-elastic"},
        {
            "bodies.0.formulation": "mean-dilatation",
            "materials.m": {**NEARLY_ALL_VOLUME, "damping": {"mass": 0.0, "stiffness": 1e-4}},
        },
        {"bodies.0.mesh.cell": "tri6", "bodies.1.mesh.cell": "tri6"},
        {"bodies.0.mesh.cell": "quad8", "bodies.0.mass": "lumped"},
        {"bodies.0.mesh.cell": "quad9", "contact.targets": "faceted"},
    ],
)
@pytest.mark.parametrize("method", [("gap", "theta"), ("massless", "conserving")])
def test_cells_forms_and_laws_are_confirmed(tmp_path, method, changes):
    carom.run(scenario(*method, **changes), out=tmp_path)
    audit = carom.audit(tmp_path)
    assert [(check.name, check.where) for check in audit.refuted] == []
    checks = {check.name: check for check in audit.checks}
    assert checks["Coulomb: cone"].count > 10


@pytest.fixture(scope="module")
def sheet(tmp_path_factory):
    directory = tmp_path_factory.mktemp("sheet")
    carom.run(scenario(**SHEET, **{"bodies.1.mesh.cell": "tri6"}), out=directory)
    return directory


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('hypothesis = "plane-stress"', 'hypothesis = "plane-strain"'),
        ('formulation = "standard"', 'formulation = "mean-dilatation"'),
        ("thickness = 0.3", "thickness = 0.3001"),
        ('mass = "consistent"', 'mass = "lumped"'),
    ],
)
def test_a_form_that_is_not_that_of_the_run_is_found(sheet, tmp_path, old, new):
    shutil.copytree(sheet, tmp_path / "changed")
    path = tmp_path / "changed" / "case.toml"
    complete = carom.Scenario.from_toml(path).to_toml(complete=True)
    assert old in complete
    path.write_text(complete.replace(old, new, 1))
    assert {check.name for check in carom.audit(tmp_path / "changed").refuted} - {"files"}


def test_a_node_between_the_ends_of_a_side_that_moved_is_found(sheet, tmp_path):
    shutil.copytree(sheet, tmp_path / "changed")
    with h5py.File(tmp_path / "changed" / "fields.vtkhdf", "r+") as file:
        file["VTKHDF/PointData/displacement"][-1, 0] += 1e-9
    refuted = {check.name for check in carom.audit(tmp_path / "changed").refuted}
    assert {"strain energy", "stored steps"} <= refuted


RNG = np.random.default_rng(11)
STRETCH = np.eye(3) + 0.2 * RNG.normal(size=(4, 2, 3, 3))
WEIGHTS = RNG.uniform(0.5, 1.0, size=(4, 2))


def in_plane(f):
    f = f.copy()
    f[..., 2, :2] = f[..., :2, 2] = 0.0
    f[..., 2, 2] = 1.0
    return f


@pytest.mark.parametrize(
    "material", [OGDEN, FOAM, carom.NeoHookean(**{"young": 3, "poisson": 0.3, "density": 1})]
)
def test_stresses_are_the_slopes_of_energies(material):
    law, h = Law.of(material, 3), 1e-6
    step = RNG.normal(size=STRETCH.shape)
    sheet, cells = PlaneStress(law), MeanDilatation(law, WEIGHTS)
    flat, across = in_plane(STRETCH), in_plane(np.eye(3) + step) - np.eye(3)
    for response, f, d in ((law, STRETCH, step), (sheet, flat, across), (cells, STRETCH, step)):
        ends = [(WEIGHTS * response.energy(f + s * h * d)).sum() for s in (1, -1)]
        work = (WEIGHTS * (response.stress(f) * d).sum(axis=(2, 3))).sum()
        assert work == pytest.approx((ends[0] - ends[1]) / (2 * h), rel=1e-7)
        # And the stress of a step does all of the work of the step.
        change = (WEIGHTS * (response.energy(f + 0.1 * d) - response.energy(f))).sum()
        mean = response.discrete_stress(f, f + 0.1 * d)
        assert (WEIGHTS * (mean * 0.1 * d).sum(axis=(2, 3))).sum() == pytest.approx(
            change, rel=1e-11
        )
    assert np.abs(sheet.cauchy_stress(flat)[..., 2, 2]).max() < 1e-10
    # Both laws resist small strains as their moduli say.
    small = np.eye(3) + 1e-6 * np.diag([1.0, 0.0, 0.0])
    assert law.stress(small)[0, 0] == pytest.approx(1e-6 * law.modulus, rel=1e-5)
