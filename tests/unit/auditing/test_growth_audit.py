"""Bodies that grow are audited."""

import pytest
from refuting import confirmed, refuted_after
from test_interference_audit import METHODS, fit
from two_discs import scenario

import carom
from tampered import in_h5, with_another_case

RUBBER = {"kind": "mooney-rivlin", "c10": 400.0, "c01": 100.0, "bulk": 3000.0, "density": 1.0}
METAL = {
    "kind": "j2-plasticity",
    "young": 2700.0,
    "poisson": 0.3,
    "density": 1.0,
    "yield_stress": 60.0,
}
GROWS = {"bodies.0.growth": "0.04*sin(30*t)", "bodies.1.growth": "0.1*t"}


@pytest.mark.parametrize("method", METHODS)
def test_discs_that_grow_as_they_meet_are_confirmed(tmp_path, method):
    result = carom.run(scenario(*method, **GROWS), out=tmp_path)
    assert abs(result.summary["bodies"][0]["prescribed"]) > 0.1
    checks = confirmed(tmp_path)
    assert checks["Coulomb: cone"].count > 5
    assert checks["equation of motion"].figure < 1e-5


@pytest.mark.parametrize(
    "changes",
    [
        {"materials.m": RUBBER, "bodies.0.hypothesis": "plane-stress"},
        {"materials.m.kind": "linear-elastic"},
        {"materials.m.kind": "linear-elastic", "bodies.0.hypothesis": "plane-stress"},
        {"bodies.0.formulation": "mean-dilatation"},
        {"bodies.0.initial_stress": {"xx": 50.0, "zz": 30.0}},
        {"materials.m.damping": {"mass": 0.1, "stiffness": 1e-3}},
        {"materials.m.viscosity": {"shear": 1.0, "bulk": 0.5}},
    ],
)
@pytest.mark.parametrize("method", [("gap", "theta"), ("midpoint", "conserving")])
def test_laws_of_bodies_that_grow_are_confirmed(tmp_path, method, changes):
    carom.run(scenario(*method, **GROWS, **changes), out=tmp_path)
    confirmed(tmp_path)


@pytest.mark.parametrize("method", [("gap", "theta"), ("midpoint", "conserving")])
def test_metal_that_grows_and_flows_is_confirmed(tmp_path, method):
    changes = {"materials.m": METAL, "output.fields_every": 1e-3, "analysis.end_time": 0.03}
    changes["analysis.time_step"] = 1e-3
    result = carom.run(scenario(*method, **GROWS, **changes), out=tmp_path)
    assert result.summary["energy"]["plastic"] > 1e-3
    checks = confirmed(tmp_path)
    assert checks["plastic strain"].count > 1000


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A shaft that grows in its hub."""
    out = tmp_path_factory.mktemp("growth")
    steel = {"kind": "saint-venant-kirchhoff", "young": 1e4, "poisson": 0.3, "density": 1.0}
    disc = {"kind": "disc", "centre": [0.0, 0.0], "radius": 1.0, "divisions": 4}
    ring = {"kind": "ring", "centre": [0.0, 0.0], "inner_radius": 1.0, "outer_radius": 2.0}
    bodies = [
        {"name": "shaft", "material": "m", "mesh": disc, "growth": "0.01*t + 0.001"},
        {"name": "hub", "material": "m", "mesh": {**ring, "divisions": [16, 3]}},
    ]
    case = fit(materials={"m": steel}, bodies=bodies, contact={"friction": 0.1})
    assert carom.run(case, out=out).history["normal_force"][-1] > 10.0
    return out


def test_a_fit_by_heat_is_confirmed(run):
    confirmed(run)


def test_growth_that_is_not_that_of_the_run_is_found(tmp_path, run):
    other = with_another_case(run, tmp_path / "changed", "0.01*t", "0.0100001*t")
    refuted = {check.name for check in carom.audit(other).refuted}
    assert {"strain energy", "stress", "ledger: prescribed", "equation of motion"} <= refuted


def test_work_of_growth_that_was_changed_is_found(tmp_path, run):
    tamper = in_h5("audit.h5:steps/000001/ledger@prescribed", lambda work: 1.0001 * work)
    assert "ledger: prescribed" in refuted_after(run, tmp_path, tamper)
